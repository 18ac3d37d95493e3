"""One run, as a file and as a dataset."""

from pathlib import Path

import netCDF4
import numpy as np
import xarray as xr

from engine import Run
from engine.errors import require
from sweep import schema
from sweep.durable import replace_durably
from sweep.schema import Variable

TOGETHER = 8  # persons in one chunk of a file


def write_run(run: Run, path: Path | str) -> None:
    """Write a run as netCDF4; equal runs make equal files, byte for byte.

    Exits and contacts are CF contiguous ragged arrays, counted by `N_out` and `row_size`.
    """
    replace_durably(Path(path), lambda temporary: _write(run, temporary))


def read_run(path: Path | str) -> xr.Dataset:
    """What `to_dataset` makes of the run that this file holds.

    Raises
    ------
    BadInput
        If there is no such file.
    """
    require(
        Path(path).is_file(),
        "run file",
        f"'{path}'",
        "does not exist",
        "name a file that a run was written to",
    )
    with xr.open_dataset(path, engine="netcdf4") as ds:
        return _with_rank(ds.load().isel(run=0))


def to_dataset(run: Run) -> xr.Dataset:
    """A run as a dataset: the names, types and attributes of its file, without the dimension `run`.

    Returns
    -------
    Dataset with dims `exit` (rank from 1, a coordinate), `person`, and where recorded `sample` and `contact`
    """
    variables = {v.name: (v.dims, schema.fact(run, v), _attributes(v)) for v in schema.recorded(run)}
    ds = xr.Dataset(variables, attrs=schema.run_attributes(run)).isel(run=0)
    return _with_rank(ds.set_coords([name for name in ["time"] if name in ds]))


def _with_rank(ds: xr.Dataset) -> xr.Dataset:
    return ds.assign_coords(exit=("exit", np.arange(1, ds.sizes["exit"] + 1), schema.RANK))


def _attributes(variable: Variable) -> dict[str, object]:
    counting = {"sample_dimension": variable.counts} if variable.counts else {}
    return variable.attributes() | counting


def _write(run: Run, path: Path) -> None:
    with netCDF4.Dataset(path, "x", format="NETCDF4") as file:
        file.set_fill_off()
        for variable in schema.recorded(run):
            _write_variable(file, variable, schema.fact(run, variable))
        file.setncatts(schema.run_attributes(run))


def _write_variable(file: netCDF4.Dataset, variable: Variable, values: np.ndarray) -> None:
    """Write a variable packed by zlib, whose checksum makes damage visible."""
    for name, size in zip(variable.dims, values.shape, strict=True):
        if name not in file.dimensions:
            file.createDimension(name, size)
    attributes = _attributes(variable)
    if variable.dims[0] == "sample" and variable.name != "time":
        attributes["coordinates"] = "time"
    fill, kind = None, variable.dtype
    if variable.resolution:
        values, fill, kind = schema.packed(values, variable.resolution), schema.NOTHING, "i4"
        attributes["scale_factor"] = variable.resolution
    chunks = _chunks(variable, values.shape)
    stored = file.createVariable(
        variable.name,
        kind,
        variable.dims,
        zlib=True,
        complevel=1,
        shuffle=True,
        fill_value=fill,
        chunksizes=chunks,
    )
    stored.setncatts(attributes)
    stored.set_auto_maskandscale(False)
    stored[:] = values


def _chunks(variable: Variable, shape: tuple[int, ...]) -> tuple[int, int] | None:
    """A few persons at all times together: what changes little from time to time packs well."""
    return (shape[0], min(shape[1], TOGETHER)) if variable.dims == schema.STATE and all(shape) else None
