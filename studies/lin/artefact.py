"""What all figures of this paper share: what became of the runs of each cell, and how leaving curves are drawn."""

from types import ModuleType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from studies import measures
from studies.lin.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.artefact import main as draw_and_tell
from studies.presentation.estimates import NEAR, said
from studies.presentation.verdicts import Verdict, interval

TOLERANCE = 0.2  # of a published clearance time
HEIGHT = 4.6  # in, of two panels above each other
PANELS = "abcd"


def main(artefact: ModuleType, quick: bool, jobs: int) -> None:
    """Run what is missing, draw one figure, print its verdicts."""
    draw_and_tell(artefact, Sweeps(quick, jobs))


def cells(ds: xr.Dataset) -> xr.Dataset:
    """Clearance time and mean flow of every run, their means over those out, and the blocked share of each cell."""
    clearance, flow = measures.clearance(ds), measures.mean_flow(ds)
    out = measures.outcome_is(ds, "all_out")
    times = measures.mean_over(clearance.clearance_time.where(out), censored=clearance.censored)
    flows = measures.mean_over(flow.mean_flow.where(out), censored=flow.censored)
    return xr.Dataset(
        {
            "time_of_run": clearance.clearance_time,
            "flow_of_run": flow.mean_flow,
            "out": times.runs,
            **{name: times[name] for name in times if str(name).startswith("clearance_time")},
            **{name: flows[name] for name in flows if str(name).startswith("mean_flow")},
            **measures.blocked_share(ds).data_vars,
        }
    )


def runs_of(ds: xr.Dataset) -> xr.Dataset:
    """What a leaving curve is drawn from."""
    return ds[["exit_time", "outcome", "N_out", "end_time", "persons"]]


def leaving(axis: Axes, runs: xr.Dataset, colour: object, line: str = "-", width: float = 0.6) -> None:
    """Persons out against time, for each run along `seed`; a run that blocked ends in a cross."""
    stuck = measures.outcome_is(runs, "blocked", "frozen").values
    for k, blocked in enumerate(stuck):
        t = runs.exit_time.values[k]
        t = np.concatenate([[0.0], t[np.isfinite(t)]])
        axis.plot(t, np.arange(t.size), ls=line, color=colour, lw=width, drawstyle="steps-post")
        if blocked:
            axis.plot(t[-1], t.size - 1, "x", color=colour, ms=4, mew=1)


def labelled(axes: list[Axes]) -> None:
    """Letters of the panels, above their left corners."""
    for letter, axis in zip(PANELS, axes, strict=False):
        axis.set_title(f"({letter}) {axis.get_title('left')}".rstrip(), loc="left", fontsize=8)


def published_time(statement: str, cell: xr.Dataset, published: float, tolerance: float = TOLERANCE) -> Verdict:
    """A published clearance time against the mean of the runs that got out, and its interval.

    It agrees if the mean lies within the tolerance; outside, it stays open while the interval reaches in.
    """
    expected = f"{published:.0f} s +- {100 * tolerance:.0f} %"
    mean, low, high = (float(cell[f"clearance_time{end}"].item()) for end in ("", "_low", "_high"))
    runs, out = int(cell.runs.item()), int(cell.out.item())
    if not np.isfinite(mean):
        return Verdict(statement, expected, f"none of {runs} runs got out", False if runs else None)
    near, far = published * (1 - tolerance) - NEAR, published * (1 + tolerance) + NEAR
    reaches = np.isfinite(low) and low <= far and high >= near
    holds = True if near <= mean <= far else (None if reaches else False)
    return Verdict(statement, expected, f"{interval(mean, low, high)} s, {out} of {runs} runs out", holds)


def blocked_words(cell: xr.Dataset) -> str:
    """A blocked share with its interval: "4 of 10 runs, 0.40 [0.17, 0.69]"."""
    return f"{int(cell.blocked)} of {int(cell.runs)} runs, {said(cell, 'blocked_share')}"


def grey_cross(axis: Axes, label: str = "blocked") -> None:
    """Entry of the legend for runs that blocked."""
    axis.plot([], [], "x", color=figures.GREY, ms=4, mew=1, label=label)
