"""Gathering: the runs of a grid as one dataset, kept in one file."""

import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from engine import FINGERPRINT, BadInput
from sweep import schema
from sweep.errors import DamagedFile
from sweep.grid import Grid
from sweep.report import tell
from sweep.results import CONTENT, is_made_of, keep_results, open_results
from sweep.schema import GATHERED, Variable
from sweep.storage.facts import Facts, Source
from sweep.storage.keys import Wanted, keys_of
from sweep.storage.serving import RERUN, Serving, serving
from sweep.storage.store import Store

COMMON = (
    "Common random numbers: the same seed means the same places and bodies, whatever the values of the other "
    "axes, as far as room and N are the same. Differences between runs of one seed are paired differences."
)
OWN = (
    "Independent random numbers: every cell draws its own, from the seed and the cell's parameters. Runs of one seed "
    "have nothing in common; differences between cells are not paired."
)


class Gathered(NamedTuple):
    """A dataset, and how many damaged runs were set aside for it."""

    ds: xr.Dataset
    aside: int


def gather(grid: Grid, store: Path | str | Store, on_code_change: str = RERUN) -> xr.Dataset:
    """The runs of a grid that are in a store.

    `dataset.nc` in the store is rebuilt if the grid or one of its runs changed since it was written. Every file that
    is read is held against its hash; one that is damaged is set aside (`KEY.nc.corrupt`), said, and its run missing.

    Parameters
    ----------
    on_code_change : "accept" also takes runs of other states of the engine, and the attribute `accepted_engines` says
        how many; "error" refuses, "rerun" leaves them out

    Returns
    -------
    Dataset with one dimension and coordinate for each axis, in the order of the grid, and last `exit`, the
    rank of leaving from 1; constants are scalar coordinates. Where a run has no such exit, `exit_time` is nan
    and `exit_person` -1; where there is no run, or the cell has no such seed, `outcome` is 0, "missing".

    Raises
    ------
    BadInput
        If the folder is none of a store.
    DamagedFile
        If a damaged file cannot be set aside.
    SweepStopped
        If there are runs of another engine and `on_code_change` is "error".
    """
    return collect(grid, store, on_code_change).ds


def collect(grid: Grid, store: Path | str | Store, on_code_change: str = RERUN) -> Gathered:
    """As `gather`; also tells whether damage was met."""
    store = Store(store)
    store.check()
    wanted = keys_of(grid, store)
    served = serving(wanted, store, on_code_change)
    content = served.content(wanted, grid.to_json())
    if is_made_of(store, content):
        kept = _of_content(content, store)
        if kept is not None:
            return Gathered(kept, 0)
    rows, aside = _rows(wanted, served, store)
    whole = Serving({key: entry for key, entry in served.entries.items() if rows[key]}, served.stale)
    of = {tuple(point.values()): rows[w.key] for w, point in zip(wanted, grid.points(), strict=True)}
    ds = _dataset(grid, [of.get(tuple(point.values())) for point in grid.product()], whole)
    return Gathered(_kept(ds.assign_attrs({CONTENT: whole.content(wanted, grid.to_json())}), store), aside)


def _kept(ds: xr.Dataset, store: Store) -> xr.Dataset:
    """The dataset as the store has it from now on; as it is, where the store takes no more."""
    try:
        keep_results(ds, store)
    except OSError as error:
        tell(f"the dataset is not kept in '{store.path}' ({(error.strerror or 'refused').lower()})")
        return ds
    kept = _of_content(ds.attrs[CONTENT], store)
    return ds if kept is None else kept


def _of_content(content: str, store: Store) -> xr.Dataset | None:
    """The dataset of a store; None if it is damaged, or another sweep put that of its own grid there meanwhile."""
    with suppress(BadInput, DamagedFile, OSError):
        ds = open_results(store.path)
        return ds if ds.attrs[CONTENT] == content else None
    return None


def _rows(wanted: list[Wanted], served: Serving, store: Store) -> tuple[dict[str, Facts | None], int]:
    """Key -> what the run adds to the dataset, None if there is none; and the number of runs set aside."""
    source = Source(store)
    rows: dict[str, Facts | None] = {}
    for key in (w.key for w in wanted):
        entry = served.entries.get(key)
        rows[key] = source.facts(entry) if entry else None
    return rows, source.aside


def _dataset(grid: Grid, rows: list[Facts | None], served: Serving) -> xr.Dataset:
    ranks = max((len(row["exit_time"]) for row in rows if row), default=0)
    ranks = max(ranks, 1)  # a dimension without length would stop every reduction
    variables = {v.name: _variable(v, grid, rows, ranks) for v in GATHERED}
    coords: dict[str, Any] = {name: (name, list(values), _described(name)) for name, values in grid.axes.items()}
    coords |= {name: ((), value, _described(name)) for name, value in grid.constants.items()}
    coords["exit"] = ("exit", np.arange(1, ranks + 1), schema.RANK)
    return xr.Dataset(variables, coords, _attributes(grid, served.engines()))


def _variable(variable: Variable, grid: Grid, rows: list[Facts | None], ranks: int) -> xr.Variable:
    """Values over the axes, padded to `ranks` exits."""
    ragged = variable.dims == ("exit",)
    values = np.full((len(rows), ranks if ragged else 1), variable.pad, variable.dtype)
    for k, row in enumerate(rows):
        if row:
            values[k, : row[variable.name].size] = row[variable.name]
    shape = (*grid.shape, ranks) if ragged else grid.shape
    dims = (*grid.axes, "exit") if ragged else tuple(grid.axes)
    return xr.Variable(dims, values.reshape(shape), variable.attributes())


def _described(name: str) -> dict[str, str]:
    units, long_name = schema.PARAMETERS.get(name, ("", ""))
    return {"units": units, "long_name": long_name} if units else {"long_name": name}


def _engine_of(grid: Grid) -> str:
    """The state of the engine by which a grid is run; rooms of one's own may have laws of their own."""
    first = next(iter(grid.points()), None)
    return FINGERPRINT if grid.seeds_alone or first is None else schema.engine_of(grid.scenario(first))


def _attributes(grid: Grid, others: Mapping[str, int]) -> dict[str, Any]:
    return {
        "Conventions": schema.CONVENTIONS,
        "title": f"Runs of {grid.name}",
        "room": grid.name,
        "constants": json.dumps(dict(grid.constants)),
        "defaults": json.dumps(grid.defaults),
        "grid": grid.to_json(),
        "common_random_numbers": np.int8(grid.common_random_numbers),
        "random_numbers": COMMON if grid.common_random_numbers else OWN,
        "engine_fingerprint": _engine_of(grid),
        "schema_version": np.int32(schema.SCHEMA_VERSION),
        **({"accepted_engines": json.dumps(others)} if others else {}),
    }
