"""How the figures of all studies look: one style, safe for colour-blind readers and for print."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a8a8a"  # Okabe & Ito (2008)
COLUMN, PAGE = 3.4, 7.1  # in, widths of print

STYLE: dict[Any, Any] = {  # matplotlib types its keys one by one
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "savefig.dpi": 200,
    "figure.constrained_layout.use": True,
}


def panels(columns: int, width: float = PAGE, height: float = 3.1) -> tuple[Figure, list[Axes]]:
    """A figure of panels side by side with common axes."""
    figure, axes = plt.subplots(1, columns, figsize=(width, height), sharex=True, sharey=True, squeeze=False)
    return figure, list(axes[0])


def grid(rows: int, columns: int, width: float, height: float) -> tuple[Figure, list[list[Axes]]]:
    """A figure of rows and columns of panels with common axes."""
    figure, axes = plt.subplots(rows, columns, figsize=(width, height), sharex=True, sharey=True, squeeze=False)
    return figure, [list(row) for row in axes]


def stacked(rows: int, width: float = COLUMN, height: float = 4.6, same: bool = True) -> tuple[Figure, list[Axes]]:
    """A figure of panels above each other, with common axes if they show the same."""
    figure, axes = plt.subplots(rows, 1, figsize=(width, height), sharex=same, sharey=same, squeeze=False)
    return figure, list(axes[:, 0])


def draw(plot: Callable[[xr.Dataset], Figure], found: xr.Dataset, path: Path) -> None:
    """Draw a study's figure in the common style, without a screen, and write it."""
    mpl.use("agg")
    with mpl.rc_context(STYLE):
        figure = plot(found)
        figure.savefig(path)
        plt.close(figure)
