"""Persons drawn from a seed, and placed at random without overlap."""

import math
from typing import NamedTuple

import numpy as np

from engine.kernel.compiled import entry_point, shared_function
from engine.kernel.contacts import from_closest_point

PERSONS, PLACEMENT, MOTION = 0, 1, 2  # independent random streams of one seed
MAX_ROUNDS = 2000  # of placement: each round every person without a position tries a new one

Range = tuple[float, float]
Area = tuple[float, float, float, float]  # x0, x1, y0, y1, m


class Start(NamedTuple):
    """The state of N persons at the start, each an array (N,)."""

    x: np.ndarray  # m
    y: np.ndarray  # m
    vx: np.ndarray  # m/s
    vy: np.ndarray  # m/s
    spin: np.ndarray  # rad/s
    radius: np.ndarray  # m
    mass: np.ndarray  # kg
    v_d: np.ndarray  # m/s


def draw_uniform(
    seed: int, N: int, area: Area, radius: Range, mass: Range, v_d: Range, speed: Range, walls: np.ndarray
) -> Start:
    """Draw N persons from ranges, at positions in a rectangle; nan where there was no room.

    Parameters
    ----------
    walls : (walls,) WALL
        See `engine.kernel.scene_arrays`; nobody overlaps one.
    """
    persons, motion = _stream(seed, PERSONS), _stream(seed, MOTION)
    radii, masses, speeds = (persons.uniform(*values, N) for values in (radius, mass, v_d))
    x, y = _place(radii, area, walls, _stream(seed, PLACEMENT))
    v, angle = motion.uniform(*speed, N), motion.uniform(0.0, 2.0 * math.pi, N)
    return Start(x, y, v * np.cos(angle), v * np.sin(angle), np.zeros(N), radii, masses, speeds)


def _stream(seed: int, stream: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(stream,)))


def _place(
    radius: np.ndarray, area: Area, walls: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Random sequential placement: rounds in which all who wait try one position each."""
    x0, x1, y0, y1 = area
    N = radius.size
    size = max(2.0 * float(radius.max()), math.sqrt((x1 - x0) * (y1 - y0) / (4.0 * N + 16.0)))  # of a cell
    x, y = np.full(N, np.nan), np.full(N, np.nan)
    first = np.full((int((x1 - x0) / size) + 3, int((y1 - y0) / size) + 3), -1, np.int64)  # person in each cell
    following = np.full(N, -1, np.int64)  # the next person in the same cell
    waiting = np.arange(N)
    for _ in range(MAX_ROUNDS):
        u, v = rng.random(waiting.size), rng.random(waiting.size)
        r = radius[waiting]
        tried_x, tried_y = x0 + r + u * (x1 - x0 - 2 * r), y0 + r + v * (y1 - y0 - 2 * r)
        _try_positions(waiting, tried_x, tried_y, x, y, radius, walls, first, following, x0, y0, size)
        waiting = waiting[np.isnan(x[waiting])]
        if not waiting.size:
            break
    return x, y


@entry_point
def _try_positions(who, tried_x, tried_y, x, y, radius, walls, first, following, x0, y0, size):
    """Give each of `who` the tried position if nobody and no wall is in the way; nan in x: no position yet."""
    for k in range(who.size):
        i, px, py = who[k], tried_x[k], tried_y[k]
        cx, cy = int((px - x0) / size) + 1, int((py - y0) / size) + 1
        free = _is_free(px, py, radius[i], cx, cy, x, y, radius, first, following)
        if free and _is_clear_of(walls, px, py, radius[i]):
            following[i], first[cx, cy] = first[cx, cy], i
            x[i], y[i] = px, py


@shared_function
def _is_free(px, py, r, cx, cy, x, y, radius, first, following):
    for ax in range(cx - 1, cx + 2):
        for ay in range(cy - 1, cy + 2):
            j = first[ax, ay]
            while j >= 0:
                dx, dy, wide = px - x[j], py - y[j], r + radius[j]
                if dx * dx + dy * dy <= wide * wide:
                    return False
                j = following[j]
    return True


@shared_function
def _is_clear_of(walls, px, py, r):
    for w in range(walls.size):
        dx, dy, _end = from_closest_point(walls, w, px, py)
        if dx * dx + dy * dy < r * r * (1.0 - 1e-12):
            return False
    return True
