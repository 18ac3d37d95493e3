"""Who can touch or feel whom: Verlet lists over a cell grid, with a skin.

The lists hold until somebody has moved by half the skin.
"""

import math

import numpy as np

from engine.kernel.compiled import shared_function
from engine.kernel.contacts import from_closest_point
from engine.kernel.state import MOVED_TOGETHER, UNSTABLE

DOMAIN_LIMIT = 1e6  # m; whoever is farther from the origin has been thrown out of the world
FIRST_SKIN, LEAST_SKIN = 0.12, 0.01  # m
LIST_COST = 2.4  # of making lists, in visits of all pairs


@shared_function
def rebuild(walls, parameters, persons, pairs, wall_pairs, scratch, state):
    """List all pairs that can interact anew, with the histories of the contacts carried over.

    The gone (`person_id` = -1) leave the arrays, and the others are sorted by cell, so that neighbours stand together.
    Where there is no room, `room_needed` says so; the histories then wait, and the call is to be made again. If
    somebody is nowhere, the run is unstable.
    """
    if not state.room_needed:
        if _somebody_is_nowhere(persons, state.n):
            state.outcome, state.lists_due = UNSTABLE, False
            return
        state.skin = parameters.skin if parameters.skin > 0.0 else _next_skin(parameters, state)
        state.rebuilds += 1
    gap, wall_gap = parameters.cutoff + state.skin, parameters.wall_cutoff + state.skin
    columns, rows = _find_cells(persons, state.n, gap, scratch.cell)
    n, in_order = _cell_order(state.n, scratch.cell, columns * rows, scratch.cell_start, scratch.moved_to)
    state.carried = _collect(pairs, state.pairs, state.carried, scratch.moved_to, True)
    state.wall_carried = _collect(wall_pairs, state.wall_pairs, state.wall_carried, scratch.moved_to, False)
    if not in_order:
        _sort(persons, state.n, scratch)
    state.n = n
    state.pairs = _find_pairs(persons, pairs, scratch.cell_start, columns, rows, gap) if n > 0 else 0
    state.wall_pairs = _find_wall_pairs(persons, n, walls, wall_pairs, wall_gap, scratch.near_wall)
    state.room_needed = state.pairs < 0 or state.wall_pairs < 0
    if state.room_needed:
        state.pairs = state.wall_pairs = 0
        return
    _return(pairs, state.pairs, state.carried, n, scratch.pair_start)
    _return(wall_pairs, state.wall_pairs, state.wall_carried, n, scratch.pair_start)
    state.carried = state.wall_carried = 0
    for k in range(n):
        persons.listed_x[k], persons.listed_y[k] = persons.x[k], persons.y[k]
    state.lists_due, state.list_uses = False, 0


@shared_function
def _next_skin(parameters, state):
    """Skin of the next lists, m, at which making lists and visiting the pairs in the skin cost least together.

    The pairs grow as (D + skin)^2, D being the distance at which persons interact, and lists last for skin/(2 u)
    forces, where somebody moves by u between two; making them costs as much as LIST_COST visits of all pairs.
    """
    if state.list_uses == 0:
        return FIRST_SKIN
    distance = 2.0 * parameters.min_radius + parameters.cutoff
    return min(max(math.sqrt(LIST_COST * distance * state.skin / (2.0 * state.list_uses)), LEAST_SKIN), distance)


@shared_function
def _somebody_is_nowhere(persons, n):
    """Whether a position is no number, or far outside any scene."""
    for i in range(n):
        if not abs(persons.x[i]) + abs(persons.y[i]) < DOMAIN_LIMIT:  # true for nan
            return True
    return False


@shared_function
def _find_cells(persons, n, gap, cell):
    """Find everybody's cell, in a grid of cells as wide as the widest pair (-1: gone); its columns and rows."""
    x, y, radius, person_id = persons.x, persons.y, persons.radius, persons.person_id
    x0, x1, y0, y1, largest = math.inf, -math.inf, math.inf, -math.inf, 0.0
    for i in range(n):
        cell[i] = -1
        if person_id[i] >= 0:
            x0, x1, y0, y1 = min(x0, x[i]), max(x1, x[i]), min(y0, y[i]), max(y1, y[i])
            largest = max(largest, radius[i])
    if x1 < x0:
        return 1, 1
    most = 4.0 * n + 16.0  # cells that are of use
    size = max(2.0 * largest + gap, math.sqrt((x1 - x0) * (y1 - y0) / most))
    size = max(size, max(x1 - x0, y1 - y0) / most)
    columns, rows = int((x1 - x0) / size) + 1, int((y1 - y0) / size) + 1
    for i in range(n):
        if person_id[i] >= 0:
            cell[i] = int((x[i] - x0) / size) * rows + int((y[i] - y0) / size)
    return columns, rows


