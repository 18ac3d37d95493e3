"""How points with intervals are drawn and said, the same in the studies of all papers."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from studies.presentation import figures
from studies.presentation.verdicts import interval

STYLES = (  # colour, marker, line: told apart without colour too
    (figures.BLUE, "o", "-"),
    (figures.ORANGE, "s", "--"),
    (figures.GREEN, "^", "-."),
    (figures.PURPLE, "D", ":"),
)
V_D = "desired speed $v_d$ / m s$^{-1}$"
NEAR = 1e-9  # m/s, m: for comparing axis values


def points(axis: Axes, ds: xr.Dataset, name: str, style: int, label: str | None = None, along: str = "v_d") -> None:
    """A variable against an axis, with `name`_low and `name`_high as arms."""
    colour, marker, line = STYLES[style]
    at, mean = ds[along].values, ds[name].values
    arms = np.abs([mean - ds[f"{name}_low"].values, ds[f"{name}_high"].values - mean])
    axis.errorbar(
        at, mean, np.nan_to_num(arms), color=colour, marker=marker, ls=line, ms=3, capsize=2, lw=1, label=label
    )


def said(cell: xr.Dataset, name: str, digits: int = 2) -> str:
    """An estimate with its interval, in words."""
    at, low, high = (float(cell[f"{name}{end}"]) for end in ("", "_low", "_high"))
    return interval(at, low, high, digits)


def at(ds: xr.Dataset, low: float, high: float, along: str = "v_d") -> xr.Dataset:
    """The cells from low to high, both included."""
    return ds.sel({along: slice(low - NEAR, high + NEAR)})


def each(ds: xr.Dataset, name: str, digits: int = 2, along: str = "v_d") -> str:
    """The estimates of all cells: "3: 0.55, 4: 0.71"."""
    cells = zip(ds[along].values, ds[name].values, strict=True)
    return ", ".join(f"{x:g}: {value:.{digits}f}" for x, value in cells)


def within(values: xr.DataArray, low: float, high: float) -> bool | None:
    """Whether all finite values lie between low and high; None where there are none."""
    finite = values.values[np.isfinite(values.values)]
    return bool(((finite >= low) & (finite <= high)).all()) if finite.size else None


def larger(cell: xr.Dataset, other: xr.Dataset, name: str) -> bool | None:
    """Whether an estimate is larger in one cell than in the other; None where the intervals overlap."""
    if cell[f"{name}_low"] > other[f"{name}_high"]:
        return True
    return False if cell[f"{name}_high"] < other[f"{name}_low"] else None
