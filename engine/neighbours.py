"""Who can touch or feel whom: Verlet lists over a cell grid, with a skin.

The lists hold until somebody has moved by half the skin.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit


class People(NamedTuple):
    """State of the persons, each an array (N,); the first n are inside, in the order of `who`."""

    who: np.ndarray  # number of the person at the start
    x: np.ndarray  # m
    y: np.ndarray  # m
    vx: np.ndarray  # m/s
    vy: np.ndarray  # m/s
    spin: np.ndarray  # rad/s
    fx: np.ndarray  # N
    fy: np.ndarray  # N
    torque: np.ndarray  # N m
    fx_before: np.ndarray  # N, forces of the step before, where the integrator needs them
    fy_before: np.ndarray  # N
    torque_before: np.ndarray  # N m
    ex: np.ndarray  # desired direction
    ey: np.ndarray
    radius: np.ndarray  # m
    mass: np.ndarray  # kg
    inertia: np.ndarray  # kg m^2
    v_d: np.ndarray  # m/s
    listed_x: np.ndarray  # m, place when the lists were built
    listed_y: np.ndarray
    out: np.ndarray  # number of the exit that the person has crossed, from 1; 0: inside


class Near(NamedTuple):
    """Pairs of persons, and of persons and walls, that can interact before the next rebuild."""

    i: np.ndarray  # (pairs,) uint32: an unsigned index costs no test for a negative one
    j: np.ndarray  # (pairs,) uint32, j > i
    slip: np.ndarray  # (pairs,) m, tangential spring
    wall_i: np.ndarray  # (wall pairs,) uint32
    wall: np.ndarray  # (wall pairs,) uint32
    wall_slip: np.ndarray  # (wall pairs,) m


@njit(cache=True)
def nobody_near():
    """Empty lists."""
    none = np.empty(0, np.uint32)
    return Near(none, none, np.empty(0), none, none, np.empty(0))


@njit(cache=True, error_model="numpy")
def rebuilt(people, n, walls, near, moved_to, gap, wall_gap):
    """Lists of the first n persons, with the springs of the old lists carried over.

    Parameters
    ----------
    moved_to : (old n,) int64, each listed person's new number; -1: gone
    gap, wall_gap : largest gap of a pair in the lists (reach of the social force and skin), m
    """
    if n == 0:
        return nobody_near()
    i, j = _pairs(people, n, gap)
    wall_i, wall = _wall_pairs(people, n, walls, wall_gap)
    slip, wall_slip = np.zeros(i.size), np.zeros(wall_i.size)
    _carry_over(near.i, near.j, near.slip, moved_to, moved_to, i, j, slip, n)
    same = np.arange(walls.shape[0])
    _carry_over(near.wall_i, near.wall, near.wall_slip, moved_to, same, wall_i, wall, wall_slip, n)
    for k in range(n):
        people.listed_x[k], people.listed_y[k] = people.x[k], people.y[k]
    return Near(i, j, slip, wall_i, wall, wall_slip)


@njit(cache=True, error_model="numpy")
def _pairs(people, n, gap):
    """Pairs i < j with a gap below `gap`, ordered by i, from a grid of cells as wide as the widest pair."""
    x, y, radius = people.x, people.y, people.radius
    x0, x1, y0, y1, largest = x[0], x[0], y[0], y[0], 0.0
    for i in range(n):
        x0, x1, y0, y1 = min(x0, x[i]), max(x1, x[i]), min(y0, y[i]), max(y1, y[i])
        largest = max(largest, radius[i])
    size = max(2.0 * largest + gap, math.sqrt((x1 - x0) * (y1 - y0) / (4.0 * n + 16.0)))  # no more cells than useful
    columns, rows = int((x1 - x0) / size) + 1, int((y1 - y0) / size) + 1
    first, following = np.full(columns * rows, -1), np.empty(n, np.int64)  # of the persons in a cell
    for i in range(n - 1, -1, -1):
        cell = int((x[i] - x0) / size) * rows + int((y[i] - y0) / size)
        following[i], first[cell] = first[cell], i
    found_i, found_j, count = np.empty(8 * n, np.uint32), np.empty(8 * n, np.uint32), 0
    for i in range(n):
        column, row = int((x[i] - x0) / size), int((y[i] - y0) / size)
        for c in range(max(column - 1, 0), min(column + 2, columns)):
            for cell in range(c * rows + max(row - 1, 0), c * rows + min(row + 2, rows)):
                j = first[cell]
                while j >= 0:
                    widest = radius[i] + radius[j] + gap
                    if j > i and (x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2 < widest * widest:
                        if count == found_i.size:
                            found_i, found_j = _doubled(found_i), _doubled(found_j)
                        found_i[count], found_j[count] = i, j
                        count += 1
                    j = following[j]
    return found_i[:count], found_j[:count]


@njit(cache=True, error_model="numpy")
def _wall_pairs(people, n, walls, gap):
    found_i, found_wall, count = np.empty(n, np.uint32), np.empty(n, np.uint32), 0
    for i in range(n):
        for w in range(walls.shape[0]):
            dx, dy = people.x[i] - walls[w, 0], people.y[i] - walls[w, 1]
            s = min(max(dx * walls[w, 2] + dy * walls[w, 3], 0.0), walls[w, 4])
            if math.hypot(dx - s * walls[w, 2], dy - s * walls[w, 3]) < people.radius[i] + gap:
                if count == found_i.size:
                    found_i, found_wall = _doubled(found_i), _doubled(found_wall)
                found_i[count], found_wall[count] = i, w
                count += 1
    return found_i[:count], found_wall[:count]


@njit(cache=True)
def _doubled(full):
    larger = np.empty(2 * full.size, np.uint32)
    for k in range(full.size):
        larger[k] = full[k]
    return larger


@njit(cache=True)
def _carry_over(old_i, old_j, old_slip, i_to, j_to, new_i, new_j, new_slip, n):
    """Copy the springs of old pairs to where the same pairs stand now; both lists are ordered by i."""
    start = np.zeros(n + 1, np.int64)  # where the new pairs of each i begin
    for k in range(new_i.size):
        start[new_i[k] + 1] += 1
    for i in range(n):
        start[i + 1] += start[i]
    for k in range(old_i.size):
        if old_slip[k] != 0.0 and i_to[old_i[k]] >= 0 and j_to[old_j[k]] >= 0:
            i, j = i_to[old_i[k]], j_to[old_j[k]]
            for m in range(start[i], start[i + 1]):
                if new_j[m] == j:
                    new_slip[m] = old_slip[k]
