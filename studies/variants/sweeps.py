"""The runs that are compared: the same seeds for all variants, in the cells that published numbers speak of."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from studies import measures
from studies.variants.room import VARIANTS, variant_room
from sweep import Grid, sweep

FOLDER = Path("results/variants")
SEEDS, QUICK_SEEDS = 12, 3
QUICK_VARIANTS = ("kept 0.3", "reset", "reset / reset", "kept 0.5 / kept")


class Cell(NamedTuple):
    """A place in the space of parameters: N persons, desired speed (m/s), A (N), whether bodies rotate."""

    N: int
    v_d: float
    A: float = 300.0
    rotation: bool = True

    def __str__(self) -> str:
        """As a user reads it: "N=100 v_d=2 without rotation"."""
        more = "" if self.A == 300.0 else f" A={self.A:g}"
        return f"N={self.N} v_d={self.v_d:g}{more}{'' if self.rotation else ' without rotation'}"


MANY_V_D = (0.6, 1.0, 1.2, 1.4, 1.6, 1.8)
FEW_V_D = (0.6, 1.0, 1.6, 2.0)
CELLS = (
    *(Cell(200, v_d) for v_d in MANY_V_D),
    *(Cell(100, v_d) for v_d in FEW_V_D),
    *(Cell(100, 1.0, A) for A in (200.0, 500.0)),
    *(Cell(100, v_d, rotation=False) for v_d in (1.0, 2.0)),
)


def grids(seeds: int, variants: Sequence[str] = tuple(VARIANTS)) -> list[Grid]:
    """The cells as grids: rectangles of the axes that differ within them."""
    common = {"variant": list(variants), "seed": range(seeds)}
    return [
        Grid(variant_room, v_d=list(MANY_V_D), N=200, A=300.0, rotation=True, **common),
        Grid(variant_room, v_d=list(FEW_V_D), N=100, A=300.0, rotation=True, **common),
        Grid(variant_room, v_d=1.0, N=100, A=[200.0, 500.0], rotation=True, **common),
        Grid(variant_room, v_d=[1.0, 2.0], N=100, A=300.0, rotation=False, **common),
    ]


def run(seeds: int, jobs: int, variants: Sequence[str] = tuple(VARIANTS), folder: Path = FOLDER) -> xr.Dataset:
    """Run what is missing; the facts of all cells: see `facts`, with the dimensions cell, variant, seed."""
    found = [facts(sweep(grid, folder, jobs=jobs)) for grid in grids(seeds, variants)]
    rows = [_cell(found, cell) for cell in CELLS]
    return xr.concat(rows, xr.Variable("cell", [str(cell) for cell in CELLS]), coords="minimal", compat="override")


def _cell(found: list[xr.Dataset], cell: Cell) -> xr.Dataset:
    """The facts (variant, seed) of a cell, from whichever grid holds it."""
    for ds in found:
        with_axes = ds.expand_dims([name for name in cell._fields if name not in ds.dims])
        held = all(value in with_axes[name].values for name, value in cell._asdict().items())
        if held:
            return with_axes.sel(cell._asdict()).drop_vars(cell._fields).transpose("variant", "seed")
    raise LookupError(f"no grid holds the cell {cell}")


def facts(ds: xr.Dataset) -> xr.Dataset:
    """What the score is made of, one value a run (axes...).

    Returns
    -------
    Dataset with `known` and `blocked` bool; `clearance_time` s, NaN unless all got out; `least` and `most` 1/s,
    the range of the flow in bins of 10 s that lie whole within the run, without the first, in which people
    are still on their way; `least` is 0 where the exit is blocked, however early the run ended.
    """
    known = measures.outcome_is(ds, "all_out", "blocked", "frozen", "time_limit")
    blocked = measures.outcome_is(ds, "blocked", "frozen")
    time = measures.clearance(ds).clearance_time
    flow = measures.flow_in_bins(ds).flow.isel(time=slice(1, None))
    return xr.Dataset(
        {
            "known": known,
            "blocked": blocked,
            "clearance_time": time.where(measures.outcome_is(ds, "all_out")),
            "least": flow.min("time").where(~blocked, 0.0),
            "most": flow.max("time"),
        }
    )
