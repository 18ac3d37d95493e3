"""What all figures of this paper share: their files, and how points with intervals are drawn and said."""

from types import ModuleType

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict, interval, table

STYLES = (  # colour, marker, line: told apart without colour too
    (figures.BLUE, "o", "-"),
    (figures.ORANGE, "s", "--"),
    (figures.GREEN, "^", "-."),
    (figures.PURPLE, "D", ":"),
)
V_D = "desired speed $v_d$ / m s$^{-1}$"
HEIGHT = 2.6  # in
NEAR = 1e-9  # m/s, m: for comparing axis values
THINNED = "\n\nThinned: three seeds and fewer values; it shows that all works."


def make(artefact: ModuleType, sweeps: Sweeps) -> list[Verdict]:
    """Draw one figure and give its verdicts."""
    found = artefact.measure(sweeps)
    figures.draw(artefact.plot, found, sweeps.folder / f"{artefact.__name__.rpartition('.')[2]}.png")
    verdicts: list[Verdict] = artefact.verdicts(found)
    return verdicts


def main(artefact: ModuleType, quick: bool, jobs: int) -> None:
    """Run what is missing, draw one figure, print its verdicts."""
    sweeps = Sweeps(quick, jobs)
    sweeps.folder.mkdir(parents=True, exist_ok=True)
    verdicts = make(artefact, sweeps)
    name = artefact.__name__.rpartition(".")[2]
    print(table(verdicts) + (THINNED if quick else ""), f"\n{sweeps.folder / name}.png", sep="\n")


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
