"""Figure 9 of Lin, Ma & Lo (2016): flow in bins of 10 s of 100 and 300 persons, at several desired speeds."""

import sys

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from studies import measures
from studies.lin import artefact
from studies.lin.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.estimates import V_D, at
from studies.presentation.verdicts import Verdict
from studies.published import lin2016 as paper

Floats = NDArray[np.float64]
STEP = 1.0 / paper.FIG9_BIN  # 1/s: one person more or less in a bin
FIRST = 1  # bin: in the first one people are still on their way to the exit
HEIGHT = 4.4  # in
REDRAWN = 4000  # pictures like the paper's that are drawn from the runs
WIDTH = 0.13  # m/s, of a box


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Flow in each bin of each run, from the second one to the last whole one."""
    ds = sweeps.speeds.sel(N=list(paper.FIG9_N))
    flow = measures.flow_in_bins(ds, paper.FIG9_BIN).flow.isel(time=slice(FIRST, None))
    # a blocked run stands still for the whole of its last two minutes, which the paper's curves do not show
    last = ds.exit_time.max("exit").fillna(0.0)
    return xr.Dataset({"flow": flow.where(flow.time <= last).transpose("N", "v_d", "seed", "time")})


def plot(found: xr.Dataset) -> Figure:
    """For each N: a box a desired speed (5 %, median, 95 % of the bins of all runs) over the published ranges."""
    figure, axes = figures.stacked(found.N.size, height=HEIGHT)
    for axis, N in zip(axes, found.N.values, strict=True):
        _published(axis, float(found.v_d.max()))
        for v_d in found.v_d.values:
            _box(axis, float(v_d), found.flow.sel(N=N, v_d=v_d).values)
        axis.set_title(f"$N$ = {N}", loc="left")
        axis.set_ylabel("flow in 10 s / s$^{-1}$")
    axes[0].plot([], [], color=figures.GREY, lw=7, alpha=0.8, label="5 to 95 % of the bins")
    axes[0].plot([], [], color="black", lw=1.2, label="median")
    axes[0].plot([], [], color=figures.GREY, lw=0.8, label="all bins")
    axes[-1].set(xlabel=V_D, ylim=(-0.05, 1.9))
    artefact.labelled(axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _published(axis: Axes, last: float) -> None:
    for k, ((begin, end), (least, most)) in enumerate(paper.FIG9_FLOW.items()):
        edges = begin - 0.1, min(end, last) + 0.1
        label = "published range" if k == 0 else None
        axis.fill_between(edges, least, most, color=figures.BLUE, alpha=0.2, lw=0, label=label)


def _box(axis: Axes, v_d: float, flow: Floats) -> None:
    flow = flow[np.isfinite(flow)]
    if not flow.size:
        return
    least, low, middle, high, most = np.quantile(flow, [0.0, 0.05, 0.5, 0.95, 1.0])
    axis.plot([v_d, v_d], [least, most], color=figures.GREY, lw=0.8)
    axis.bar(v_d, high - low, WIDTH, low, color=figures.GREY, alpha=0.8, lw=0)
    axis.plot([v_d - WIDTH / 2, v_d + WIDTH / 2], [middle, middle], color="black", lw=1.2)


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Each published range: both ends against those of pictures like the paper's, and the share of bins inside."""
    made = [_range(found, *published) for published in paper.FIG9_FLOW.items()]
    return [verdict for several in made for verdict in several]


def redrawn(cells: list[Floats], seed: int = 0) -> tuple[Floats, Floats]:
    """Least and greatest bin of pictures with one run of each cell, drawn at random: (REDRAWN,) each.

    cells : (runs, bins) each, NaN where there is no bin
    """
    rng = np.random.default_rng(seed)
    least, most = np.full(REDRAWN, np.inf), np.full(REDRAWN, -np.inf)
    for bins in cells:
        held = bins[np.isfinite(bins).any(axis=1)]
        if held.size:
            which = rng.integers(len(held), size=REDRAWN)
            least = np.minimum(least, np.nanmin(held, axis=1)[which])
            most = np.maximum(most, np.nanmax(held, axis=1)[which])
    return least, most


def _range(found: xr.Dataset, v_d: tuple[float, float], published: tuple[float, float]) -> list[Verdict]:
    """A range that the paper read off one run a cell grows with the number of runs, so like is compared with like.

    An end agrees if it lies within 95 % of the ends of redrawn pictures, give or take one person.
    """
    flows = at(found, *v_d).flow
    where = f"{v_d[0]:g} m/s" if v_d[0] == v_d[1] else (f"{v_d[0]:g} to {v_d[1]:g} m/s")
    where = f"from {v_d[0]:g} m/s" if np.isinf(v_d[1]) else where
    values = flows.values[np.isfinite(flows.values)]
    if not values.size:
        return [Verdict(f"flow in 10 s, {where}", f"{published[0]:g} to {published[1]:g} /s", "not in this grid", None)]
    ends = redrawn([flows.sel(N=N, v_d=v).values for N in flows.N.values for v in flows.v_d.values])
    named = zip(("least", "greatest"), published, ends, strict=True)
    inside = (values >= published[0] - STEP / 2) & (values <= published[1] + STEP / 2)
    share = f"{inside.mean():.0%} of {values.size} bins inside"
    return [_end(f"{name} flow in 10 s, {where}", said, end, share) for name, said, end in named]


def _end(statement: str, published: float, drawn: Floats, share: str) -> Verdict:
    low, middle, high = np.quantile(drawn, [0.025, 0.5, 0.975])
    near = STEP * 1.01
    text = f"{middle:.1f} [{low:.1f}, {high:.1f}] /s, {share}"
    return Verdict(statement, f"{published:g} /s", text, bool(low - near <= published <= high + near))


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
