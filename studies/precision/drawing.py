"""The figures: work and precision, bias of the statistics, drift of the energy."""

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from studies.precision.bias import MARGIN, Bias
from studies.precision.cells import Cell, Judged
from studies.precision.conservation import Drift
from studies.precision.front import pareto
from studies.precision.page import Results
from studies.precision.positions import Found
from studies.precision.settings import PAPER, chosen
from studies.presentation import figures

COLOURS = {"velocity_verlet": figures.ORANGE, "predictor": figures.GREEN, "theta": figures.BLUE}
AUTHORS = {"lin_room": "Lin et al.", "parisi_room": "Parisi & Dorso"}
MARKERS = ("o", "s", "^", "D", "v", "P")
STATISTICS = {"clearance time": figures.BLUE, "mean delay": figures.GREEN, "blocked share": figures.ORANGE}
WIDEST = 0.15  # beyond which an interval is cut off


def draw(results: Results, folder: Path) -> None:
    """Write all figures, in the common style, without a screen."""
    mpl.use("agg")
    folder.mkdir(parents=True, exist_ok=True)
    _write(lambda: work_precision(results.positions), folder / "accuracy.png")
    _write(lambda: biases(results.judged), folder / "accuracy-bias.png")
    _write(lambda: energies(results.drifts), folder / "accuracy-energy.png")


def _write(plot: Callable[[], Figure], path: Path) -> None:
    with mpl.rc_context(figures.STYLE):
        figure = plot()
        figure.savefig(path)
        plt.close(figure)


def _title(room: str, v_d: float, last: str) -> str:
    return f"{AUTHORS[room]}: $v_d$ = {v_d:g} m s$^{{-1}}$, {last}"


# --- Work and precision -------------------------------------------------------------------------------------


def work_precision(found: list[Found]) -> Figure:
    """One panel for each case."""
    rows = (len(found) + 1) // 2
    figure, grid = plt.subplots(rows, 2, figsize=(figures.PAGE, 0.5 + 2.9 * rows), squeeze=False)
    tolerances = sorted({p.setting.force_tolerance for f in found for p in f.points})
    for axis, case in zip(grid.flat, found, strict=False):
        _panel(axis, case, tolerances)
    for axis in grid.flat[len(found) :]:
        axis.set_visible(False)
    for axis in grid[:, 0]:
        axis.set_ylabel("RMS error of positions / m")
    _legend(figure, {p.setting.integrator for f in found for p in f.points}, tolerances)
    return figure


