"""The cells of a gathered grid: runs that differ by their seed alone."""

import itertools
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from engine import OUTCOMES

SEED, RANK = "seed", "exit"
QUANTILES = (0.0, 0.25, 0.5, 0.75, 1.0)
Value = bool | int | float | str


class Cell(NamedTuple):
    """What the runs of one combination of the other axes gave."""

    at: dict[str, Value]  # axis -> value
    counts: dict[str, int]  # outcome -> number of runs, "missing" among them
    clearance: tuple[float, ...] | None  # s, QUANTILES of the runs in which all got out; None where none did
    share_out: tuple[float, ...] | None  # QUANTILES over the runs that are there; None where none is

    @property
    def runs(self) -> int:
        """Number of runs that are there."""
        return sum(number for outcome, number in self.counts.items() if outcome != "missing")


def axes_of(ds: xr.Dataset) -> dict[str, list[Value]]:
    """Axes of the grid but the seed, in their order, with their values."""
    return {str(name): ds[name].values.tolist() for name in ds.outcome.dims if name != SEED}


def cells_of(ds: xr.Dataset) -> list[Cell]:
    """The cells of a dataset of `sweep.open_results`, the last axis fastest."""
    axes = axes_of(ds)
    last = ds.exit_time.max(RANK)
    points = itertools.product(*(range(len(values)) for values in axes.values()))
    return [_cell(ds, last, axes, dict(zip(axes, point, strict=True))) for point in points]


def _cell(ds: xr.Dataset, last: xr.DataArray, axes: Mapping[str, list[Value]], point: dict[str, int]) -> Cell:
    outcome, persons, out = (np.atleast_1d(ds[name].isel(point).values) for name in ("outcome", "persons", "N_out"))
    cleared = np.atleast_1d(last.isel(point).values)[outcome == OUTCOMES.index("all_out")]
    there = (outcome != OUTCOMES.index("missing")) & (persons > 0)
    counts = {word: int((outcome == code).sum()) for code, word in enumerate(OUTCOMES)}
    at = {name: axes[name][k] for name, k in point.items()}
    return Cell(at, counts, _quantiles(cleared), _quantiles(out[there] / persons[there]))


def _quantiles(values: np.ndarray) -> tuple[float, ...] | None:
    return tuple(map(float, np.quantile(values, QUANTILES))) if values.size else None
