"""Statistics of gathered runs: from datasets of stored facts to datasets of estimates with intervals."""

from studies.measures.blocking import blocked_share, hazard_of_blocking
from studies.measures.boundaries import Rules
from studies.measures.delays import delay_counts, delay_survival, delays
from studies.measures.exits import clearance, discharge, time_of_exit
from studies.measures.facts import outcome_is
from studies.measures.flow import flow_before_blocking, flow_in_bins, mean_flow
from studies.measures.states import states
from studies.measures.uncertainty import mean_over

__all__ = [
    "Rules",
    "blocked_share",
    "clearance",
    "delay_counts",
    "delay_survival",
    "delays",
    "discharge",
    "flow_before_blocking",
    "flow_in_bins",
    "hazard_of_blocking",
    "mean_flow",
    "mean_over",
    "outcome_is",
    "states",
    "time_of_exit",
]
