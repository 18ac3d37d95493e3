"""Figure 9 of Parisi & Dorso (2005): probability of a blocking cluster against desired speed."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict

LABELS = {"clean": "clean: the exit is shut", "any": "any path"}


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Share of samples with a blocking cluster, from the start to the last exit."""
    return measures.blocking_probability(sweeps.speed_counts)


def plot(found: xr.Dataset) -> Figure:
    """Clean arches and any."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT)
    for k, (kind, words) in enumerate(LABELS.items()):
        artefact.points(axis, found.sel(kind=kind), "blocking_probability", k, f"{words}, 95 %")
    axis.set(xlabel=artefact.V_D, ylabel="P(blocking cluster)", ylim=(0, 1))
    axis.legend(loc="lower right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """It increases with v_d."""
    return [_increases(found.sel(kind=kind), kind) for kind in LABELS]


def _increases(column: xr.Dataset, kind: str) -> Verdict:
    p = column.blocking_probability.values
    some = artefact.each(column.sel(v_d=[1.5, 2.0, 4.0, 6.0]), "blocking_probability")
    return Verdict(f"P(blocking cluster, {kind}) increases with v_d", "increases", some, bool((np.diff(p) >= 0).all()))


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
