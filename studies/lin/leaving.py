"""Leaving curves and clearance times of one crowd at all desired speeds: what Figures 7 and 8 are made of."""

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from studies import measures
from studies.lin import artefact
from studies.lin.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.estimates import V_D

LEAST_RUNS = measures.Rules().least_runs  # out of a cell, for an interval to be drawn
STRIP = 1.12  # of the longest time: where runs that blocked stand
HEIGHT = 5.0  # in


def measure(sweeps: Sweeps, N: int) -> xr.Dataset:
    """All runs of a crowd of N, and what became of them at each v_d."""
    ds = sweeps.speeds.sel(N=N)
    return artefact.cells(ds).assign(artefact.runs_of(ds).data_vars)


def plot(found: xr.Dataset, published: dict[float, float] | None = None) -> Figure:
    """All leaving curves, coloured by v_d; below, all clearance times, with blocked runs in a strip of their own."""
    figure, (curves, times) = figures.stacked(2, height=HEIGHT, same=False)
    v_d = found.v_d.values
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.92, v_d.size))
    for colour, v in zip(colours, v_d, strict=True):
        artefact.leaving(curves, found.sel(v_d=v), colour, width=0.5)
    scale = mpl.cm.ScalarMappable(BoundaryNorm(np.arange(v_d.size + 1) - 0.5, v_d.size), ListedColormap(colours))
    bar = figure.colorbar(scale, ax=[curves, times], ticks=np.arange(v_d.size), pad=0.02, aspect=40)
    bar.ax.set_yticklabels([f"{v:g}" for v in v_d])
    bar.set_label("$v_d$ / m s$^{-1}$")
    bar.ax.tick_params(length=0)
    curves.set(xlabel="time / s", ylabel="persons out", xlim=(0, None), ylim=(0, int(found.persons.max()) * 1.04))
    _times(times, found, colours, published or {})
    artefact.labelled([curves, times])
    figure.legend(*times.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _times(axis: Axes, found: xr.Dataset, colours: np.ndarray, published: dict[float, float]) -> None:
    times = found.time_of_run.where(np.isfinite(found.time_of_run))
    longest = float(times.max()) if times.notnull().any() else 1.0
    for colour, v in zip(colours, found.v_d.values, strict=True):
        of_runs = times.sel(v_d=v).values
        spread = v + np.linspace(-0.05, 0.05, of_runs.size)
        axis.plot(spread, of_runs, ".", ms=3.5, color=colour)
        stuck = np.isinf(found.time_of_run.sel(v_d=v).values)
        axis.plot(spread[stuck], np.full(stuck.sum(), STRIP * longest), "x", ms=3, mew=0.8, color=colour)
        if stuck.any():
            text = f"{int(found.blocked.sel(v_d=v))}/{int(found.runs.sel(v_d=v))}"
            axis.annotate(text, (v, 1.16 * longest), ha="center", fontsize=6)
    axis.axhspan(1.07 * longest, 1.26 * longest, color=figures.GREY, alpha=0.15, lw=0)
    mean, told = found.clearance_time, found.out >= LEAST_RUNS
    arms = np.abs([mean - found.clearance_time_low.where(told), found.clearance_time_high.where(told) - mean])
    label = "mean of those out, 95 %"
    axis.errorbar(found.v_d, mean, arms, fmt="-", color="black", capsize=2, lw=1, label=label)
    if published:
        label = "published"
        axis.plot([*published], [*published.values()], "D", mfc="white", mec="black", ms=4, zorder=5, label=label)
    axis.plot([], [], ".", color=figures.GREY, ms=4, label="one run")
    artefact.grey_cross(axis, "blocked (of all runs)")
    axis.set(xlabel=V_D, ylabel="clearance time / s", ylim=(0, 1.26 * longest))
