"""One run as a dataset."""

from pathlib import Path

import numpy as np
import xarray as xr

from engine import Run
from sweep import schema
from sweep.storage.runfile import attributes_of


def open_run(path: Path) -> xr.Dataset:
    """What `to_dataset` makes of the run that a file holds."""
    with xr.open_dataset(path, engine="netcdf4") as ds:
        return _with_rank(ds.load().isel(run=0))


def to_dataset(run: Run) -> xr.Dataset:
    """A run as a dataset: the names, types and attributes of its file, without the dimension `run`.

    Returns
    -------
    Dataset with dims `exit` (rank from 1, a coordinate), `person`, and where recorded `sample` and `contact`
    """
    variables = {v.name: (v.dims, schema.fact(run, v), attributes_of(v)) for v in schema.recorded(run)}
    ds = xr.Dataset(variables, attrs=schema.run_attributes(run)).isel(run=0)
    return _with_rank(ds.set_coords([name for name in ["time"] if name in ds]))


def _with_rank(ds: xr.Dataset) -> xr.Dataset:
    return ds.assign_coords(exit=("exit", np.arange(1, ds.sizes["exit"] + 1), schema.RANK))
