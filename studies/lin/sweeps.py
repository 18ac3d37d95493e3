"""The runs of all figures: one grid over v_d and N for Figures 7 to 10, and those of Figures 4, 5 and 6."""

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from engine import Scenario, rooms
from engine.errors import require
from studies.published import lin2016 as paper
from sweep import Grid, Store, read_run, sweep
from sweep.schema import run_key

FOLDER = Path("results/lin")
V_D, SEEDS = [0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0], 10  # the paper has one to a few runs of a cell
QUICK_V_D, QUICK_SEEDS = [0.6, 1.0, 1.4, 1.8], 2
STRENGTH_SEEDS = 20
ROTATION_SEEDS = 40  # for a half-width of 0.15 of a share
WALLS = ("as persons", "held")  # how strongly walls push when A is varied
TURNING = ("sphere", "none")  # `inertia`: rotation on and off


def strength_room(A: float = 300.0, walls: str = WALLS[0], seed: int = 0) -> Scenario:
    """Lin's room of Fig. 4 with a social force of strength A, N; walls push with A or, held, with 300 N.

    Raises
    ------
    BadInput
        If `walls` is neither "as persons" nor "held", or A out of its range.
    """
    require(walls in WALLS, "walls", repr(walls), "is not known", f"choose one of {', '.join(WALLS)}")
    scenario = rooms.lin_room(paper.FIG4_V_D, paper.FIG4_N, seed, A=A)
    if walls == "as persons":
        return scenario
    held = rooms.lin_room().model.wall_social
    return replace(scenario, model=scenario.model._replace(wall_social=held))


class Swept(NamedTuple):
    """A grid and the folder of its runs."""

    grid: Grid
    folder: Path


def grids(quick: bool, folder: Path = FOLDER) -> dict[str, Swept]:
    """The sweeps, thinned or whole."""

    def seeds(full: int) -> range:
        return range(QUICK_SEEDS if quick else full)

    speeds = Grid(rooms.lin_room, v_d=QUICK_V_D if quick else V_D, N=[100, 200, 300], seed=seeds(SEEDS))
    strengths = Grid(strength_room, A=list(paper.FIG4_A), walls=WALLS, seed=seeds(STRENGTH_SEEDS))
    v_d = [paper.FIG5_V_D_SAME, paper.FIG5_V_D_CLOGS_MORE_WITHOUT_ROTATION]
    rotation = Grid(rooms.lin_room, v_d=v_d, inertia=TURNING, seed=seeds(ROTATION_SEEDS), N=paper.FIG5_N)
    sampled = {"every": paper.FIG6_TIMES[1], "contacts": True}
    snapshots = Grid(rooms.lin_room, seed=[0], N=paper.FIG6_N, v_d=1.0, **sampled)
    found = {"speeds": speeds, "strengths": strengths, "rotation": rotation, "snapshots": snapshots}
    return {name: Swept(grid, folder / name) for name, grid in found.items()}


class Sweeps:
    """Facts of the sweeps, run when they are first asked for, and kept on disk."""

    def __init__(self, quick: bool = False, jobs: int = 2, folder: Path = FOLDER) -> None:
        self.quick, self.jobs, self.folder = quick, jobs, folder
        self.grids = grids(quick, folder)

    @cached_property
    def speeds(self) -> xr.Dataset:
        """Exits over v_d, N and seed: Figures 7 to 10."""
        return self._swept("speeds")

    @cached_property
    def strengths(self) -> xr.Dataset:
        """Exits over A, walls and seed: Figure 4."""
        return self._swept("strengths")

    @cached_property
    def rotation(self) -> xr.Dataset:
        """Exits over v_d, inertia and seed: Figure 5."""
        return self._swept("rotation")

    @cached_property
    def snapshots(self) -> xr.Dataset:
        """The recorded run of Figure 6."""
        grid, folder = self.grids["snapshots"]
        self._swept("snapshots")
        (point,) = grid.points()
        return read_run(Store(folder).file(run_key(grid.scenario(point))))

    def _swept(self, name: str) -> xr.Dataset:
        return sweep(*self.grids[name], jobs=self.jobs)
