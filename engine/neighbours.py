"""Who can touch or feel whom: Verlet lists over a cell grid, with a skin.

The lists hold until somebody has moved by half the skin.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit


class People(NamedTuple):
    """State of the persons, each an array (N,); the first n are inside, sorted by cell."""

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
    ease: np.ndarray  # 1/kg, 1/mass: to multiply costs less than to divide
    ease_to_turn: np.ndarray  # 1/(kg m^2), 1/inertia; 0 where nobody turns
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


class Touch(NamedTuple):
    """Contacts of the last forces, for integrators that solve for friction: pairs, then persons at walls."""

    counts: np.ndarray  # (2,) int64, how many pairs, how many persons at walls
    a: np.ndarray  # person
    b: np.ndarray  # the other person, where there is one
    place: np.ndarray  # where its spring stands in the list
    nx: np.ndarray  # from b, or the wall, to a
    ny: np.ndarray
    overlap: np.ndarray  # m
    radius: np.ndarray  # m, reduced
    mass: np.ndarray  # kg, reduced
    F_n: np.ndarray  # N, normal force without damping
    slip: np.ndarray  # m, of the tangential spring
    J_n: np.ndarray  # N s, impulse of damping along n
    J_t: np.ndarray  # N s, impulse of friction along t
    u: np.ndarray  # m/s, slip velocity


@njit(cache=True)
def nobody_in_touch(size):
    """Room for `size` contacts, none of which exists."""
    none, zero = np.empty(size, np.uint32), np.empty(size)
    return Touch(
        np.zeros(2, np.int64),
        none,
        none.copy(),
        none.copy(),
        zero,
        zero.copy(),
        zero.copy(),
        zero.copy(),
        zero.copy(),
        zero.copy(),
        zero.copy(),
        zero.copy(),
        zero.copy(),
        zero.copy(),
    )


@njit(cache=True)
def nobody_near():
    """Empty lists."""
    none = np.empty(0, np.uint32)
    return Near(none, none, np.empty(0), none, none, np.empty(0))


@njit(cache=True, error_model="numpy")
def rebuilt(people, n, walls, near, gap, wall_gap):
    """Lists of those of the first n persons who are not gone, with the springs of the old lists carried over.

    The gone (`who` = -1) leave the arrays, and the others are sorted by cell, so that neighbours stand together.

    Parameters
    ----------
    gap, wall_gap : largest gap of a pair in the lists (reach of the social force and skin), m

    Returns
    -------
    Near, int
        The lists, and how many persons there are.
    """
    cell, columns, rows = _cells(people, n, gap)
    moved_to, start, n = _sorted(people, n, cell, columns * rows)
    if n == 0:
        return nobody_near(), n
    i, j = _pairs(people, n, start, columns, rows, gap)
    wall_i, wall = _wall_pairs(people, n, walls, wall_gap)
    slip, wall_slip = np.zeros(i.size), np.zeros(wall_i.size)
    _carry_over(True, near.i, near.j, near.slip, moved_to, moved_to, i, j, slip, n)
    same = np.arange(walls.shape[0])
    _carry_over(False, near.wall_i, near.wall, near.wall_slip, moved_to, same, wall_i, wall, wall_slip, n)
    for k in range(n):
        people.listed_x[k], people.listed_y[k] = people.x[k], people.y[k]
    return Near(i, j, slip, wall_i, wall, wall_slip), n


@njit(cache=True, error_model="numpy")
def _cells(people, n, gap):
    """The cell of each person, in a grid of cells as wide as the widest pair; the gone stand in none (-1)."""
    x, y, radius, who = people.x, people.y, people.radius, people.who
    x0, x1, y0, y1, largest = np.inf, -np.inf, np.inf, -np.inf, 0.0
    for i in range(n):
        if who[i] >= 0:
            x0, x1, y0, y1 = min(x0, x[i]), max(x1, x[i]), min(y0, y[i]), max(y1, y[i])
            largest = max(largest, radius[i])
    cell = np.full(n, -1)
    if x1 < x0:
        return cell, 1, 1
    size = max(2.0 * largest + gap, math.sqrt((x1 - x0) * (y1 - y0) / (4.0 * n + 16.0)))  # no more cells than useful
    columns, rows = int((x1 - x0) / size) + 1, int((y1 - y0) / size) + 1
    for i in range(n):
        if who[i] >= 0:
            cell[i] = int((x[i] - x0) / size) * rows + int((y[i] - y0) / size)
    return cell, columns, rows


@njit(cache=True, error_model="numpy")
def _sorted(people, n, cell, cells):
    """Sort the persons by cell.

    Returns everybody's new number (-1: gone), where each cell begins and the last ends, and how many stay.
    """
    start = np.zeros(cells + 2, np.int64)
    for i in range(n):
        start[cell[i] + 2] += cell[i] >= 0
    for c in range(cells):
        start[c + 2] += start[c + 1]
    stay, in_order = start[cells + 1], True
    moved_to = np.empty(n, np.int64)
    for i in range(n):
        moved_to[i] = -1
        if cell[i] >= 0:
            moved_to[i] = start[cell[i] + 1]
            start[cell[i] + 1] += 1  # in the end, cell c holds start[c] to start[c + 1]
        in_order &= moved_to[i] == i
    if not in_order:
        spare, spare_who = np.empty(n), np.empty(n, people.who.dtype)
        _rearrange(people.who, moved_to, n, spare_who)
        _rearrange(people.out, moved_to, n, spare_who)
        for values in (
            people.x,
            people.y,
            people.vx,
            people.vy,
            people.spin,
            people.radius,
            people.mass,
            people.inertia,
            people.ease,
            people.ease_to_turn,
            people.v_d,
            people.fx_before,
            people.fy_before,
            people.torque_before,
        ):
            _rearrange(values, moved_to, n, spare)
    return moved_to, start, stay


@njit(cache=True)
def _rearrange(values, moved_to, n, spare):
    for i in range(n):
        spare[i] = values[i]
    for i in range(n):
        if moved_to[i] >= 0:
            values[moved_to[i]] = spare[i]


@njit(cache=True, error_model="numpy")
def _pairs(people, n, start, columns, rows, gap):
    """Pairs i < j with a gap below `gap`, ordered by i, of persons sorted by cell."""
    x, y, radius = people.x, people.y, people.radius
    found_i, found_j, count = np.empty(8 * n, np.uint32), np.empty(8 * n, np.uint32), 0
    for c in range(columns * rows):
        column, row = c // rows, c % rows
        above = start[c + min(row + 1, rows - 1) - row + 1]  # this cell and the next of its column
        begin = end = 0  # three cells of the next column
        if column + 1 < columns:
            begin = start[(column + 1) * rows + max(row - 1, 0)]
            end = start[(column + 1) * rows + min(row + 1, rows - 1) + 1]
        for i in range(start[c], start[c + 1]):
            while count + (above - i) + end - begin > found_i.size:
                found_i, found_j = _doubled(found_i), _doubled(found_j)
            xi, yi, widest = x[i], y[i], radius[i] + gap
            for j in range(i + 1, above):  # without a branch: half of them would be guessed wrong
                dx, dy, wide = xi - x[j], yi - y[j], widest + radius[j]
                found_i[count], found_j[count] = i, j
                count += dx * dx + dy * dy < wide * wide
            for j in range(begin, end):
                dx, dy, wide = xi - x[j], yi - y[j], widest + radius[j]
                found_i[count], found_j[count] = i, j
                count += dx * dx + dy * dy < wide * wide
    return found_i[:count], found_j[:count]


@njit(cache=True, error_model="numpy")
def _wall_pairs(people, n, walls, gap):
    """Persons i and walls with a gap below `gap`, ordered by i."""
    is_near, felt, walls_felt = np.empty((walls.shape[0], n), np.uint8), np.empty(walls.shape[0], np.int64), 0
    for w in range(walls.shape[0]):
        x0, y0, ux, uy, length = walls[w, 0], walls[w, 1], walls[w, 2], walls[w, 3], walls[w, 4]
        by = 0
        for i in range(n):
            dx, dy, widest = people.x[i] - x0, people.y[i] - y0, people.radius[i] + gap
            s = min(max(dx * ux + dy * uy, 0.0), length)
            is_near[w, i] = (dx - s * ux) ** 2 + (dy - s * uy) ** 2 < widest * widest
            by += is_near[w, i]
        if by > 0:
            felt[walls_felt] = w
            walls_felt += 1
    found_i, found_wall, count = np.empty(n, np.uint32), np.empty(n, np.uint32), 0
    for i in range(n):
        while count + walls_felt > found_i.size:
            found_i, found_wall = _doubled(found_i), _doubled(found_wall)
        for k in range(walls_felt):
            found_i[count], found_wall[count] = i, felt[k]
            count += is_near[felt[k], i]
    return found_i[:count], found_wall[:count]


@njit(cache=True)
def _doubled(full):
    larger = np.empty(2 * full.size, np.uint32)
    for k in range(full.size):
        larger[k] = full[k]
    return larger


@njit(cache=True)
def _carry_over(persons, old_i, old_j, old_slip, i_to, j_to, new_i, new_j, new_slip, n):
    """Copy the springs of old pairs to where the same pairs stand now; the new list is ordered by i.

    A pair whose persons have changed places in the order keeps its slip: seen from the other, tangent and slip
    velocity both turn round.
    """
    start = np.zeros(n + 1, np.int64)  # where the new pairs of each i begin
    for k in range(new_i.size):
        start[new_i[k] + 1] += 1
    for i in range(n):
        start[i + 1] += start[i]
    for k in range(old_i.size):
        if old_slip[k] != 0.0 and i_to[old_i[k]] >= 0 and j_to[old_j[k]] >= 0:
            i, j = i_to[old_i[k]], j_to[old_j[k]]
            if persons and i > j:
                i, j = j, i
            for m in range(start[i], start[i + 1]):
                if new_j[m] == j:
                    new_slip[m] = old_slip[k]
