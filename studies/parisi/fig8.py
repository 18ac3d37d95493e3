"""Figure 8 of Parisi & Dorso (2005): arch-clogging correlation of delays in bins (Eq. 6)."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.fig7 import label_of
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper

ALMOST_ONE, NONE = 0.95, 0.05
LONG, SHORT = 2.3, 0.1  # s, the bins


def measure(sweeps: Sweeps) -> xr.Dataset:
    """c_ac of the delays of all runs, for clean arches and any."""
    return measures.arch_clogging_correlation(sweeps.speed_counts)


def plot(found: xr.Dataset) -> Figure:
    """One curve for each bin, clean arches left and any right."""
    figure, axes = figures.panels(2, figures.PAGE, artefact.HEIGHT)
    for axis, kind in zip(axes, ("clean", "any"), strict=True):
        for k, delay in enumerate(found.delay.values):
            of_bin = found.sel(kind=kind, delay=delay)
            artefact.points(axis, of_bin, "c_ac", k, label_of(delay, float(of_bin.delay_end)))
        axis.axhline(
            paper.SHORTEST_BIN_C_AC, color=figures.GREY, lw=0.8, ls="--", label="published: at most, 0.1-0.3 s"
        )
        axis.set(xlabel=artefact.V_D, title=f"{kind} arches", ylim=(-0.03, 1.05))
    axes[0].set_ylabel("arch-clogging correlation $c_{ac}$, 95 %")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Long delays: arches above the threshold, none below; short ones: 30 % at most."""
    clean = found.sel(kind="clean")
    fast, slow = (artefact.at(clean.sel(delay=LONG), *span) for span in ((3.0, np.inf), (0.0, 1.5)))
    short = clean.sel(delay=SHORT)
    most = short.isel(v_d=int(short.c_ac.argmax("v_d")))
    return [
        Verdict(
            "c_ac (clean), delays from 2.3 s, from 3 m/s",
            f"almost 1 (from {ALMOST_ONE})",
            f"{artefact.each(fast, 'c_ac')} ({int(fast.delays.sum())} delays)",
            artefact.within(fast.c_ac, ALMOST_ONE, 1.0),
        ),
        Verdict(
            "c_ac (clean), delays from 2.3 s, up to 1.5 m/s",
            f"0 (below {NONE})",
            f"{artefact.each(slow, 'c_ac')} ({int(slow.delays.sum())} delays)",
            artefact.within(slow.c_ac, 0.0, NONE),
        ),
        Verdict(
            "c_ac (clean), delays of 0.1-0.3 s, up to 4 m/s",
            f"at most {paper.SHORTEST_BIN_C_AC}",
            artefact.each(artefact.at(short, 2.0, 4.0), "c_ac"),
            artefact.within(artefact.at(short, 0.0, 4.0).c_ac, 0.0, paper.SHORTEST_BIN_C_AC),
        ),
        Verdict(
            "c_ac (clean), delays of 0.1-0.3 s, at every v_d",
            f"at most {paper.SHORTEST_BIN_C_AC}",
            f"{artefact.said(most, 'c_ac')} at {float(most.v_d):g} m/s",
            artefact.within(short.c_ac, 0.0, paper.SHORTEST_BIN_C_AC),
        ),
    ]


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
