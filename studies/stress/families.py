"""What is tried: families of cases, each at one edge of what the engine is made for."""

import math
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from engine import Crowd, Scenario, Scene, rooms
from engine.scenario import step_limit
from studies.stress import kinds
from studies.stress.judge import Case
from studies.stress.random_scenes import RandomScenes, at_share

SCENES = 10_000
SIDE = 15.0  # m, of the room of Lin et al.
SPEEDS = (1.0, 2.0, 5.0, 10.0)  # m/s
CROWDS = (200, 300, 340, 360, 380, 500)  # persons drawn into the room; from about 45 % of its area none can be placed
STIFFNESS = (0.01, 0.1, 1.0, 10.0, 100.0)
SHARES = (0.5, 0.9, 1.1, 2.0)  # of the longest step allowed
OVERLAPS = (0.0, 0.25, 0.49, 0.51, 0.9)  # of the smallest radius; up to 0.5 a crowd may begin with
ALLOWED_OVERLAP = 0.5
THROWN = (5.0, 10.0, 20.0, 40.0, 80.0, 160.0)  # m/s
TARGETS = {  # of somebody at (1 m, 1 m): walls, others
    "a wall": (((2.0, 0.0, 2.0, 2.0),), ()),
    "a wall's end": (((2.0, 0.9, 2.0, -1.0),), ()),
    "a person": ((), ((2.0, 1.1),)),
    "a person at a wall": (((2.3, 0.0, 2.3, 2.0),), ((2.0, 1.0),)),
    "two persons": ((), ((2.0, 0.69), (2.0, 1.31))),
}
EXIT = (6.0, 3.0)  # m, the middle of the small room's exit
Place = tuple[float, float]  # m
STABLE = ("all_out", "blocked", "frozen", "time_limit")


def fast(kind: kinds.Kind) -> list[Case]:
    """Desired speeds up to 10 m/s, 200 persons in the paper's room."""
    return [
        Case(kind, f"v_d = {v:g} m/s", partial(_lin_room, kind, 200, v, 20.0), slow=v in (1.0, 5.0)) for v in SPEEDS
    ]


def dense(kind: kinds.Kind) -> list[Case]:
    """More and more persons drawn into the room, and a room filled with discs that touch, or overlap."""
    drawn = [
        Case(kind, f"{N} persons drawn", partial(_lin_room, kind, N, 1.5, 5.0), _beyond(N), "fit", slow=N != 340)
        for N in CROWDS
    ]
    packed = [
        Case(kind, f"hexagonal packing, overlap {o:g} radii", partial(_hexagonal, kind, o), slow=o > 0.0)
        for o in (0.0, 0.2)
    ]
    return drawn + packed


def stiff(kind: kinds.Kind) -> list[Case]:
    """Bodies from 100 times softer to 100 times harder."""
    return [
        Case(kind, f"stiffness x {f:g}", partial(_changed_room, kind, f, 80.0, (0.25, 0.35)), slow=f in (0.1, 10.0))
        for f in STIFFNESS
    ]


def bodies(kind: kinds.Kind) -> list[Case]:
    """Masses and radii over a factor of ten in one crowd, drawn and given."""
    drawn = [
        Case(kind, "masses 12 to 120 kg", partial(_changed_room, kind, 1.0, (12.0, 120.0), (0.25, 0.35))),
        Case(kind, "radii 0.08 to 0.8 m", partial(_changed_room, kind, 1.0, (60.0, 80.0), (0.08, 0.8))),
        Case(kind, "both", partial(_changed_room, kind, 1.0, (12.0, 120.0), (0.08, 0.8)), slow=True),
    ]
    return [*drawn, Case(kind, "the small heavy, the large light, given", partial(_light_giants, kind))]


def steps(kind: kinds.Kind) -> list[Case]:
    """Steps below the limit, which must run, and above it, which must be refused with the limit's number."""
    room = partial(_lin_room, kind, 60, 1.5, 10.0)
    limit = step_limit(room())[0]
    found = []
    for share in SHARES:
        build = partial(_with_step, room, share)
        found.append(Case(kind, f"dt = {share:g} x limit", build, share > 1.0, f"is beyond the {limit:.2g} s", STABLE))
    return found


