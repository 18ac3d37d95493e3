"""Gathering: the runs of a grid as one dataset, kept in one file."""

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray as xr

from engine import FINGERPRINT
from engine.errors import require
from sweep import schema
from sweep.durable import replace_durably
from sweep.errors import DamagedFile
from sweep.grid import Grid
from sweep.schema import GATHERED, Variable
from sweep.store import Entry, Store

COMMON = (
    "Common random numbers: the same seed means the same places and bodies, whatever the values of the other "
    "axes, as far as room and N are the same. Differences between runs of one seed are paired differences."
)
Facts = dict[str, np.ndarray]


def gather(grid: Grid, store: Path | str | Store) -> xr.Dataset:
    """The runs of a grid that are in a store.

    `dataset.nc` in the store is rebuilt if the grid or one of its runs changed since it was written.

    Returns
    -------
    Dataset with one dimension and coordinate for each axis, in the order of the grid, and last `exit`, the
    rank of leaving from 1; constants are scalar coordinates. Where a run has no such exit, `exit_time` is nan
    and `exit_person` -1; where there is no run, `outcome` is 0, "missing".

    Raises
    ------
    DamagedFile
        If a run file that should be whole is not.
    """
    store = Store(store)
    finished = store.finished()
    keys = [schema.run_key(grid.scenario(point)) for point in grid.points()]
    content = _content(grid, keys, finished)
    if content == _content_of(store.dataset):
        with suppress(DamagedFile):  # it can be made again
            return open_results(store.path)
    rows = [_facts(store, key) if key in finished else None for key in keys]
    ds = _dataset(grid, rows).assign_attrs(content=content)
    replace_durably(store.dataset, lambda path: _write(ds, path))
    return open_results(store.path)


def open_results(path: Path | str) -> xr.Dataset:
    """The gathered dataset of a store.

    Raises
    ------
    BadInput
        If the store has none.
    DamagedFile
        If it cannot be read.
    """
    store = Store(path)
    remedy = "run its sweep, or `jamsweep gather`, first"
    require(store.dataset.is_file(), "store", f"'{store.path}'", "holds no gathered dataset", remedy)
    try:
        with xr.open_dataset(store.dataset, engine="netcdf4") as ds:
            return ds.load()
    except (OSError, RuntimeError):
        raise DamagedFile(f"dataset '{store.dataset}' is damaged: delete it and gather again") from None


def _content(grid: Grid, keys: list[str], finished: Mapping[str, Entry]) -> str:
    """Hash of what a dataset is made of: the grid, and the files of its runs."""
    files = [finished[key].sha256 if key in finished else "" for key in keys]
    return hashlib.sha256(json.dumps([grid.to_json(), keys, files]).encode()).hexdigest()


def _content_of(path: Path) -> str:
    try:
        with netCDF4.Dataset(path) as file:
            return str(file.content)
    except (OSError, AttributeError):  # absent, or not of this kind
        return ""


def _facts(store: Store, key: str) -> Facts:
    """What a run file adds to the dataset."""
    path = store.file(key)
    try:
        with netCDF4.Dataset(path) as file:
            file.set_auto_maskandscale(False)
            whole = (file.complete, file.run_key) == (1, key)
            facts = {v.name: file.variables[v.name][:] for v in GATHERED}
    except (OSError, RuntimeError, AttributeError, KeyError):
        whole = False
    if not whole:
        raise DamagedFile(f"run file '{path}' is damaged: delete it and sweep again")
    return facts


def _dataset(grid: Grid, rows: list[Facts | None]) -> xr.Dataset:
    ranks = max((len(row["exit_time"]) for row in rows if row), default=0)
    ranks = max(ranks, 1)  # a dimension without length would stop every reduction
    variables = {v.name: _variable(v, grid, rows, ranks) for v in GATHERED}
    coords: dict[str, Any] = {name: (name, list(values), _described(name)) for name, values in grid.axes.items()}
    coords |= {name: ((), value, _described(name)) for name, value in grid.constants.items()}
    coords["exit"] = ("exit", np.arange(1, ranks + 1), schema.RANK)
    return xr.Dataset(variables, coords, _attributes(grid))


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


def _attributes(grid: Grid) -> dict[str, Any]:
    return {
        "Conventions": schema.CONVENTIONS,
        "title": f"Runs of {grid.name}",
        "room": grid.name,
        "constants": json.dumps(dict(grid.constants)),
        "defaults": json.dumps(grid.defaults),
        "grid": grid.to_json(),
        "random_numbers": COMMON,
        "engine_fingerprint": FINGERPRINT,
        "schema_version": np.int32(schema.SCHEMA_VERSION),
    }


def _write(ds: xr.Dataset, path: Path) -> None:
    numeric = {name for name, variable in ds.variables.items() if variable.dtype.kind in "iufb"}
    packed = {"zlib": True, "complevel": 1, "shuffle": True}
    encoding = {n: ({"_FillValue": None} | (packed if n in numeric and ds[n].ndim else {})) for n in numeric}
    ds.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)
