"""What the study runs: the whole, and a thinned form that shows that all works."""

from typing import NamedTuple

from engine.rooms import ROOMS
from studies.precision.cells import Cell, Trial, explicit
from studies.precision.positions import TIGHT, Case
from studies.precision.settings import Setting
from sweep.numerics import FINER

INTEGRATORS = ("velocity_verlet", "predictor", "theta")
STEPS = (5e-4, 1e-3, 2e-3, 4e-3, 5e-3, 8e-3)  # s


class Plan(NamedTuple):
    """Sizes of all parts."""

    cases: tuple[Case, ...]
    integrators: tuple[str, ...]
    steps: tuple[float, ...]  # s
    tolerances: tuple[float, ...]  # N
    seeds: int  # of errors of positions
    stretch: float  # s, simulated for a time
    gas_time: float  # s
    cells: tuple[Cell, ...]
    friction_seeds: int  # of the friction in each cell, at each step
    speed_ups: tuple[tuple[str, float, int, int], ...]  # room, v_d, N, seeds
    repeats: int  # of times of savings
    compiling: bool  # also savings that need kernels of their own


def case(room: str, v_d: float, time: float) -> Case:
    """A case with a reference of second order, and two that must agree with it: twice the step, another integrator."""
    others = (Setting("predictor", 5e-5, TIGHT), Setting("theta", 2.5e-5, TIGHT))
    return Case(room, v_d, time, Setting("predictor", 2.5e-5, TIGHT), others)


def certified(room: str, v_d: float, N: int, seeds: int) -> Cell:
    """A cell whose default is held against a quarter of its step, with a force tolerance of 1 mN."""
    dt = ROOMS[room]().numerics.dt / FINER
    return Cell(room, v_d, N, explicit("theta", dt, 1e-3, seeds), (Trial("default", (), seeds),))


FULL = Plan(
    cases=(
        case("parisi_room", 1.0, 4.0),
        case("parisi_room", 4.0, 1.0),
        case("lin_room", 1.0, 1.0),
        case("lin_room", 4.0, 0.5),
    ),
    integrators=INTEGRATORS,
    steps=STEPS,
    tolerances=(1e-3, 1e-2, 0.3),
    seeds=3,
    stretch=3.0,
    gas_time=20.0,
    cells=(
        certified("lin_room", 1.0, 100, seeds=400),
        certified("lin_room", 1.6, 100, seeds=400),
        certified("lin_room", 1.0, 200, seeds=150),
        certified("lin_room", 1.8, 200, seeds=150),
        certified("parisi_room", 1.5, 200, seeds=300),
        certified("parisi_room", 4.0, 200, seeds=300),
        certified("parisi_room", 8.0, 200, seeds=300),
    ),
    friction_seeds=24,
    speed_ups=(("parisi_room", 4.0, 200, 3), ("lin_room", 1.6, 100, 5)),
    repeats=5,
    compiling=True,
)

COARSE = Setting("velocity_verlet", 2.5e-5, TIGHT), (Setting("velocity_verlet", 5e-5, TIGHT),)
QUICK = Plan(
    cases=(
        Case("parisi_room", 4.0, 1.0, *COARSE),
        Case("lin_room", 1.0, 1.0, *COARSE),
    ),
    integrators=("velocity_verlet", "theta"),
    steps=(1e-3, 5e-3),
    tolerances=(1e-3, 0.3),
    seeds=2,
    stretch=1.0,
    gas_time=2.0,
    cells=(
        Cell(
            "parisi_room",
            4.0,
            60,
            explicit("velocity_verlet", 5e-4, 1e-3, 4),
            (Trial("default", (), 4), explicit("theta", 5e-3, 3.0, 4)),
            (54,),
        ),
        Cell(
            "lin_room",
            1.0,
            40,
            explicit("theta", 1e-3, 1e-3, 4),
            (
                Trial("default", (), 4),
                Trial("paper", (("numerics", "paper"),), 4),
                explicit("theta", 1e-2, 0.3, 4),
            ),
        ),
    ),
    friction_seeds=3,
    speed_ups=(("parisi_room", 4.0, 60, 1), ("lin_room", 1.0, 40, 1)),
    repeats=2,
    compiling=False,
)


def times_more(plan: Plan, times: int) -> Plan:
    """The plan with so many times the seeds in every cell; runs that are kept are not run again."""

    def more(trial: Trial) -> Trial:
        return trial._replace(seeds=times * trial.seeds)

    cells = [c._replace(reference=more(c.reference), trials=tuple(map(more, c.trials))) for c in plan.cells]
    return plan._replace(cells=tuple(cells))
