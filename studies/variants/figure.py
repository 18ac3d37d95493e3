"""The figure: how much worse than the best each variant is, and which statements it misses."""

import matplotlib as mpl
import matplotlib.pyplot as plt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.presentation import figures
from studies.variants.page import ranked
from studies.variants.room import DEFAULT
from studies.variants.score import TOO_FEW, verdicts
from studies.variants.targets import MOST, TARGETS

LINEAR_TO = 10.0  # of the axes of scores, logarithmic beyond
MARKERS = {
    "best": ("*", figures.GREEN, 8),
    "not told apart": ("o", figures.BLUE, 4),
    "ruled out": ("X", figures.ORANGE, 5),
    TOO_FEW: ("s", figures.GREY, 4),
}


def plot(found: xr.Dataset) -> Figure:
    """Above: paired difference of scores to the best variant. Below: what each statement adds to each score."""
    ordered = found.sel(variant=ranked(found))
    figure, (above, below) = plt.subplots(
        2, 1, figsize=(figures.COLUMN, 8.0), gridspec_kw={"height_ratios": [1.2, 1.5]}
    )
    _differences(above, ordered)
    _terms(figure, below, ordered)
    return figure


def _differences(axis: Axes, found: xr.Dataset) -> None:
    words = verdicts(found)
    best = next(name for name, word in words.items() if word == "best")
    apart = found.sel(group="all", other=best)
    names = [str(name) for name in found.variant.values]
    for k, name in enumerate(names):
        at, low, high = (float(apart[f"difference{end}"].sel(variant=name)) for end in ("", "_low", "_high"))
        marker, colour, size = MARKERS[words[name]]
        axis.plot([low, high], [k, k], "-", color=colour, lw=1.2)
        axis.plot([at], [k], marker, color=colour, ms=size)
    for word, (marker, colour, size) in MARKERS.items():
        if word not in words.values():
            continue
        axis.plot([], [], marker, color=colour, ms=size, label=word)
    axis.axvline(0.0, color=figures.GREY, lw=0.8, zorder=0)
    axis.set_xscale("symlog", linthresh=LINEAR_TO, linscale=0.8)
    axis.set_xticks([-100, -10, 0, 10, 100], ["-100", "-10", "0", "10", "100"])
    low = float(apart.difference_low.min())
    axis.set_xlim(min(1.5 * low, -3.0), 1.6 * float(apart.difference_high.max()))
    axis.set_yticks(range(len(names)), [f"{name} (default)" if name == DEFAULT else name for name in names], fontsize=6)
    axis.invert_yaxis()
    axis.set_xlabel(f"score less that of\n{best} (1)")
    axis.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, handletextpad=0.2, columnspacing=0.8)


def _terms(figure: Figure, axis: Axes, found: xr.Dataset) -> None:
    values = found.term.transpose("target", "variant").values
    colours = mpl.colors.PowerNorm(0.5, vmin=0.0, vmax=MOST)
    image = axis.imshow(values, aspect="auto", cmap="cividis_r", norm=colours)
    axis.set_yticks(range(len(TARGETS)), [f"{target.figure}: {short(target.statement)}" for target in TARGETS])
    axis.set_xticks(range(found.variant.size), found.variant.values, rotation=90)
    axis.tick_params(labelsize=6, length=0)
    axis.spines[:].set_visible(False)
    parted = sum(target.group == TARGETS[0].group for target in TARGETS) - 0.5
    axis.axhline(parted, color="white", lw=2.0)
    axis.set_ylabel("Figure: statement (held out below the line)")
    bar = figure.colorbar(image, ax=axis, orientation="horizontal", aspect=40, pad=0.02)
    bar.set_label("added to the score (1)")
    bar.set_ticks([0, 1, 4, 9, 16, 25])


def short(statement: str) -> str:
    """A statement as a label, without the published number."""
    words = {
        "clearance time, ": "T, ",
        "without rotation": "",
        "rotation off at": "no rotation,",
        "flow in 10 s": "10 s flow",
    }
    text = statement.rpartition(": ")[0]
    for long, less in words.items():
        text = text.replace(long, less)
    return text.partition(", clearance time")[0].partition(", blocked share")[0]