@shared_function
def _cell_order(n, cell, cells, start, moved_to):
    """Find everybody's new number (-1: gone) and where each cell begins; how many stay, and whether nobody moves."""
    for c in range(cells + 2):
        start[c] = 0
    for i in range(n):
        c = cell[i]
        start[c + 2] += c >= 0
    for c in range(cells):
        start[c + 2] += start[c + 1]
    stay, in_order = start[cells + 1], True
    for i in range(n):
        c, number = cell[i], -1
        if c >= 0:
            number = start[c + 1]
            start[c + 1] = number + 1  # in the end, cell c holds start[c] to start[c + 1]
        moved_to[i] = number
        in_order &= number == i
    return stay, in_order


@shared_function
def _sort(persons, n, scratch):
    """Bring everybody to their new number."""
    for values in persons[:2]:
        _rearrange(values, scratch.moved_to, n, scratch.ids)
    for values in persons[2:MOVED_TOGETHER]:
        _rearrange(values, scratch.moved_to, n, scratch.numbers)


@shared_function
def _rearrange(values, moved_to, n, spare):
    for i in range(n):
        spare[i] = values[i]
    for i in range(n):
        if moved_to[i] >= 0:
            values[moved_to[i]] = spare[i]


@shared_function
def _find_pairs(persons, pairs, start, columns, rows, gap):
    """List pairs i < j with a gap below `gap`, ordered by i, of persons sorted by cell; how many, -1 without room."""
    x, y, radius, pair_i, pair_j, count = persons.x, persons.y, persons.radius, pairs.i, pairs.j, 0
    for c in range(columns * rows):
        column, row = c // rows, c % rows
        above = start[c + min(row + 1, rows - 1) - row + 1]  # this cell and the next of its column
        begin = end = 0  # three cells of the next column
        if column + 1 < columns:
            begin = start[(column + 1) * rows + max(row - 1, 0)]
            end = start[(column + 1) * rows + min(row + 1, rows - 1) + 1]
        for i in range(start[c], start[c + 1]):
            if count + (above - i) + end - begin > pair_i.size:
                return -1
            xi, yi, widest = x[i], y[i], radius[i] + gap
            for j in range(i + 1, above):  # without a branch: half of them would be guessed wrong
                dx, dy, wide = xi - x[j], yi - y[j], widest + radius[j]
                pair_i[count], pair_j[count] = i, j
                count += dx * dx + dy * dy < wide * wide
            for j in range(begin, end):
                dx, dy, wide = xi - x[j], yi - y[j], widest + radius[j]
                pair_i[count], pair_j[count] = i, j
                count += dx * dx + dy * dy < wide * wide
    return count


@shared_function
def _find_wall_pairs(persons, n, walls, pairs, gap, near_wall):
    """List persons i and walls with a gap below `gap`, ordered by i; how many, -1 without room."""
    for w in range(walls.size):
        for i in range(n):
            dx, dy, _end = from_closest_point(walls, w, persons.x[i], persons.y[i])
            widest = persons.radius[i] + gap
            near_wall[w, i] = dx * dx + dy * dy < widest * widest
    count = 0
    for i in range(n):
        if count + walls.size > pairs.i.size:
            return -1
        for w in range(walls.size):
            pairs.i[count], pairs.j[count] = i, w
            count += near_wall[w, i]
    return count


@shared_function
def _collect(pairs, count, carried, moved_to, between_persons):
    """Set the histories of a list aside, by the new numbers of their persons; returns how many wait."""
    for k in range(count):
        i, j, value = moved_to[pairs.i[k]], np.int64(pairs.j[k]), pairs.history[k]
        if between_persons:
            j = moved_to[j]
        if value != 0.0 and i >= 0 and j >= 0:
            if between_persons and i > j:  # tangent, slip and force all turn round, and the values stay
                i, j = j, i
            history = pairs.carried[carried]
            history.i, history.j, history.value = i, j, value
            carried += 1
    return carried


@shared_function
def _return(pairs, count, carried, n, start):
    """Bring the histories that were set aside to where the same pairs stand now, in a list ordered by i."""
    for i in range(n + 1):
        start[i] = 0
    for k in range(count):
        pairs.history[k] = 0.0
        start[np.int64(pairs.i[k]) + 1] += 1
    for i in range(n):
        start[i + 1] += start[i]
    for h in range(carried):
        history = pairs.carried[h]
        for k in range(start[history.i], start[history.i + 1]):
            if pairs.j[k] == history.j:
                pairs.history[k] = history.value
