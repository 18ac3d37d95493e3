"""Figure 2 of Parisi & Dorso (2005): discharge curves at three desired speeds."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper

AT = np.arange(0.0, 160.1, 0.25)  # s


def measure(sweeps: Sweeps) -> xr.Dataset:
    """The curve of seed 0, the mean of all seeds, and the longest delay of the ranks 10 to 160."""
    ds = sweeps.speeds.sel(v_d=list(paper.FIG2_V_D))
    curves = measures.discharge(ds, AT).discharge
    longest = measures.delays(ds, *paper.FIG3_RANKS).delay.max("exit").rename("longest_delay")
    longest.attrs = {"units": "s", "long_name": "longest delay"}
    means = measures.mean_over(curves).drop_vars(["runs", "censored"])
    return means.assign(measures.mean_over(longest).data_vars).assign(single=curves.isel(seed=0, drop=True))


def plot(found: xr.Dataset) -> Figure:
    """One run as the paper draws it, with the band of the mean of all seeds behind."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT)
    for (colour, _, line), v_d in zip(artefact.STYLES, found.v_d.values, strict=False):
        curve = found.sel(v_d=v_d)
        axis.fill_between(found.time, curve.discharge_low, curve.discharge_high, color=colour, alpha=0.3, lw=0)
        axis.plot(found.time, curve.single, color=colour, ls=line, lw=0.9, label=f"{v_d:g} m/s, one run")
    axis.fill_between([], [], color=figures.GREY, alpha=0.4, lw=0, label="mean of all runs, 95 %")
    axis.set(xlabel="time / s", ylabel="persons out", xlim=(0, AT[-1]), ylim=(0, 205))
    axis.legend(loc="lower right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Long delays grow with v_d above the threshold."""
    middle, fast = found.sel(v_d=2.0), found.sel(v_d=6.0)
    text = ", ".join(f"{float(v.v_d):g} m/s: {artefact.said(v, 'longest_delay', 1)} s" for v in (middle, fast))
    longer = artefact.larger(fast, middle, "longest_delay")
    return [Verdict("longest delay of ranks 10 to 160: larger at 6 m/s", "larger than at 2", text, longer)]


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
