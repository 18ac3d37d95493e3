"""Small random scenes: rooms with corners, partitions, pillars and exits, and the crowds in them.

A scene follows from its number alone, by a random stream of its own below one root seed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from engine import Crowd, Exit, Model, Options, Scenario, Scene
from engine.crowd import Given, Uniform
from engine.scenario import step_limit
from studies.stress import kinds
from studies.stress.judge import Case

ROOT_SEED = 20161
DRIVEN, PASSIVE, LOSSLESS = 0.6, 0.25, 0.15  # shares of the scenes
MOST_STEPS, MOST_PASSIVE_STEPS = 4000, 500
FORCE_TOLERANCE = 1e-3  # N
Points = list[tuple[float, float]]
Segment = tuple[float, float, float, float]


@dataclass(frozen=True)
class RandomScenes(Sequence[Case]):
    """So many cases; models and integrators take turns."""

    size: int

    def __len__(self) -> int:
        """Number of scenes."""
        return self.size

    def __getitem__(self, number: int) -> Case:  # type: ignore[override]  # no slices
        """The case of this number."""
        if not 0 <= number < self.size:
            raise IndexError(number)
        kind = kinds.KINDS[number % len(kinds.KINDS)]
        return Case(kind, f"scene {number}", partial(random_scenario, number, kind), refused=None)


def random_scenario(number: int, kind: kinds.Kind) -> Scenario:
    """The scenario of this number."""
    rng = np.random.default_rng(np.random.SeedSequence(ROOT_SEED, spawn_key=(number,)))
    largest = rng.uniform(0.15, 0.45)
    width = 2.0 * largest * rng.uniform(1.02, 2.5) if rng.random() < 0.98 else 1.9 * largest
    model = random_model(rng, kinds.MODELS[kind[0]])
    closed = kinds.is_passive(model)
    size = rng.uniform(2.5, 7.0, 2)
    scene = Scene() if closed and rng.random() < 0.3 else random_scene(rng, size, 0 if closed else width, closed)
    crowd = random_crowd(rng, size, largest)
    share, time = rng.uniform(0.1, 0.95), rng.uniform(0.3, 4.0)
    blocked_after = rng.choice([0.2, 120.0])
    seed = int(rng.integers(1000))
    every = 1 if closed else int(rng.integers(2, 12))
    most = MOST_PASSIVE_STEPS if closed else MOST_STEPS
    return at_share(scene, crowd, model, kind[1], share, time, blocked_after, seed, every, most)


def at_share(
    scene: Scene,
    crowd: Uniform | Given,
    model: Model,
    integrator: str,
    share: float,
    time: float,
    blocked_after: float = 120.0,
    seed: int = 0,
    every: int = 1,
    most_steps: int | None = None,
) -> Scenario:
    """A scenario with this share of the longest step that is allowed.

    Parameters
    ----------
    time, blocked_after : when it ends, s
    every : steps from one sample to the next; at 1, contacts are sampled too
    most_steps : after which it ends in any case
    """
    numerics = Options(dt=1e-8, integrator=integrator, force_tolerance=FORCE_TOLERANCE, time_limit=1.0)
    cautious = Scenario(scene, crowd, model, numerics, seed)
    dt = share * min(step_limit(cautious)[0], 1.0)
    time = min(time, dt * most_steps) if most_steps else time
    until = {"blocked_after": blocked_after, "time_limit": max(time, 2 * dt)}
    return cautious.with_options(dt=dt, **until, record_every=every * dt, contacts=every == 1)


def random_model(rng: np.random.Generator, model: Model) -> Model:
    """The model with stiffness, damping and friction of other sizes; driven, passive or lossless."""
    model = kinds.scaled(model, kinds.STIFFNESSES, 10.0 ** rng.uniform(-1.0, 1.0))
    model = kinds.scaled(model, kinds.DAMPINGS, 10.0 ** rng.uniform(-1.0, 3.0))
    model = kinds.scaled(model, ("A",), rng.uniform(0.0, 3.0))
    model = kinds.scaled(model, ("mu",), rng.uniform(0.0, 2.0))
    fate = rng.random()
    if fate < DRIVEN:
        return kinds.scaled(model, ("tau",), 10.0 ** rng.uniform(-0.5, 0.5))
    return kinds.passive(model) if fate < DRIVEN + PASSIVE else kinds.lossless(model)


def random_crowd(rng: np.random.Generator, size: np.ndarray, largest: float) -> Uniform | Given:
    """One to eight persons placed at random, or a chain of persons who touch."""
    radius, mass = (largest * rng.uniform(0.3, 1.0), largest), np.sort(rng.uniform(20.0, 120.0, 2))
    N, v_d = int(rng.integers(1, 9)), np.sort(rng.uniform(0.0, 3.0, 2))
    if rng.random() < 0.75:
        area = (0.0, float(size[0]), 0.0, float(size[1]))
        speed = (0.0, rng.uniform(0.0, 2.5))
        return Crowd.uniform(N, area, radius, (mass[0], mass[1]), (v_d[0], v_d[1]), speed)
    r, angle = rng.uniform(radius[0], radius[1], N), rng.uniform(0.0, 2.0 * math.pi)
    apart = np.concatenate([[0.0], r[1:] + r[:-1] - rng.uniform(-0.3, 0.5, N - 1) * r.min()])
    along = np.cumsum(apart)
    x = rng.uniform(0.3, 0.7) * size[0] + (along - along[-1] / 2) * math.cos(angle)
    y = rng.uniform(0.3, 0.7) * size[1] + (along - along[-1] / 2) * math.sin(angle)
    vx, vy = rng.uniform(-2.0, 2.0, (2, N))
    return Crowd.given(
        x, y, vx, vy, rng.uniform(-5.0, 5.0, N), r, rng.uniform(mass[0], mass[1], N), rng.uniform(v_d[0], v_d[1], N)
    )


def random_scene(rng: np.random.Generator, size: np.ndarray, exit_width: float, square: bool) -> Scene:
    """A room of this size with up to three exits (none if their width is 0) and up to three things inside.

    Parameters
    ----------
    square : only right angles, where walls store the energy that pressing on them takes. In an obtuse bend a
        person begins to feel the farther wall at once, at its full force.
    """
    corners = _outline(rng, float(size[0]), float(size[1]), square)
    doors = set(rng.integers(0, len(corners), rng.integers(1, 4)).tolist()) if exit_width else set()
    walls: list[Segment] = []
    exits: list[Exit] = []
    for k, (start, end) in enumerate(zip(corners, [*corners[1:], corners[0]], strict=True)):
        length = math.dist(start, end)
        if k not in doors or length < exit_width + 0.2:
            walls.append((*start, *end))
            continue
        low = rng.uniform(0.0, length - exit_width) if rng.random() < 0.9 else 0.0
        ux, uy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        a, b = ((start[0] + s * ux, start[1] + s * uy) for s in (low, low + exit_width))
        walls += [(*p, *q) for p, q in ((start, a), (b, end)) if math.dist(p, q) > 1e-6]
        exits.append(Exit(a, b, (uy, -ux), float(rng.choice([0.0, 0.7]))))
    for _ in range(rng.integers(0, 4)):
        walls += _thing_inside(rng, float(size[0]), float(size[1]), square)
    return Scene(tuple(walls), tuple(exits))


def _outline(rng: np.random.Generator, width: float, height: float, square: bool) -> Points:
    """Corners, counter-clockwise: a rectangle, an L, a rectangle with a corner cut off, or a leaning one."""
    shape = rng.integers(2 if square else 4)
    x, y = width * rng.uniform(0.4, 0.8), height * rng.uniform(0.4, 0.8)
    return [
        [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)],
        [(0.0, 0.0), (width, 0.0), (width, y), (x, y), (x, height), (0.0, height)],
        [(0.0, 0.0), (width, 0.0), (width, y), (x, height), (0.0, height)],
        [(0.0, 0.0), (width, 0.0), (width * 0.9, height), (width * 0.2, height)],
    ][shape]


def _thing_inside(rng: np.random.Generator, width: float, height: float, square: bool) -> list[Segment]:
    """A partition that stands on the lower wall, a free wall, two that cross, or a pillar."""
    x, y = width * rng.uniform(0.2, 0.8), height * rng.uniform(0.2, 0.8)
    reach = rng.uniform(0.2, 1.0)
    angle = 0.0 if square else rng.uniform(0.0, math.pi)
    dx, dy = reach * math.cos(angle), reach * math.sin(angle)
    a, b, c, d = (x, y), (x + dx, y + dy), (x + dx - dy, y + dy + dx), (x - dy, y + dx)
    return [
        [(x, 0.0, x, y)],
        [(x - dx, y - dy, x + dx, y + dy)],
        [(x - dx, y - dy, x + dx, y + dy), (x + dy, y - dx, x - dy, y + dx)],
        [(*a, *b), (*b, *c), (*c, *d), (*d, *a)],
    ][rng.integers(4)]
