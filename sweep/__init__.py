"""sweep: many runs, kept in files and gathered into one dataset.

from engine import rooms
from sweep import Grid, sweep
grid = Grid(rooms.lin_room, v_d=[0.6, 1.0], N=[100, 200], seed=range(10))
ds = sweep(grid, store="results/mine")
"""

from sweep.errors import DamagedFile, SweepStopped
from sweep.gather import gather, open_results
from sweep.grid import Grid
from sweep.runfile import read_run, to_dataset, write_run
from sweep.runner import sweep
from sweep.store import Store
from sweep.until import Until, sweep_until

__all__ = [
    "DamagedFile",
    "Grid",
    "Store",
    "SweepStopped",
    "Until",
    "gather",
    "open_results",
    "read_run",
    "sweep",
    "sweep_until",
    "to_dataset",
    "write_run",
]
