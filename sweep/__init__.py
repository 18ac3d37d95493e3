"""sweep: many runs, kept in files and gathered into one dataset.

from engine import rooms
from sweep import Grid, sweep
grid = Grid(rooms.lin_room, v_d=[0.6, 1.0], N=[100, 200], seed=range(10))
ds = sweep(grid, store="results/mine")
"""

from sweep.errors import CannotWrite, DamagedFile, SweepStopped
from sweep.gather import gather
from sweep.grid import Grid
from sweep.results import open_results
from sweep.runner import sweep
from sweep.storage.compact import compact
from sweep.storage.reading import read_run
from sweep.storage.runfile import to_dataset, write_run
from sweep.storage.store import Store
from sweep.storage.verify import verify
from sweep.until import Until, sweep_until

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
    "sweep_until",
    "to_dataset",
    "verify",
    "write_run",
]