def places(kind: kinds.Kind) -> list[Case]:
    """Persons who touch, stand nearly on one place, on a wall, at its corner, or in the exit."""
    r, corner, allowed = 0.3, (4.0, 2.0), 0.51 * 0.3  # m; the upper left corner of the pillar; a centre's distance

    def runs(label: str, *places: Place, pillar: bool = False, speed: float = 0.0) -> Case:
        return Case(kind, label, partial(_given, kind, places, pillar, speed), wanted=("all_out",))

    def refused(label: str, named: str, *places: Place, pillar: bool = False) -> Case:
        return Case(kind, label, partial(_given, kind, places, pillar), True, named)

    def beside(distance: float) -> Place:
        return corner[0] - distance / math.sqrt(2.0), corner[1] + distance / math.sqrt(2.0)

    middle = (3.0, 3.0)
    pairs = {o: (middle, (3.0 + (2.0 - o) * r, 3.0)) for o in OVERLAPS}
    return [
        *(runs(f"two, overlap {o:g} radii", *pair) for o, pair in pairs.items() if o <= ALLOWED_OVERLAP),
        *(refused(f"two, overlap {o:g} radii", "start", *pair) for o, pair in pairs.items() if o > ALLOWED_OVERLAP),
        refused("two on one place", "two persons", middle, middle),
        refused("two 1e-9 m apart", "start", middle, (3.0 + 1e-9, 3.0)),
        refused("two as near as numbers are", "start", middle, (math.nextafter(3.0, 4.0), 3.0)),
        refused("on a wall", "start", (3.0, 0.0)),
        refused("on the room's corner", "start", (0.0, 0.0)),
        refused("on a pillar's corner", "start", corner, pillar=True),
        runs("in the room's corner", (allowed, allowed)),
        runs("three in the room's corner", (r, r), (2.6 * r, r), (r, 2.6 * r)),
        runs("pressed on a pillar's corner", beside(allowed), pillar=True),
        runs("touching a pillar's corner", beside(r), pillar=True),
        runs("at rest in the exit's centre", EXIT),
        runs("walking in the exit's centre", EXIT, speed=1.0),
        runs("touching the exit's jamb", (6.0, 2.5 + r), (5.3, 3.0)),
    ]


def thrown(kind: kinds.Kind) -> list[Case]:
    """Somebody thrown at a wall, at the end of a wall, at another: stopped, or the run ends as unstable."""
    return [
        Case(
            kind,
            f"{speed:g} m/s at {target}",
            partial(_thrown, kind, speed, target),
            breakable=True,
            slow=speed in (10.0, 80.0),
        )
        for speed in THROWN
        for target in TARGETS
    ]


FAMILIES: dict[str, Callable[[kinds.Kind], list[Case]]] = {
    "fast": fast,
    "dense": dense,
    "stiff": stiff,
    "bodies": bodies,
    "steps": steps,
    "places": places,
    "thrown": thrown,
}
RANDOM = "random"


def cases(family: str) -> Sequence[Case]:
    """All cases of a family, in the order of their numbers."""
    if family == RANDOM:
        return RandomScenes(SCENES)
    return [case for kind in kinds.KINDS for case in FAMILIES[family](kind)]


def one_step(kind: kinds.Kind) -> Case:
    """A run that is over at once, for which the kernel of this kind is compiled."""
    return Case(kind, "one step", partial(_lin_room, kind, 1, 1.0, 1e-3))


# --- Scenarios ------------------------------------------------------------------------------------------


def _lin_room(kind: kinds.Kind, N: int, v_d: float, time: float, dt: float = 1e-3) -> Scenario:
    """The paper's room with another model; a model that needs a shorter step gets nine tenths of its limit."""
    crowd = Crowd.uniform(N, (0.0, SIDE, 0.0, SIDE), v_d=v_d)
    scene, model = rooms.square_room(SIDE, 1.0), kinds.MODELS[kind[0]]
    return _no_longer_than(dt, at_share(scene, crowd, model, kind[1], 0.9, time, seed=1, every=20))


def _no_longer_than(dt: float, scenario: Scenario) -> Scenario:
    if scenario.numerics.dt <= dt:
        return scenario
    steps = round(scenario.options.record_every / scenario.numerics.dt)
    return scenario.with_options(dt=dt, record_every=steps * dt)


