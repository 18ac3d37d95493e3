"""One run as a file."""

from pathlib import Path
from typing import Any, NamedTuple

import netCDF4
import numpy as np

from engine import Run
from sweep import schema
from sweep.schema import Variable
from sweep.storage.durable import replace_durably

TOGETHER = 8  # persons in one chunk of a file


class Stored(NamedTuple):
    """A run as its file holds it: values as they are stored, of variables that may be packed."""

    variables: tuple[tuple[Variable, np.ndarray], ...]
    attributes: dict[str, Any]


def write_run(run: Run, path: Path | str) -> None:
    """Write a run as netCDF4; equal runs make equal files, byte for byte.

    Exits and contacts are CF contiguous ragged arrays, counted by `N_out` and `row_size`.
    """
    replace_durably(Path(path), lambda temporary: write_stored(stored(run), temporary))


def attributes_of(variable: Variable) -> dict[str, object]:
    """Attributes of a variable, those among them that say what it counts."""
    counting = {"sample_dimension": variable.counts} if variable.counts else {}
    return variable.attributes() | counting


def stored(run: Run) -> Stored:
    """What the file of a run is to hold."""
    values = ((v, schema.fact(run, v)) for v in schema.recorded(run))
    packed = ((v, schema.packed(x, v.resolution) if v.resolution else x) for v, x in values)
    return Stored(tuple(packed), schema.run_attributes(run))


def read_stored(path: Path) -> Stored:
    """What a run file holds, every value of it."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        variables = (schema.named(name, packed="scale_factor" in v.ncattrs()) for name, v in file.variables.items())
        values = tuple((v, file.variables[v.name][:]) for v in variables)
        return Stored(values, {name: file.getncattr(name) for name in file.ncattrs()})


def write_stored(run: Stored, path: Path) -> None:
    """Write a new file; not durable by itself."""
    with netCDF4.Dataset(path, "x", format="NETCDF4") as file:
        file.set_fill_off()
        for variable, values in run.variables:
            _write_variable(file, variable, values)
        file.setncatts(run.attributes)


def _write_variable(file: netCDF4.Dataset, variable: Variable, values: np.ndarray) -> None:
    """Write a variable packed by zlib, whose checksum makes damage visible."""
    for name, size in zip(variable.dims, values.shape, strict=True):
        if name not in file.dimensions:
            file.createDimension(name, size)
    kept = file.createVariable(
        variable.name,
        variable.stored_dtype,
        variable.dims,
        zlib=True,
        complevel=1,
        shuffle=True,
        fill_value=schema.NOTHING if variable.resolution else None,
        chunksizes=_chunks(variable, values.shape),
    )
    kept.setncatts(stored_attributes(variable))
    kept.set_auto_maskandscale(False)
    kept[:] = values


def stored_attributes(variable: Variable) -> dict[str, Any]:
    """Attributes of a variable in a file."""
    attributes = attributes_of(variable)
    if variable.dims[0] == "sample" and variable.name != "time":
        attributes["coordinates"] = "time"
    if variable.resolution:
        attributes["scale_factor"] = variable.resolution
    return attributes


def _chunks(variable: Variable, shape: tuple[int, ...]) -> tuple[int, int] | None:
    """A few persons at all times together: what changes little from time to time packs well."""
    return (shape[0], min(shape[1], TOGETHER)) if variable.dims == schema.STATE and all(shape) else None
