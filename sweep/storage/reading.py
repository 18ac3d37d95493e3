"""Single runs, wherever they are: in a file of their own, or folded into a shard of the store that names them."""

import tempfile
from pathlib import Path

import xarray as xr

from engine.errors import require
from sweep.errors import DamagedFile
from sweep.storage import shard
from sweep.storage.datasets import open_run
from sweep.storage.store import Store, holding


def read_run(path: Path | str) -> xr.Dataset:
    """What `to_dataset` makes of the run that this file holds, or held until it was folded into a shard.

    Raises
    ------
    BadInput
        If there is no such file.
    DamagedFile
        If it cannot be read, or is not what the manifest of its store says.
    """
    path = Path(path)
    store = holding(path)
    if not path.is_file() and store:
        folded = _unfolded(store, path.stem)
        if folded is not None:
            return folded
    remedy = f"name a run file, such as one of those in {path / 'runs'}"
    require(not path.is_dir(), "run file", f"'{path}'", "is a folder", remedy)
    require(path.is_file(), "run file", f"'{path}'", "does not exist", "name a file that a run was written to")
    if store:
        store.require_whole(path.stem)
    try:
        return open_run(path)
    except (OSError, RuntimeError):
        raise DamagedFile(f"run file '{path}' cannot be read: it is damaged, or none of a run") from None


def _unfolded(store: Store, key: str) -> xr.Dataset | None:
    for name, folded in store.vouched.shards().items():
        path = store.shard(name)
        keys = [entry.key for entry in shard.entries(path)] if path.is_file() else []
        if key in keys:
            shard.require_whole(path, folded)
            with tempfile.TemporaryDirectory() as folder:
                shard.unfold_to(path, keys.index(key), Path(folder) / f"{key}.nc")
                return open_run(Path(folder) / f"{key}.nc")
    return None