def _panel(axis: Axes, found: Found, tolerances: list[float]) -> None:
    points = found.points
    for p in points:
        marker, colour = MARKERS[tolerances.index(p.setting.force_tolerance)], COLOURS[p.setting.integrator]
        axis.plot(p.cost, p.error, marker, ms=3.5, color=colour, mec="white", mew=0.3, alpha=0.9)
    front = [points[k] for k in pareto([(p.cost, p.error) for p in points])]
    axis.plot([p.cost for p in front], [p.error for p in front], color=figures.GREY, lw=1, zorder=0)
    for name, setting in chosen(found.case.room).items():
        p = found.at(setting)
        axis.plot(p.cost, p.error, "o", ms=9, mfc="none", mec="black", mew=0.9)
        shift, side = ((8, 5), "left") if name != PAPER else ((0, 8), "center")
        text = name.replace("%", " %").replace("mm", " mm")
        axis.annotate(text, (p.cost, p.error), shift, textcoords="offset points", ha=side, fontsize=7, zorder=5)
    if found.floor > 0.0:
        axis.axhline(found.floor, color="black", lw=0.7, ls=":")
    axis.set(xscale="log", yscale="log", title=_title(found.case.room, found.case.v_d, f"t = {found.case.time:g} s"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.margins(x=0.12, y=0.1)
    axis.set_xlabel("CPU seconds per simulated second")


def _legend(figure: Figure, integrators: set[str], tolerances: list[float]) -> None:
    lines = [
        *(
            mpl.lines.Line2D([], [], marker="o", ls="", color=c, ms=4, label=n.replace("_", " "))
            for n, c in COLOURS.items()
            if n in integrators
        ),
        *(
            mpl.lines.Line2D([], [], marker=m, ls="", color="black", ms=4, label=f"force tolerance {t:g} N")
            for t, m in zip(tolerances, MARKERS, strict=False)
        ),
        mpl.lines.Line2D([], [], color=figures.GREY, lw=1, label="Pareto front"),
        mpl.lines.Line2D([], [], marker="o", ls="", mfc="none", mec="black", ms=8, label="chosen level, paper"),
        mpl.lines.Line2D([], [], color="black", lw=0.7, ls=":", label="floor of the reference"),
    ]
    figure.legend(handles=lines, loc="outside lower center", ncols=4)


# --- Bias ---------------------------------------------------------------------------------------------------


def biases(judged: list[Judged]) -> Figure:
    """One panel for each cell: every trial's bias with its interval, the tolerated band behind."""
    cells = list(dict.fromkeys(j.cell for j in judged))
    columns = [[j for j in judged if j.cell is cell and j.biases] for cell in cells]
    rows = (len(cells) + 1) // 2
    figure, grid = plt.subplots(rows, 2, figsize=(figures.PAGE, 0.5 + 2.6 * rows), squeeze=False)
    for axis, cell, column in zip(grid.flat, cells, columns, strict=False):
        _forest(axis, cell, column)
    for axis in grid.flat[len(cells) :]:
        axis.set_visible(False)
    for name, colour in STATISTICS.items():
        grid[0, 0].plot([], [], "o", ms=3, color=colour, label=f"{name}, 95 %")
    grid[0, 0].fill_between([], [], color=figures.GREY, alpha=0.25, lw=0, label=f"$\\pm${100 * MARGIN:g} %")
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _forest(axis: Axes, cell: Cell, column: list[Judged]) -> None:
    axis.axvspan(-100 * MARGIN, 100 * MARGIN, color=figures.GREY, alpha=0.25, lw=0)
    axis.axvline(0.0, color="black", lw=0.6)
    for height, j in enumerate(column):
        for k, (name, colour) in enumerate(STATISTICS.items()):
            bias = next(b for b in j.biases if b.quantity == name)
            if np.isfinite([bias.value, bias.low, bias.high]).all():
                _arm(axis, bias, height + 0.22 * (k - 1), colour)
    words = [j.trial.name.replace("_", " ").replace(", ", ",\n", 1) for j in column]
    names = [f"{name} ({j.biases[0].pairs})" for name, j in zip(words, column, strict=True)]
    axis.set_yticks(range(len(column)), names, fontsize=6)
    axis.invert_yaxis()
    drawn = [b for j in column for b in j.biases if b.quantity in STATISTICS]
    ends = np.abs([end for b in drawn for end in (b.low, b.high) if np.isfinite(end)])
    limit = 110 * min(max([*ends, 1.25 * MARGIN]), WIDEST)
    axis.set_xlim(-limit, limit)
    axis.set_title(_title(cell.room, cell.v_d, f"N = {cell.N}"))
    axis.set_xlabel("bias / %, of shares percentage points")


def _arm(axis: Axes, bias: Bias, height: float, colour: str) -> None:
    arms = 100 * np.abs([[bias.value - bias.low], [bias.high - bias.value]])
    axis.errorbar([100 * bias.value], [height], xerr=arms, fmt="o", ms=2.5, capsize=1.5, lw=0.9, color=colour)


# --- Energy -------------------------------------------------------------------------------------------------


def energies(drifts: list[Drift]) -> Figure:
    """One panel for each kind of contact."""
    gases = list(dict.fromkeys(d.gas for d in drifts))
    figure, axes = figures.panels(len(gases), height=2.9)
    for axis, gas in zip(axes, gases, strict=True):
        for integrator, colour in COLOURS.items():
            here = [d for d in drifts if d.gas == gas and d.setting.integrator == integrator]
            if not here:
                continue
            steps, values = [d.setting.dt for d in here], [abs(d.drift) for d in here]
            axis.plot(steps, values, "o-", ms=3, color=colour, label=integrator.replace("_", " "))
        _slope(axis, [d for d in drifts if d.gas == gas])
        axis.set(xscale="log", yscale="log", title=gas, xlabel="time step / s")
    axes[0].set_ylabel("drift of the energy, as a part of it")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _slope(axis: Axes, drifts: list[Drift]) -> None:
    """A line of second order through the largest drift."""
    worst = max(drifts, key=lambda d: abs(d.drift), default=None)
    if worst is None or worst.drift == 0.0:
        return
    steps = np.array([min(d.setting.dt for d in drifts), worst.setting.dt])
    line = abs(worst.drift) * (steps / worst.setting.dt) ** 2
    axis.plot(steps, line, color=figures.GREY, lw=0.8, ls="--", label="second order")
