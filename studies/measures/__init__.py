"""Statistics of gathered runs: from datasets of stored facts to datasets of estimates with intervals."""

from studies.measures.arches import arches, blocking_clusters
from studies.measures.blocking import blocked_share, hazard_of_blocking
from studies.measures.boundaries import Rules
from studies.measures.clogging import arch_clogging
from studies.measures.clusters import granular_clusters
from studies.measures.contact_counts import (
    arch_clogging_correlation,
    blocking_probability,
    cluster_probability,
    contact_counts,
)
from studies.measures.decay import decay
from studies.measures.delays import delay_counts, delay_survival, delays
from studies.measures.exits import clearance, discharge, time_of_exit
from studies.measures.facts import outcome_is
from studies.measures.faster import faster_is_slower
from studies.measures.flow import flow_before_blocking, flow_in_bins, mean_flow
from studies.measures.hazard import chances
from studies.measures.paired import paired_blocking
from studies.measures.states import states
from studies.measures.uncertainty import mean_over

__all__ = [
    "Rules",
    "arch_clogging",
    "arch_clogging_correlation",
    "arches",
    "blocked_share",
    "blocking_clusters",
    "blocking_probability",
    "chances",
    "clearance",
    "cluster_probability",
    "contact_counts",
    "decay",
    "delay_counts",
    "delay_survival",
    "delays",
    "discharge",
    "faster_is_slower",
    "flow_before_blocking",
    "flow_in_bins",
    "granular_clusters",
    "hazard_of_blocking",
    "mean_flow",
    "mean_over",
    "outcome_is",
    "paired_blocking",
    "states",
    "time_of_exit",
]
