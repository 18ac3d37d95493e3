"""A shard: many runs in one netCDF file, variable by variable, each run's values behind those of the run before.

Runs of one shard have the same variables. A variable's values are one long array; how many of them are whose follows
from `size_DIM(run)` for each dimension DIM of run files. Attributes of the runs, and their lines of the manifest, are
packed JSON. What is unfolded is the run file, byte for byte as long as the netCDF library is the same.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import netCDF4
import numpy as np

from sweep import schema
from sweep.errors import DamagedFile
from sweep.schema import Variable
from sweep.storage.durable import sha256_of
from sweep.storage.manifest import Entry, Folded
from sweep.storage.runfile import Stored, write_stored

KIND = "shard of runs, layout 1"
CHUNK = 2**18  # values; damage or a single run's reading costs one of these
ENDS = 4  # x0, y0, x1, y1: the one dimension whose length is always the same
Facts = dict[str, np.ndarray]
UNREADABLE = (OSError, RuntimeError, AttributeError, KeyError, ValueError, TypeError, IndexError)


class Layout(NamedTuple):
    """What the runs of a shard have in common."""

    columns: tuple[tuple[str, bool], ...]  # name of a variable, whether it is packed

    def variables(self) -> tuple[Variable, ...]:
        """The variables, in the order in which a run file has them."""
        return tuple(schema.named(name, packed) for name, packed in self.columns)


def layout_of(run: Stored) -> Layout:
    """The layout of the shards that a run fits into."""
    return Layout(tuple((variable.name, bool(variable.resolution)) for variable, _ in run.variables))


def write(runs: Sequence[Stored], entries: Sequence[Entry], path: Path) -> None:
    """Write runs of one layout as a new file; not durable by itself."""
    layout = layout_of(runs[0])
    with netCDF4.Dataset(path, "x", format="NETCDF4") as file:
        file.set_fill_off()
        file.createDimension("run", len(runs))
        for name, sizes in _sizes(runs).items():
            _column(file, f"size_{name}", ("run",), sizes)
        for k, variable in enumerate(layout.variables()):
            values = np.concatenate([run.variables[k][1].ravel() for run in runs])
            dims = ("_".join(variable.dims),)
            if dims[0] not in file.dimensions:
                file.createDimension(dims[0], len(values))
            _column(file, variable.name, dims, values).setncatts(variable.attributes())
        _text(file, "attributes", [{n: _plain(v) for n, v in run.attributes.items()} for run in runs])
        _text(file, "entries", [asdict(entry) for entry in entries])
        file.setncatts({"kind": KIND, "columns": json.dumps(layout.columns), "Conventions": schema.CONVENTIONS})


def entries(path: Path) -> list[Entry]:
    """The runs of a shard, as the manifest had them; none if it cannot be read."""
    try:
        with netCDF4.Dataset(path) as file:
            return [Entry(**{**entry, "shard": path.stem}) for entry in _read_text(file, "entries")]
    except UNREADABLE:
        return []


def require_whole(path: Path, folded: Folded) -> None:
    """Raise `DamagedFile` unless a shard's bytes are those that were written."""
    try:
        state = path.stat()
        whole = _hashed(path, state.st_ino, state.st_size, state.st_mtime_ns) == folded.sha256
    except FileNotFoundError:
        whole = False
    if not whole:
        raise DamagedFile(f"shard '{path}' is damaged: `jamsweep verify --repair` sets it aside, then sweep again")


@lru_cache(maxsize=4096)
def _hashed(path: Path, inode: int, size: int, changed: int) -> str:
    return sha256_of(path)


def facts(path: Path, wanted: Sequence[str]) -> Iterator[Facts]:
    """These variables of each run, in the order of `entries`; all of dimension `run` or `exit`."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        columns = {name: file.variables[name][:] for name in wanted}
        sizes = _all_sizes(file)
    ends = {name: np.concatenate([[0], np.cumsum(_lengths(schema.named(name), sizes))]) for name in wanted}
    for k in range(len(sizes["run"])):
        yield {name: column[ends[name][k] : ends[name][k + 1]] for name, column in columns.items()}


def unfold(path: Path, row: int) -> Stored:
    """One run, every value of it."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        sizes, columns = _all_sizes(file), _columns(file)
        values = tuple((v, _part(file.variables[v.name], v, sizes, row)) for v in columns)
        return Stored(values, _attributes(_read_text(file, "attributes")[row]))


def unfold_all(path: Path) -> Iterator[Stored]:
    """Every run, in order."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        sizes, attributes = _all_sizes(file), _read_text(file, "attributes")
        columns = [(variable, file.variables[variable.name][:]) for variable in _columns(file)]
    for row, own in enumerate(attributes):
        yield Stored(tuple((v, _part(column, v, sizes, row)) for v, column in columns), _attributes(own))


def unfold_to(path: Path, row: int, target: Path) -> None:
    """Write one run as a file of its own."""
    write_stored(unfold(path, row), target)


def _columns(file: netCDF4.Dataset) -> tuple[Variable, ...]:
    return Layout(tuple((name, packed) for name, packed in json.loads(file.columns))).variables()


def _part(column: Any, variable: Variable, sizes: Mapping[str, np.ndarray], row: int) -> np.ndarray:
    lengths = _lengths(variable, sizes)
    begin = int(lengths[:row].sum())
    shape = [ENDS if name == "end" else int(sizes[name][row]) for name in variable.dims]
    part: np.ndarray = column[begin : begin + int(lengths[row])]
    return part.reshape(shape)


def _lengths(variable: Variable, sizes: Mapping[str, np.ndarray]) -> np.ndarray:
    """Number of values of a variable in each run."""
    length = np.ones(len(sizes["run"]), np.int64)
    for name in variable.dims:
        length = length * (ENDS if name == "end" else sizes[name])
    return length


def _sizes(runs: Sequence[Stored]) -> dict[str, np.ndarray]:
    each = [{n: size for v, x in run.variables for n, size in zip(v.dims, x.shape, strict=True)} for run in runs]
    names = [name for name in each[0] if name not in ("run", "end")]
    return {name: np.array([sizes[name] for sizes in each], np.int64) for name in names}


def _all_sizes(file: netCDF4.Dataset) -> dict[str, np.ndarray]:
    sizes = {n.removeprefix("size_"): v[:] for n, v in file.variables.items() if n.startswith("size_")}
    return sizes | {"run": np.ones(file.dimensions["run"].size, np.int64)}


def _column(file: netCDF4.Dataset, name: str, dims: tuple[str, ...], values: np.ndarray) -> netCDF4.Variable:
    chunks = (min(len(values), CHUNK),) if len(values) else None
    column = file.createVariable(name, values.dtype, dims, zlib=True, complevel=1, shuffle=True, chunksizes=chunks)
    column.set_auto_maskandscale(False)
    column[:] = values
    return column


def _text(file: netCDF4.Dataset, name: str, parts: list[dict[str, Any]]) -> None:
    letters = np.frombuffer(json.dumps(parts).encode(), np.uint8)
    file.createDimension(f"{name}_letter", len(letters))
    _column(file, name, (f"{name}_letter",), letters)


def _read_text(file: netCDF4.Dataset, name: str) -> list[dict[str, Any]]:
    variable = file.variables[name]
    variable.set_auto_maskandscale(False)
    parts: list[dict[str, Any]] = json.loads(variable[:].tobytes())
    return parts


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _attributes(plain: dict[str, Any]) -> dict[str, Any]:
    return {name: np.int32(value) if isinstance(value, int) else value for name, value in plain.items()}
