"""Figure 4 of Lin, Ma & Lo (2016): leaving of 100 persons at 1 m/s, for social forces of 200 to 500 N."""

import sys

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies import measures
from studies.lin import artefact
from studies.lin.sweeps import WALLS, Sweeps
from studies.presentation import figures
from studies.presentation.estimates import STYLES
from studies.presentation.verdicts import Verdict, interval
from studies.published import lin2016 as paper

BARELY = 0.1  # of the clearance time: what "barely affects" is taken to allow
TITLES = {WALLS[0]: "walls push as strongly as persons", WALLS[1]: "walls push with 300 N"}


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Mean time of each exit, of the runs that reached it; clearance times, their ratio to 300 N by seed."""
    ds = sweeps.strengths
    ranks = measures.time_of_exit(ds, list(range(1, paper.FIG4_N + 1)))
    means = measures.mean_over(ranks.time_of_exit, censored=ranks.censored).drop_vars(["runs", "censored"])
    found = artefact.cells(ds)
    time = found.time_of_run.where(np.isfinite(found.time_of_run))
    ratio = (time / time.sel(A=300.0)).rename("ratio")
    ratios = measures.mean_over(ratio.assign_attrs(units="1", long_name="clearance time over that of 300 N"))
    return means.assign(found.data_vars).assign({name: ratios[name] for name in ("ratio", "ratio_low", "ratio_high")})


def plot(found: xr.Dataset) -> Figure:
    """Mean leaving curves with intervals, and the published times; the two variants of walls below each other."""
    figure, axes = figures.stacked(2, height=artefact.HEIGHT)
    for axis, walls in zip(axes, WALLS, strict=True):
        _curves(axis, found.sel(walls=walls))
        axis.set_title(TITLES[walls], loc="left")
        axis.set_ylabel("persons out")
    axes[0].legend(loc="lower right")
    axes[1].set(xlabel="time / s", xlim=(0, None), ylim=(0, paper.FIG4_N * 1.1))
    artefact.labelled(axes)
    return figure


def _curves(axis: Axes, column: xr.Dataset) -> None:
    for (colour, marker, line), A in zip(STYLES, column.A.values, strict=True):
        curve = column.sel(A=A)
        axis.fill_betweenx(curve.n, curve.time_of_exit_low, curve.time_of_exit_high, color=colour, alpha=0.3, lw=0)
        axis.plot(curve.time_of_exit, curve.n, color=colour, ls=line, lw=1, label=f"$A$ = {A:g} N")
        if A in paper.FIG4_CLEARANCE_TIME:
            higher = 2.0 * (A > 300.0)  # two published values are the same
            at = paper.FIG4_CLEARANCE_TIME[A], paper.FIG4_N + 2.0 + 2 * higher
            axis.plot(*at, marker=marker, color=colour, mfc="white", ms=4, ls="", clip_on=False)
    axis.fill_between([], [], color=figures.GREY, alpha=0.4, lw=0, label="95 % of the mean")
    axis.plot([], [], "o", color=figures.GREY, mfc="white", ms=4, label="published, all out")


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Clearance times and what a stronger force changes, for both variants of what walls do."""
    return [verdict for walls in WALLS for verdict in _of(found.sel(walls=walls), walls)]


def _of(column: xr.Dataset, walls: str) -> list[Verdict]:
    where = "" if walls == WALLS[0] else ", walls held at 300 N"
    times = [
        artefact.published_time(f"clearance time, A = {A:g} N{where}", column.sel(A=A), time)
        for A, time in paper.FIG4_CLEARANCE_TIME.items()
        if A != 300.0 or not where
    ]
    published = paper.FIG4_CLEARANCE_TIME[200.0] / paper.FIG4_CLEARANCE_TIME[300.0]
    return [
        *times,
        _ratio(f"time at 200 N over that at 300 N{where}", column.sel(A=200.0), published),
        _ratio(f"300 to 500 N changes the time barely{where}", column.sel(A=500.0), 1.0),
    ]


def _ratio(statement: str, cell: xr.Dataset, published: float) -> Verdict:
    """A ratio of times against the published one: yes if its interval lies within BARELY of it, no if all beyond."""
    mean, low, high = (float(cell[f"ratio{end}"]) for end in ("", "_low", "_high"))
    said = f"{published:.2f} +- {BARELY:g}"
    if not np.isfinite([low, high]).all():
        return Verdict(statement, said, "too few runs out", None)
    inside = published - BARELY <= low and high <= published + BARELY
    beyond = high < published - BARELY or low > published + BARELY
    return Verdict(statement, said, interval(mean, low, high, 2), True if inside else (False if beyond else None))


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
