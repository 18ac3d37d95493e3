"""The sweeps of a study: each run when its facts are first asked for, and kept on disk."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from sweep import Grid, Store, read_run, sweep
from sweep.grid import Point
from sweep.schema import run_key


class Swept(NamedTuple):
    """A grid and the folder of its runs."""

    grid: Grid
    folder: Path


class Sweeps:
    """Base of a paper's sweeps, which its figures share: a subclass says which, and names them by cached properties."""

    def __init__(self, grids: Mapping[str, Grid], folder: Path, jobs: int) -> None:
        self.jobs = jobs
        self.grids = {name: Swept(grid, folder / name) for name, grid in grids.items()}

    def swept(self, name: str) -> xr.Dataset:
        """Facts of all runs of a sweep."""
        return sweep(*self.grids[name], jobs=self.jobs)

    def recorded(self, name: str, point: Point) -> xr.Dataset:
        """One run of a sweep, with all that was recorded."""
        grid, folder = self.grids[name]
        self.swept(name)
        return read_run(Store(folder).file(run_key(grid.scenario(point))))
