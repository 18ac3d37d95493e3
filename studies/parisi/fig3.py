"""Figure 3 of Parisi & Dorso (2005): distribution of the delays between the 10th and the 160th exit."""

import sys
from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper

AT = np.round(np.arange(0.0, 5.001, 0.05), 2)  # s
LONG = 1.5  # s, of the tail


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Survival function of the delays at the paper's three speeds."""
    first, last = paper.FIG3_RANKS
    return measures.delay_survival(sweeps.speeds.sel(v_d=list(paper.FIG2_V_D)), AT, first=first, last=last)


def plot(found: xr.Dataset) -> Figure:
    """Shares of longer delays, with bands."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT)
    for (colour, _, line), v_d in zip(artefact.STYLES, found.v_d.values, strict=False):
        curve = found.sel(v_d=v_d)
        axis.fill_between(
            found.time, curve.delay_survival_low, curve.delay_survival_high, color=colour, alpha=0.25, lw=0
        )
        shown = curve.delay_survival.where(curve.delay_survival > 0)
        axis.plot(found.time, shown, color=colour, ls=line, label=f"{v_d:g} m/s")
    axis.fill_between([], [], color=figures.GREY, alpha=0.4, lw=0, label="95 %")
    axis.set(xlabel="delay $t$ / s", ylabel="share of delays longer than $t$", yscale="log", ylim=(3e-4, 1.1))
    axis.legend(loc="upper right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """The tail grows with v_d."""
    tail = found.sel(time=LONG)
    return [_grows(tail.sel(v_d=low), tail.sel(v_d=high)) for low, high in pairwise(paper.FIG2_V_D)]


def _grows(slow: xr.Dataset, fast: xr.Dataset) -> Verdict:
    """Whether the share at the higher v_d is larger; open where the intervals overlap."""
    text = ", ".join(f"{float(cell.v_d):g} m/s: {artefact.said(cell, 'delay_survival', 4)}" for cell in (slow, fast))
    statement = f"share of delays above {LONG:g} s, {float(slow.v_d):g} to {float(fast.v_d):g} m/s"
    return Verdict(statement, "grows", text, artefact.larger(fast, slow, "delay_survival"))


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
