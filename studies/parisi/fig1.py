"""Figure 1 of Parisi & Dorso (2005): evacuation time against desired speed, of 160, 180 and 200 persons."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict, interval
from studies.published import parisi2005 as paper

MINIMUM = (1.75, 2.5)  # m/s: the published threshold, give or take a cell of the scan
TELLING = 1.5  # m/s, width of an interval that still tells something


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Mean times of the 160th, 180th and 200th exit, and the v_d at which they are least."""
    ranks = list(paper.FIG1_RANKS)
    times = measures.time_of_exit(sweeps.speeds, ranks)
    means = measures.mean_over(times.time_of_exit, censored=times.censored)
    threshold = measures.faster_is_slower(sweeps.speeds, ranks)
    return means.assign({name: threshold[name] for name in threshold if str(name).startswith("v_dt")})


def plot(found: xr.Dataset) -> Figure:
    """Three curves, the published times of 200 persons, and the interval of the minimum."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT)
    for k, n in enumerate(reversed(paper.FIG1_RANKS)):
        artefact.points(axis, found.sel(n=n), "time_of_exit", k, f"{n} persons out")
    published = paper.EVACUATION_TIME
    axis.plot([*published], [*published.values()], "x", color="black", ms=5, zorder=5, label="published, 200 (Table 1)")
    last = found.sel(n=paper.N)
    if np.isfinite(last.v_dt_low) and np.isfinite(last.v_dt_high):
        axis.axvspan(float(last.v_dt_low), float(last.v_dt_high), color=figures.GREY, alpha=0.25, lw=0)
        axis.plot([], [], color=figures.GREY, alpha=0.4, lw=6, label="minimum for 200, 95 %")
    axis.set(xlabel=artefact.V_D, ylabel="evacuation time / s", ylim=(0, None))
    axis.legend(loc="lower right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Where the minimum lies, for each number of persons."""
    return [_minimum(found.sel(n=n)) for n in paper.FIG1_RANKS] + [_slower(found.sel(n=paper.N))]


def _minimum(column: xr.Dataset) -> Verdict:
    statement, said = f"t_e of {int(column.n)} least at", f"{paper.V_DT:g} m/s ({MINIMUM[0]} to {MINIMUM[1]})"
    at, low, high = (float(column[f"v_dt{end}"]) for end in ("", "_low", "_high"))
    if not np.isfinite(at):
        return Verdict(statement, said, "undecided", None)
    inside = MINIMUM[0] <= at <= MINIMUM[1]
    holds = None if inside and not high - low <= TELLING else inside
    return Verdict(statement, said, f"{interval(at, low, high, 2)} m/s", holds)


def _slower(column: xr.Dataset) -> Verdict:
    """Faster is slower: the times above the threshold against the least."""
    above = column.isel(v_d=-1)
    least = column.isel(v_d=int(column.time_of_exit.argmin("v_d")))
    text = f"{artefact.said(above, 'time_of_exit', 1)} s at {float(above.v_d):g}, "
    text += f"{artefact.said(least, 'time_of_exit', 1)} s at {float(least.v_d):g} m/s"
    return Verdict("faster is slower above it", "yes", text, artefact.larger(above, least, "time_of_exit"))


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
