"""sweep: many runs, kept in files and gathered into one dataset.

from engine import rooms
from sweep import Grid, sweep
grid = Grid(rooms.lin_room, v_d=[0.6, 1.0], N=[100, 200], seed=range(10))
ds = sweep(grid, store="results/mine")
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from sweep.errors import CannotWrite, DamagedFile, SweepStopped
from sweep.grid import Grid
from sweep.storage.store import Store

if TYPE_CHECKING:
    from sweep.gathering import gather
    from sweep.results import open_results
    from sweep.runner import sweep
    from sweep.storage.compact import compact
    from sweep.storage.datasets import to_dataset
    from sweep.storage.reading import read_run
    from sweep.storage.runfile import write_run
    from sweep.storage.verify import verify
    from sweep.until import Until

# What needs xarray is imported when it is first asked for, so that `jamsweep status` answers at once.
_LATER = {
    "Until": "sweep.until",
    "compact": "sweep.storage.compact",
    "gather": "sweep.gathering",
    "open_results": "sweep.results",
    "read_run": "sweep.storage.reading",
    "sweep": "sweep.runner",
    "to_dataset": "sweep.storage.datasets",
    "verify": "sweep.storage.verify",
    "write_run": "sweep.storage.runfile",
}

__all__ = [
    "CannotWrite",
    "DamagedFile",
    "Grid",
    "Store",
    "SweepStopped",
    "Until",
    "compact",
    "gather",
    "open_results",
    "read_run",
    "sweep",
    "to_dataset",
    "verify",
    "write_run",
]


def __getattr__(name: str) -> Any:
    """A function that is kept in a module of its own."""
    if name not in _LATER:
        raise AttributeError(f"module 'sweep' has no attribute {name!r}")
    found = getattr(import_module(_LATER[name]), name)
    globals()[name] = found
    return found
