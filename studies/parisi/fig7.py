"""Figure 7 of Parisi & Dorso (2005): number of delays in bins against desired speed."""

import sys

import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Mean number of delays of a run in each bin."""
    counts = measures.delay_counts(sweeps.speeds, paper.DELAY_BINS)
    return measures.mean_over(counts.delay_count, censored=counts.open_wait)


def label_of(begin: float, end: float) -> str:
    """A bin as "0.1-0.3 s"."""
    return f"{begin:g}-{end:g} s" if end < float("inf") else f"from {begin:g} s"


def plot(found: xr.Dataset) -> Figure:
    """One curve for each bin."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, artefact.HEIGHT + 0.2)
    for k, delay in enumerate(found.delay.values):
        of_bin = found.sel(delay=delay)
        artefact.points(axis, of_bin, "delay_count", k, label_of(delay, float(of_bin.delay_end)))
    axis.set(xlabel=artefact.V_D, ylabel="delays of a run, 95 %", ylim=(0, None))
    figure.legend(*axis.get_legend_handles_labels(), loc="outside lower center", ncols=4, columnspacing=1.0)
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Which bins rule where, and that long delays become more above the threshold."""
    slow, fast, middle = (found.sel(v_d=v_d) for v_d in (0.8, 6.0, paper.V_DT))
    rules = slow.delay_count.argmax("delay").item() == 1
    several = ", ".join(
        f"{label_of(float(c.delay), float(c.delay_end))}: {float(c.delay_count):.1f}" for c in _bins(slow)
    )
    short = [artefact.said(cell.sel(delay=0.1), "delay_count", 0) for cell in (slow, fast)]
    more = artefact.larger(fast.sel(delay=0.1), slow.sel(delay=0.1), "delay_count")
    long = [artefact.said(cell.sel(delay=2.3), "delay_count", 1) for cell in (middle, fast)]
    longer = artefact.larger(fast.sel(delay=2.3), middle.sel(delay=2.3), "delay_count")
    return [
        Verdict("delays at 0.8 m/s: most in 0.3-1 s", "most", several, rules),
        Verdict("delays of 0.1-0.3 s: more at high v_d", "more", f"0.8 m/s: {short[0]}, 6 m/s: {short[1]}", more),
        Verdict("delays from 2.3 s: more above 2 m/s", "more", f"2 m/s: {long[0]}, 6 m/s: {long[1]}", longer),
    ]


def _bins(cell: xr.Dataset) -> list[xr.Dataset]:
    return [cell.isel(delay=k) for k in range(cell.sizes["delay"])]


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
