"""Statistics of many whole runs: cells of the parameters, trials of the numerics, the same seeds in all of them."""

from pathlib import Path
from statistics import median
from typing import NamedTuple

import xarray as xr

from engine import BadInput
from studies.measures import outcome_is
from studies.precision.bias import Bias, compare, counts
from studies.precision.settings import Setting, keywords_of, setting_of
from sweep import Grid, sweep
from sweep.grid import Scalar
from sweep.schema import run_key
from sweep.storage.store import Store

DEFAULT = "default"


class Trial(NamedTuple):
    """Numerics that a cell is run with, and how many seeds."""

    name: str
    keywords: tuple[tuple[str, Scalar], ...]  # of the room
    seeds: int


class Cell(NamedTuple):
    """A crowd, the reference that its statistics are held against, and the trials."""

    room: str
    v_d: float  # m/s
    N: int
    reference: Trial
    trials: tuple[Trial, ...]
    ranks: tuple[int, ...] = ()

    def __str__(self) -> str:
        """Room, desired speed and number of persons."""
        return f"{self.room}, v_d = {self.v_d:g} m/s, N = {self.N}"

    def grid(self, trial: Trial) -> Grid:
        """The runs of a trial."""
        return Grid(self.room, v_d=self.v_d, N=self.N, seed=range(trial.seeds), **dict(trial.keywords))


class Judged(NamedTuple):
    """What a trial did to the statistics of a cell."""

    cell: Cell
    trial: Trial
    setting: Setting | None  # none: refused
    biases: list[Bias]
    outcomes: str  # or why it was refused
    duration: float  # s, median of a run beside its neighbours
    missing: int  # runs that failed


def explicit(integrator: str, dt: float, force_tolerance: float, seeds: int) -> Trial:
    """A trial with all numerics given."""
    setting = Setting(integrator, dt, force_tolerance)
    keywords = tuple(keywords_of(setting).items())
    return Trial(f"{integrator}, {dt:g} s, {force_tolerance:g} N", keywords, seeds)


def judge(cell: Cell, store: Path, jobs: int) -> list[Judged]:
    """Run what the store lacks of a cell and compare every trial with the reference, which comes first."""
    reference = sweep(cell.grid(cell.reference), store, jobs).load()
    first = _judged(cell, cell.reference, reference, [], store)
    return [first, *(_tried(cell, trial, reference, store, jobs) for trial in cell.trials)]


def _tried(cell: Cell, trial: Trial, reference: xr.Dataset, store: Path, jobs: int) -> Judged:
    try:
        ds = sweep(cell.grid(trial), store, jobs).load()
    except BadInput as error:
        return Judged(cell, trial, None, [], f"refused: {error}", float("nan"), 0)
    return _judged(cell, trial, ds, compare(ds, reference, cell.ranks), store)


def _judged(cell: Cell, trial: Trial, ds: xr.Dataset, biases: list[Bias], store: Path) -> Judged:
    grid = cell.grid(trial)
    scenarios = [grid.scenario(point) for point in grid.points()]
    finished = Store(store).finished()
    durations = [finished[key].duration for key in map(run_key, scenarios) if key in finished]
    missing = int(outcome_is(ds, "missing").sum())
    setting = setting_of(scenarios[0])
    return Judged(cell, trial, setting, biases, counts(ds), median(durations or [float("nan")]), missing)
