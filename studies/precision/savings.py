"""What skipping saves: CPU time with and without, in one jam for all."""

from collections.abc import Iterator
from dataclasses import replace
from statistics import median
from typing import NamedTuple

import numpy as np

from engine import Crowd, Options, Scenario, Scene, laws, models
from engine.crowd import Given
from engine.rooms import ROOMS
from studies.precision.clock import at, compile_kernel, timed

ROOM, V_D, N, JAMMED, HALF_OUT = "lin_room", 1.2, 200, 10.0, 200.0  # room, m/s, persons, s, s
FAR = 40  # wall pieces out of reach
APART = 1.0  # m, persons on a lattice in which nobody touches
FROZEN = {"v_d": 6.0, "N": 100, "L": 0.6, "seed": 0}  # of parisi_room: a run that ends at rest
STILL = models.lin_dem(inertia="none")
BLIND = models.lin_dem()._replace(anisotropy=laws.Absent())
SMOOTH = models.lin_dem()._replace(friction=laws.Absent(), wall_friction=laws.Absent())
BARE = STILL._replace(anisotropy=laws.Absent(), friction=laws.Absent(), wall_friction=laws.Absent())
TOUCHLESS = models.lin_dem()._replace(
    **dict.fromkeys(("normal", "friction", "wall_normal", "wall_friction", "rotation"), laws.Absent())
)


class Saving(NamedTuple):
    """CPU time with something, over that without it or with it skipped."""

    what: str
    ratio: float
    remark: str = ""


class Pair(NamedTuple):
    """Two scenarios that take turns."""

    what: str
    with_it: Scenario
    without: Scenario
    remark: str = ""
    whole: bool = False  # whole runs are compared, not their steps


def measure(stretch: float, repeats: int, compiling: bool) -> list[Saving]:
    """All ratios: medians of `repeats` turns over `stretch` simulated s.

    Parameters
    ----------
    compiling : also what needs kernels of its own (half a minute each the first time)
    """
    jam = at(ROOMS[ROOM](v_d=V_D, N=N), JAMMED).with_options(blocked_after=stretch, time_limit=stretch)
    return [_saving(pair, repeats) for pair in _pairs(jam, compiling)]


def _saving(pair: Pair, repeats: int) -> Saving:
    for scenario in pair[1:3]:
        compile_kernel(scenario)
    cost = whole if pair.whole else per_step
    turns = [[cost(scenario) for scenario in pair[1:3]] for _ in range(repeats)]
    return Saving(pair.what, median(a for a, _ in turns) / median(b for _, b in turns), pair.remark)


def per_step(scenario: Scenario) -> float:
    """CPU seconds of a step."""
    spent, run = timed(scenario)
    return spent / run.steps


def whole(scenario: Scenario) -> float:
    """CPU seconds of a run."""
    return timed(scenario)[0]


def _pairs(jam: Scenario, compiling: bool) -> Iterator[Pair]:
    if compiling:
        yield Pair("rotation of bodies", jam, replace(jam, model=STILL), 'inertia "none"')
        yield Pair("anisotropy", jam, replace(jam, model=BLIND), "law absent")
        yield Pair("friction", jam, replace(jam, model=SMOOTH), "law absent; the crowd moves more freely")
        yield Pair("rotation, anisotropy and friction", jam, replace(jam, model=BARE), "laws absent")
        apart = replace(jam, crowd=on_a_lattice()).with_options(blocked_after=Options.blocked_after)
        yield Pair(
            "contact laws while nobody touches",
            apart,
            replace(apart, model=TOUCHLESS),
            "laws absent; 1: they cost nothing",
        )
    walls = replace(jam, scene=with_far_walls(jam.scene))
    yield Pair(f"{FAR} wall pieces out of reach", walls, jam, "1: they cost nothing")
    later = replace(at(ROOMS[ROOM](v_d=V_D, N=N), HALF_OUT, N // 2), options=jam.options)
    yield Pair("the departed", jam, later, f"steps of {jam.crowd.N} persons over steps of {later.crowd.N}")
    for skin in (0.01, 0.5):
        fixed = jam.with_options(skin=skin)
        yield Pair(f"lists with a skin of {skin:g} m", fixed, jam, "over the adapted skin")
    for tolerance in (1e-6, 1e-3, 1.0):
        other = jam.with_options(force_tolerance=tolerance)
        usual = f"over {jam.numerics.force_tolerance:g} N"
        yield Pair(f"social force down to {tolerance:g} N", other, jam, f"{usual}; reach {reach(other):.2f} m")
    for every, contacts in ((0.1, False), (0.1, True), (0.02, True)):
        words = f"recording every {every:g} s{' with contacts' if contacts else ''}"
        yield Pair(words, jam.with_options(record_every=every, contacts=contacts), jam, "over no recording")
    stuck = ROOMS["parisi_room"](**FROZEN)
    waiting = stuck.with_options(stop_at_rest=False)
    yield Pair(
        "the wait of a jam that is at rest for good", waiting, stuck, "a whole run, over its early end", whole=True
    )


def on_a_lattice() -> Given:
    """Persons at rest out of each other's touch, who want to go nowhere."""
    rows = np.arange(APART, 15.0 - APART / 2, APART)
    x, y = (axis.ravel() for axis in np.meshgrid(rows, rows))
    return Crowd.given(x, y, 0.0, 0.0, 0.0, radius=0.3, mass=70.0, v_d=0.0)


def reach(scenario: Scenario) -> float:
    """Gap at which the social force ends, m."""
    return laws.cutoff(scenario.model.social, scenario.numerics.force_tolerance)


def with_far_walls(scene: Scene) -> Scene:
    """The scene and short walls beyond anybody's reach."""
    far = tuple((60.0, 2.0 * k, 61.0, 2.0 * k) for k in range(FAR))
    return Scene((*scene.walls, *far), scene.exits)
