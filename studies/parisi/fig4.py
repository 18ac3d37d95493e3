"""Figure 4 of Parisi & Dorso (2005): mean delay between exits against desired speed."""

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

LEAST = (1.75, 2.5)  # m/s, as of Fig. 1


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Mean delay of each run, and its mean over runs."""
    delays = measures.delays(sweeps.speeds).delay.mean("exit").rename("delay")
    delays.attrs = {"units": "s", "long_name": "delay"}
    return measures.mean_over(delays)


def plot(found: xr.Dataset) -> Figure:
    """The mean delay, and the published evacuation times as delays of 200 persons."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT)
    artefact.points(axis, found, "delay", 0, "found, 95 %")
    published = {v_d: t / paper.N for v_d, t in paper.EVACUATION_TIME.items()}
    axis.plot([*published], [*published.values()], "x", color="black", ms=5, zorder=5, label="published $t_e$/200")
    axis.set(xlabel=artefact.V_D, ylabel="mean delay / s", ylim=(0, None))
    axis.legend(loc="lower right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """The least mean delay, and whether it rises above the threshold."""
    best = found.isel(v_d=int(found.delay.argmin("v_d")))
    text = f"{artefact.said(best, 'delay', 3)} s at {float(best.v_d):g} m/s"
    rising = artefact.at(found, float(best.v_d), np.inf)
    steps = np.diff(rising.delay.values)
    clear = rising.delay_low.values[1:] > rising.delay_high.values[:-1]
    falls = rising.delay_high.values[1:] < rising.delay_low.values[:-1]
    rises = False if falls.any() else True if (steps > 0).all() or clear.all() else None
    return [
        Verdict(
            "mean delay least near 2 m/s", f"{LEAST[0]} to {LEAST[1]}", text, bool(LEAST[0] <= best.v_d <= LEAST[1])
        ),
        Verdict("mean delay rises monotonously above it", "rises", f"{artefact.each(rising, 'delay')} s", rises),
    ]


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