def _with_step(room: Callable[[], Scenario], share: float) -> Scenario:
    scenario = room()
    dt = share * step_limit(scenario)[0]
    return scenario.with_options(dt=dt, record_every=5 * dt)


def _beyond(N: int) -> bool | None:
    """Whether so many cannot be drawn into the room (at 40 % and below they can, above 50 % they cannot)."""
    share = N * math.pi * 0.3**2 / SIDE**2
    return False if share < 0.4 else (True if share > 0.5 else None)


def _hexagonal(kind: kinds.Kind, overlap: float) -> Scenario:
    """A 6 m room full of equal discs, every one touching six others; `overlap` in radii."""
    radius, side = 0.3, 6.0
    apart = radius * (2.0 - overlap)
    rows = int((side - 2 * radius) / (apart * math.sqrt(0.75))) + 1
    places = [
        (radius + apart * (column + 0.5 * (row % 2)), radius + apart * math.sqrt(0.75) * row)
        for row in range(rows)
        for column in range(int((side - 2 * radius - 0.5 * apart * (row % 2)) / apart) + 1)
    ]
    x, y = zip(*places, strict=True)
    crowd = Crowd.given(x, y, 0.0, 0.0, 0.0, radius, 70.0, 1.0)
    scene, model = rooms.square_room(side, 1.0), kinds.MODELS[kind[0]]
    return _no_longer_than(1e-3, at_share(scene, crowd, model, kind[1], 0.9, 5.0, every=5))


def _changed_room(
    kind: kinds.Kind, factor: float, mass: float | tuple[float, float], radius: tuple[float, float]
) -> Scenario:
    """Forty persons in an 8 m room at nine tenths of the longest step, bodies `factor` times as stiff."""
    crowd = Crowd.uniform(40 if radius[1] < 0.5 else 25, (0.0, 8.0, 0.0, 8.0), radius, mass, v_d=1.5, speed=0.5)
    model = kinds.scaled(kinds.MODELS[kind[0]], kinds.STIFFNESSES, factor)
    return at_share(rooms.square_room(8.0, 2 * radius[1] + 0.4), crowd, model, kind[1], 0.9, 10.0, seed=2, every=4)


def _light_giants(kind: kinds.Kind) -> Scenario:
    """Masses that fall from 120 to 12 kg while radii grow from 0.08 to 0.8 m, side by side in a row."""
    radius, mass = np.geomspace(0.08, 0.8, 6), np.geomspace(120.0, 12.0, 6)
    x = np.cumsum(np.concatenate([[0.5], radius[1:] + radius[:-1]]))
    crowd = Crowd.given(x, np.full(6, 4.0), 0.0, 0.0, 0.0, radius, mass, 1.5)
    model = kinds.MODELS[kind[0]]
    return at_share(rooms.square_room(8.0, 2.0), crowd, model, kind[1], 0.9, 10.0, every=4)


def _given(kind: kinds.Kind, places: tuple[Place, ...], pillar: bool = False, speed: float = 0.0) -> Scenario:
    """Equal persons at these places in a 6 m room, its exit in the middle of the right side, perhaps with a pillar."""
    x, y = zip(*places, strict=True)
    crowd = Crowd.given(x, y, speed, 0.0, 0.0, 0.3, 70.0, 1.0)
    scene = rooms.square_room(6.0, 1.0)
    if pillar:
        sides = ((4.0, 1.0, 5.0, 1.0), (5.0, 1.0, 5.0, 2.0), (5.0, 2.0, 4.0, 2.0), (4.0, 2.0, 4.0, 1.0))
        scene = Scene(scene.walls + sides, scene.exits)
    model = kinds.MODELS[kind[0]]
    return _no_longer_than(1e-3, at_share(scene, crowd, model, kind[1], 0.9, 20.0, every=5))


def _thrown(kind: kinds.Kind, speed: float, target: str) -> Scenario:
    """Half a second in which nobody is driven and somebody is thrown."""
    walls, others = TARGETS[target]
    x, y = zip((1.0, 1.0), *others, strict=True)
    crowd = Crowd.given(x, y, [speed, *[0.0] * len(others)], 0.0, 0.0, 0.3, 70.0, 0.0)
    model = kinds.passive(kinds.MODELS[kind[0]])
    return _no_longer_than(1e-3, at_share(Scene(walls), crowd, model, kind[1], 0.9, 0.5))
