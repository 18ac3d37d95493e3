"""What the study runs: the whole, and a thinned form that shows that all works."""

from typing import NamedTuple

from studies.precision.cells import Cell, Trial, around_default, explicit
from studies.precision.positions import TIGHT, Case
from studies.precision.settings import Setting

INTEGRATORS = ("velocity_verlet", "predictor", "semi_implicit")
STEPS = (1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2)  # s


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
    speed_ups: tuple[tuple[str, float, int, int], ...]  # room, v_d, N, seeds
    repeats: int  # of times of savings
    compiling: bool  # also savings that need kernels of their own


def case(room: str, v_d: float, time: float) -> Case:
    """A case with a reference of second order, and two that must agree with it: twice the step, another integrator."""
    others = (Setting("predictor", 5e-5, TIGHT), Setting("semi_implicit", 2.5e-5, TIGHT))
    return Case(room, v_d, time, Setting("predictor", 2.5e-5, TIGHT), others)


def parisi(v_d: float, default: int, cheap: int, dear: int, paper: int) -> Cell:
    """A cell of Parisi & Dorso's room with so many seeds; those of the default are the reference's too."""
    steps = {1e-3: dear, 2e-3: default, 5e-3: cheap, 1e-2: cheap}
    trials = around_default("parisi_room", steps, {1e-3: cheap, 1.0: cheap, 3.0: cheap}, default, paper)
    exact = explicit("predictor", 1e-3, 1e-3, default)
    return Cell("parisi_room", v_d, 200, exact, trials, (180,))


def lin(v_d: float, default: int, others: int) -> Cell:
    """A cell of Lin, Ma & Lo's room, with as many seeds of the default as of the reference."""
    steps, tolerances = dict.fromkeys((1e-3, 2e-3, 5e-3, 1e-2), others), dict.fromkeys((1e-3, 1.0, 3.0), others)
    trials = around_default("lin_room", steps, tolerances, default, others)
    return Cell("lin_room", v_d, 100, explicit("semi_implicit", 5e-4, 1e-3, default), trials)


FULL = Plan(
    cases=(
        case("parisi_room", 1.0, 4.0),
        case("parisi_room", 4.0, 1.0),
        case("lin_room", 1.0, 1.0),
        case("lin_room", 4.0, 0.5),
    ),
    integrators=INTEGRATORS,
    steps=STEPS,
    tolerances=(1e-3, 1e-2, 0.3, 3.0),
    seeds=3,
    stretch=10.0,
    gas_time=20.0,
    cells=(
        parisi(1.5, default=200, cheap=200, dear=60, paper=20),
        parisi(4.0, default=500, cheap=200, dear=60, paper=15),
        lin(1.0, default=200, others=60),
        lin(1.6, default=500, others=60),
    ),
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
    integrators=("velocity_verlet", "semi_implicit"),
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
            (Trial("default", (), 4), explicit("semi_implicit", 5e-3, 3.0, 4)),
            (54,),
        ),
        Cell(
            "lin_room",
            1.0,
            40,
            explicit("semi_implicit", 1e-3, 1e-3, 4),
            (
                Trial("default", (), 4),
                Trial("paper", (("numerics", "paper"),), 4),
                explicit("semi_implicit", 1e-2, 0.3, 4),
            ),
        ),
    ),
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
