"""Figure 10 of Parisi & Dorso (2005): probability of a blocking cluster against door width; t_e against it."""

import sys

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, ScalarFormatter

from studies import measures
from studies.parisi import artefact
from studies.parisi.fig9 import LABELS
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict, interval
from studies.published import parisi2005 as paper

FACTOR = 15.0  # by which the probability falls from the narrowest to the widest door, at least


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Blocking probability, mean evacuation time, and the law that it follows, over L."""
    times = measures.clearance(sweeps.doors)
    out = times.clearance_time.where(measures.outcome_is(sweeps.doors, "all_out"))
    law = measures.decay(xr.Dataset({"clearance_time": out}), "clearance_time")
    means = measures.mean_over(out, censored=times.censored)
    found = measures.blocking_probability(sweeps.door_counts)
    found = found.assign(means.drop_vars(["runs", "censored"]).data_vars)
    return found.assign(law.drop_vars("runs").data_vars)


def plot(found: xr.Dataset) -> Figure:
    """Left the paper's figure, right the evacuation times with both laws."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(figures.PAGE, artefact.HEIGHT))
    for k, (kind, words) in enumerate(LABELS.items()):
        artefact.points(left, found.sel(kind=kind), "blocking_probability", k, f"{words}, 95 %", along="L")
    left.set(ylabel="P(blocking cluster)", yscale="log")
    artefact.points(right, found, "clearance_time", 0, "found, 95 %", along="L")
    _laws(right, found)
    right.set(ylabel="evacuation time / s", yscale="log")
    right.yaxis.set_major_formatter(ScalarFormatter())
    right.yaxis.set_minor_formatter(ScalarFormatter())
    for axis in (left, right):
        axis.set(xlabel="width of the door $L$ / m", xscale="log")
        axis.set_xticks(found.L.values, [f"{L:g}" for L in found.L.values])
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.legend(loc="lower left" if axis is left else "upper right")
    return figure


def _laws(axis: Axes, found: xr.Dataset) -> None:
    """Both fitted laws, through the mean of the logarithms as least squares has them."""
    L = np.linspace(float(found.L.min()), float(found.L.max()), 100)
    middle = np.log(found.clearance_time).mean().item()
    at = {"exponential": (L, found.L.values), "power": (np.log(L), np.log(found.L.values))}
    for (law, (x, fitted)), (colour, _, line) in zip(at.items(), artefact.STYLES[1:3], strict=True):
        log_t = middle + float(found.slope.sel(law=law)) * (x - fitted.mean())
        axis.plot(L, np.exp(log_t), color=colour, ls=line, lw=1, label=law)


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """How far blocking falls, and by which law the time does."""
    return [*(_falls(found.sel(kind=kind).sortby("L"), kind) for kind in LABELS), _law(found)]


def _falls(column: xr.Dataset, kind: str) -> Verdict:
    narrow, wide = (column.isel(L=k) for k in (0, -1))
    statement = f"P(blocking cluster, {kind}) from {float(narrow.L):g} to {float(wide.L):g} m"
    factor = float(narrow.blocking_probability / wide.blocking_probability)
    text = f"{artefact.said(narrow, 'blocking_probability', 3)} to {artefact.said(wide, 'blocking_probability', 3)}"
    holds = factor >= FACTOR and bool((np.diff(column.blocking_probability) < 0).all())
    return Verdict(statement, f"vanishes (factor {FACTOR:g})", f"{text}, factor {factor:.1f}", holds)


def _law(found: xr.Dataset) -> Verdict:
    better, aic = str(found.better.item()), found.aic
    power = found.sel(law="power")
    text = (
        f"{better}; AIC {float(aic.sel(law='exponential')):.0f} exponential, {float(aic.sel(law='power')):.0f} power, "
    )
    text += f"exponent {interval(float(power.slope), float(power.slope_low), float(power.slope_high), 2)}"
    holds = None if better == "undecided" else better == paper.DOOR_LAW
    return Verdict("t_e falls with L", "exponentially", text, holds)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
