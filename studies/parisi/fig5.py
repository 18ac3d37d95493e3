"""Figure 5 of Parisi & Dorso (2005): probability of a granular cluster of more than 10 persons."""

import sys

import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper

RARE, FREQUENT = 0.02, 0.4


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Share of samples with such a cluster, from the start to the last exit."""
    return measures.cluster_probability(sweeps.speed_counts)


def plot(found: xr.Dataset) -> Figure:
    """The probability against v_d, with the published threshold."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT)
    artefact.points(axis, found, "cluster_probability", 0, "found, 95 %")
    axis.axvline(paper.V_DT, color=figures.GREY, lw=0.8, ls="--", label="published threshold $v_{dt}$")
    axis.set(xlabel=artefact.V_D, ylabel=f"P(cluster > {paper.LARGE_CLUSTER} persons)", ylim=(0, 1))
    axis.legend(loc="lower right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Negligible below the threshold, not so above."""
    name = "cluster_probability"
    slow, fast = artefact.at(found, 0.0, 1.5), artefact.at(found, 3.0, 3.0)
    return [
        Verdict(
            "P(cluster > 10) up to 1.5 m/s",
            f"about 0 (below {RARE})",
            artefact.each(slow, name, 3),
            bool((slow[name] < RARE).all()),
        ),
        Verdict(
            "P(cluster > 10) at 3 m/s",
            f"not negligible (above {FREQUENT})",
            artefact.said(fast.isel(v_d=0), name),
            bool((fast[name] > FREQUENT).all()),
        ),
    ]


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
