"""Rules for `until` of a sweep: half-widths of intervals over wanted ones, and cells beside undecided boundaries."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from itertools import pairwise, product
from typing import Any

import numpy as np
import xarray as xr

from engine.errors import number, require
from studies import measures
from sweep.grid import Point
from sweep.until import Until

NUMBERS = ("least", "batch", "budget")
BOUNDARIES = ("transition_from", "phase_separation_from")
DIGITS = 6  # of a new v_d
NEAR = 1e-9  # m/s


@dataclass(frozen=True)
class HalfWidths:
    """Half-widths that are wanted of each cell's intervals of 95 %.

    Parameters
    ----------
    clearance_time : of the mean over the runs that got out, as a share of it, in cells in the smooth state, and in
        those that may be: undecided, and most of whose runs got out
    blocked_share : of the share, in all cells
    """

    clearance_time: float | None = 0.05
    blocked_share: float | None = 0.1

    def __call__(self, ds: xr.Dataset) -> xr.DataArray:
        """The greater of the half-widths over the wanted ones, (axes but seed...); nan where there is no run."""
        shares = measures.blocked_share(ds)
        excess = xr.zeros_like(shares.blocked_share).where(shares.runs > 0)
        if self.blocked_share is not None:
            half = (shares.blocked_share_high - shares.blocked_share_low) / 2.0
            excess = np.maximum(excess, half / self.blocked_share)
        if self.clearance_time is not None:
            half = xr.where(may_be_smooth(ds), relative_half_width(ds).fillna(np.inf), 0.0)
            excess = np.maximum(excess, half / self.clearance_time)
        found: xr.DataArray = excess
        return found


def relative_half_width(ds: xr.Dataset) -> xr.DataArray:
    """Half-width of the mean clearance time over the runs that got out, over that mean; nan for fewer than 2."""
    facts = measures.clearance(ds)
    time = facts.clearance_time.where(measures.outcome_is(ds, "all_out"))
    mean = measures.mean_over(time, censored=facts.censored)
    half: xr.DataArray = (mean.clearance_time_high - mean.clearance_time_low) / 2.0 / mean.clearance_time
    return half


def may_be_smooth(ds: xr.Dataset) -> xr.DataArray:
    """Cells in the smooth state, or of a state not yet decided and most of whose runs got out."""
    if "v_d" not in ds.dims:
        return measures.blocked_share(ds).blocked_share < 0.5
    found = measures.states(ds)
    words = found.state.attrs["flag_meanings"].split()
    smooth, undecided = (found.state == words.index(word) for word in ("smooth", "undecided"))
    cells: xr.DataArray = smooth | (undecided & (found.blocked < 0.5 * found.runs))
    return cells.sel(v_d=ds.v_d)  # in the order of the grid, which `states` sorts


@dataclass(frozen=True)
class Boundaries:
    """New cells where the interval of a boundary between states holds gaps in v_d wider than `resolution`, m/s."""

    resolution: float = 0.1

    def __call__(self, ds: xr.Dataset) -> list[Point]:
        """Middles of such gaps, column by column, as values of the axes but `seed`."""
        found = measures.states(ds)
        names = [str(dim) for dim in found.runs.dims if dim != "v_d"]
        columns = (
            dict(zip(names, at, strict=True)) for at in product(*(found[name].values.tolist() for name in names))
        )
        return [where | {"v_d": v_d} for where in columns for v_d in self._gaps(found.sel(where))]

    def _gaps(self, column: xr.Dataset) -> list[float]:
        v_d = column.v_d.values[column.runs.values > 0]
        middles: set[float] = set()
        for name in BOUNDARIES:
            low, high = float(column[f"{name}_low"]), float(column[f"{name}_high"])
            for a, b in pairwise(v_d):
                if b - a > self.resolution + NEAR and a < high - NEAR and b > low + NEAR:
                    middles.add(round((a + b) / 2.0, DIGITS))
        return sorted(middles)


def until_of(table: Mapping[str, Any]) -> Until:
    """The rule that a table describes, such as [until] of a grid file.

    Parameters
    ----------
    table : any of `clearance_time` and `blocked_share`, wanted half-widths (`HalfWidths`), at least one of them;
        `resolution`, m/s, to refine v_d (`Boundaries`); `least`, `batch`, `budget` (`Until`)

    Raises
    ------
    BadInput
        If an entry is not known or out of its range.
    """
    goals = [field.name for field in fields(HalfWidths)]
    for name in table:
        known = [*goals, "resolution", *NUMBERS]
        require(name in known, "until: entry", repr(name), "is not known", f"keep to {', '.join(known)}")
    wanted = {name: _positive(name, table[name]) if name in table else None for name in goals}
    some = any(value is not None for value in wanted.values())
    require(some, "until", dict(table), "has no goal", f"give {' or '.join(goals)}")
    refine = Boundaries(_positive("resolution", table["resolution"])) if "resolution" in table else None
    return Until(HalfWidths(**wanted), refine=refine, **{name: table[name] for name in NUMBERS if name in table})


def _positive(name: str, given: Any) -> float:
    value = number(f"until: {name}", given, "give a number above 0, such as 0.1")
    require(value > 0.0, f"until: {name}", value, "is not above 0", "give a number such as 0.1")
    return value
