"""Whether friction depends on the time step, in the cells whose statistics are compared."""

from typing import NamedTuple

from engine import Scenario
from engine.rooms import ROOMS
from studies.precision.cells import Cell, Trial
from sweep.numerics import Comparison, compare_steps

DURATION = 60.0  # s


class Friction(NamedTuple):
    """Friction at the step of a trial against that at a quarter of it."""

    cell: Cell
    trial: Trial
    dt: float  # s
    comparisons: list[Comparison]


def measure(cells: tuple[Cell, ...], seeds: int, jobs: int) -> list[Friction]:
    """Compare the steps of the default and of the reference of every cell."""
    found = []
    for cell in cells:
        for trial in (*cell.trials[:1], cell.reference):
            scenarios = [_scenario(cell, trial, seed) for seed in range(seeds)]
            found.append(Friction(cell, trial, scenarios[0].numerics.dt, compare_steps(scenarios, jobs)))
    return found


def _scenario(cell: Cell, trial: Trial, seed: int) -> Scenario:
    return ROOMS[cell.room](v_d=cell.v_d, N=cell.N, seed=seed, time_limit=DURATION, **dict(trial.keywords))
