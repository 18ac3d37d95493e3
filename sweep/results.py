"""The gathered dataset as a file: written once, vouched for by the manifest, opened whole or piece by piece."""

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import xarray as xr

from engine.errors import require
from sweep.errors import DamagedFile
from sweep.storage.durable import replace_durably, sha256_of
from sweep.storage.store import Store

CONTENT = "content"  # attribute: hash of what the dataset was made of


def open_results(path: Path | str, chunks: Mapping[str, int] | str | int | None = None) -> xr.Dataset:
    """The gathered dataset of a store.

    Parameters
    ----------
    path : folder of the store
    chunks : None loads all values; sizes of chunks, as in `xarray.open_dataset`, leave them on disk until they are
        needed, which takes dask

    Raises
    ------
    BadInput
        If the store has none, or dask is asked for and not there.
    DamagedFile
        If its bytes are not those that were written; reading them once to know takes a second a gigabyte.
    """
    store = Store(path)
    store.check_version()
    remedy = "run its sweep, or `jamsweep gather`, first"
    require(store.dataset.is_file(), "store", f"'{store.path}'", "holds no gathered dataset", remedy)
    able = chunks is None or find_spec("dask") is not None
    require(able, "chunks", chunks, "take dask, which is not installed", "pip install 'jamsweep[dask]'")
    found = sha256_of(store.dataset)  # first: what is gathered meanwhile is vouched for before it has its name
    vouched = store.vouched.datasets()
    damaged = f"dataset '{store.dataset}' is damaged: delete it and gather again"
    if vouched and found not in vouched:
        raise DamagedFile(damaged)
    try:
        return _opened(store.dataset, chunks)
    except (OSError, RuntimeError):
        raise DamagedFile(damaged) from None


def is_made_of(store: Store, content: str) -> bool:
    """Whether the store has a whole dataset that was made of this."""
    made_of = store.vouched.datasets()
    try:
        return content in made_of.values() and made_of.get(sha256_of(store.dataset)) == content
    except OSError:
        return False


def keep_results(ds: xr.Dataset, store: Store) -> None:
    """Put the dataset into the store; the manifest vouches for it before it has its name."""

    def write(path: Path) -> None:
        _write(ds, path)
        store.vouched.add_dataset(sha256_of(path), ds.attrs[CONTENT])

    replace_durably(store.dataset, write)


def _opened(path: Path, chunks: Any) -> xr.Dataset:
    if chunks is not None:
        return xr.open_dataset(path, engine="netcdf4", chunks=chunks)
    with xr.open_dataset(path, engine="netcdf4") as ds:
        return ds.load()


def _write(ds: xr.Dataset, path: Path) -> None:
    """Write with a checksum on every variable that can have one; scalars cannot, the manifest's hash covers them."""
    numeric = {name for name, variable in ds.variables.items() if variable.dtype.kind in "iufb"}
    packed = {"zlib": True, "complevel": 1, "shuffle": True}
    encoding = {n: ({"_FillValue": None} | (packed if n in numeric and ds[n].ndim else {})) for n in numeric}
    ds.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)
