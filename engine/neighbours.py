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
    cell, start = np.empty(n, np.int64), np.zeros(columns * rows + 2, np.int64)
    for i in range(n):
        cell[i] = int((x[i] - x0) / size) * rows + int((y[i] - y0) / size)
        start[cell[i] + 2] += 1
    for c in range(columns * rows):
        start[c + 2] += start[c + 1]
    who, near_x, near_y, near_r = np.empty(n, np.int64), np.empty(n), np.empty(n), np.empty(n)  # sorted by cell
    for i in range(n):
        k = start[cell[i] + 1]
        start[cell[i] + 1] += 1  # in the end, cell c holds start[c] to start[c + 1]
        who[k], near_x[k], near_y[k], near_r[k] = i, x[i], y[i], radius[i] + gap
    found_i, found_j, count = np.empty(8 * n, np.uint32), np.empty(8 * n, np.uint32), 0
    for i in range(n):
        column, row = cell[i] // rows, cell[i] % rows
        for c in range(max(column - 1, 0), min(column + 2, columns)):
            begin, end = start[c * rows + max(row - 1, 0)], start[c * rows + min(row + 1, rows - 1) + 1]
            while count + end - begin > found_i.size:
                found_i, found_j = _doubled(found_i), _doubled(found_j)
            for k in range(begin, end):  # without a branch: half of them would be guessed wrong
                dx, dy, widest = x[i] - near_x[k], y[i] - near_y[k], radius[i] + near_r[k]
                found_i[count], found_j[count] = i, who[k]
                count += (who[k] > i) & (dx * dx + dy * dy < widest * widest)
    return found_i[:count], found_j[:count]


@njit(cache=True, error_model="numpy")
def _wall_pairs(people, n, walls, gap):
    found_i, found_wall, count = np.empty(n, np.uint32), np.empty(n, np.uint32), 0
    for i in range(n):
        x, y, widest = people.x[i], people.y[i], people.radius[i] + gap
        for w in range(walls.shape[0]):
            dx, dy, ux, uy = x - walls[w, 0], y - walls[w, 1], walls[w, 2], walls[w, 3]
            s = min(max(dx * ux + dy * uy, 0.0), walls[w, 4])
            if (dx - s * ux) ** 2 + (dy - s * uy) ** 2 < widest * widest:
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
