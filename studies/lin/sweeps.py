"""The runs of all figures: one grid over v_d and N for Figures 7 to 10, and those of Figures 4, 5 and 6."""

from functools import cached_property
from pathlib import Path

import xarray as xr

from engine import Scenario, rooms
from engine.errors import require
from studies import swept
from studies.published import lin2016 as paper
from sweep import Grid

FOLDER = Path("results/lin")
V_D, SEEDS = [0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0], 10  # the paper has one to a few runs of a cell
QUICK_V_D, QUICK_SEEDS = [0.6, 1.0, 1.4, 1.8], 2
STRENGTH_SEEDS = 20
ROTATION_SEEDS = 40  # for a half-width of 0.15 of a share
WALLS = ("as persons", "held")  # how strongly walls push when A is varied
ROTATION = ("sphere", "none")  # `inertia`: rotation on and off


def strength_room(A: float = 300.0, walls: str = WALLS[0], seed: int = 0) -> Scenario:
    """Lin's room of Fig. 4 with a social force of strength A, N; walls push with A or, held, with 300 N.

    Raises
    ------
    BadInput
        If `walls` is neither "as persons" nor "held", or A out of its range.
    """
    require(walls in WALLS, "walls", repr(walls), "is not known", f"choose one of {', '.join(WALLS)}")
    return rooms.lin_room(paper.FIG4_V_D, paper.FIG4_N, seed, A=A, wall_A=None if walls == "as persons" else 300.0)


def grids(quick: bool) -> dict[str, Grid]:
    """The sweeps, thinned or whole."""

    def seeds(full: int) -> range:
        return range(QUICK_SEEDS if quick else full)

    v_d = [paper.FIG5_V_D_SAME, paper.FIG5_V_D_CLOGS_MORE_WITHOUT_ROTATION]
    sampled = {"record_every": paper.FIG6_TIMES[1], "contacts": True}
    return {
        "speeds": Grid(rooms.lin_room, v_d=QUICK_V_D if quick else V_D, N=[100, 200, 300], seed=seeds(SEEDS)),
        "strengths": Grid(strength_room, A=list(paper.FIG4_A), walls=WALLS, seed=seeds(STRENGTH_SEEDS)),
        "rotation": Grid(rooms.lin_room, v_d=v_d, inertia=ROTATION, seed=seeds(ROTATION_SEEDS), N=paper.FIG5_N),
        "snapshots": Grid(rooms.lin_room, seed=[0], N=paper.FIG6_N, v_d=1.0, **sampled),
    }


class Sweeps(swept.Sweeps):
    """Facts of the sweeps, run when they are first asked for, and kept on disk."""

    def __init__(self, quick: bool = False, jobs: int = 2, folder: Path = FOLDER) -> None:
        super().__init__(grids(quick), folder, jobs)
        self.quick, self.folder = quick, folder

    @cached_property
    def speeds(self) -> xr.Dataset:
        """Exits over v_d, N and seed: Figures 7 to 10."""
        return self.swept("speeds")

    @cached_property
    def strengths(self) -> xr.Dataset:
        """Exits over A, walls and seed: Figure 4."""
        return self.swept("strengths")

    @cached_property
    def rotation(self) -> xr.Dataset:
        """Exits over v_d, inertia and seed: Figure 5."""
        return self.swept("rotation")

    @cached_property
    def snapshots(self) -> xr.Dataset:
        """The recorded run of Figure 6."""
        (point,) = self.grids["snapshots"].grid.points()
        return self.recorded("snapshots", point)
