"""The one place where laws meet pairs of persons and walls.

Pairs are taken in blocks that fit the first-level cache, each block in four plain loops: gather, arithmetic
that the compiler vectorises, scatter, and a scalar loop over the few pairs that touch.
"""

import math

from engine.compiled import inlined_step_function, step_function
from engine.integrators.choice import settles
from engine.laws import drive, looks, normal, remembers, sliding, social, stiff, turns, vision

BLOCK = 512  # pairs; a constant, so that the compiler sees that the scratch rows do not overlap
AWAY = 1e9  # m, out of the reach of any law
ROWS = 7  # of scratch: dx, dy, r_i + r_j, desired directions of i and j


@step_function
def forces(integrator, model, scene, people, n, near, touch, stretch, lead, scratch, touching):
    """Sum all forces and torques on the first n persons into `people`.

    For an integrator that settles velocities itself: neither the drive nor what depends on velocity in contacts of
    stiff friction, which go into `touch`.

    Parameters
    ----------
    stretch : time over which tangential springs stretch, s
    lead : time by which the springs are kept ahead of the slip that acts, s; see `engine.integrators`
    scratch : (ROWS * BLOCK,) float64
    touching : (BLOCK + 1,) uint32

    Returns
    -------
    float, float
        Largest overlap of two persons, of a person and a wall, m.
    """
    touch.counts[:] = 0
    _driving(integrator, model, scene.exits, people, n, scratch)
    overlap = _between_persons(integrator, model, people, near, touch, stretch, lead, scratch, touching)
    return overlap, _at_walls(integrator, model, scene, people, near, touch, stretch, lead, scratch, touching)


@step_function
def _driving(integrator, model, exits, people, n, s):
    """Start the sums with the driving force; the desired direction is that of the nearest exit."""
    for first in range(0, n, BLOCK):
        count = min(BLOCK, n - first)
        _aim(exits, people, first, count, s)
        for p in range(count):
            people.ex[first + p] = s[3 * BLOCK + p]
        for p in range(count):
            people.ey[first + p] = s[4 * BLOCK + p]
    if settles(integrator):
        for i in range(n):
            people.fx[i], people.fy[i] = 0.0, 0.0
    else:
        for i in range(n):
            people.fx[i] = drive(model.drive, people.mass[i], people.v_d[i], people.ex[i], people.vx[i])
        for i in range(n):
            people.fy[i] = drive(model.drive, people.mass[i], people.v_d[i], people.ey[i], people.vy[i])
    for i in range(n):
        people.torque[i] = 0.0


@step_function
def _aim(exits, people, first, count, s):
    """Desired directions of a block of persons, to rows 3 and 4 of the scratch.

    Towards the nearest point of the nearest exit, its line shortened by the radius at both ends; straight
    out for those who stand there or have crossed an exit; no direction where there is no exit.
    """
    for p in range(count):
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = people.x[first + p], people.y[first + p], people.radius[first + p]
    for p in range(count):
        s[3 * BLOCK + p], s[4 * BLOCK + p], s[5 * BLOCK + p] = 0.0, 0.0, math.inf
    for k in range(exits.shape[0]):
        x0, y0, ux, uy, length = exits[k, 0], exits[k, 1], exits[k, 2], exits[k, 3], exits[k, 4]
        for p in range(count):  # arithmetic without a branch, that the compiler vectorises
            x, y, radius = s[p], s[BLOCK + p], min(s[2 * BLOCK + p], 0.5 * length)
            aim = min(max((x - x0) * ux + (y - y0) * uy, radius), length - radius)
            dx, dy = x0 + aim * ux - x, y0 + aim * uy - y
            distance = math.sqrt(dx * dx + dy * dy)
            there = distance < 1e-9  # at the aim itself: straight out
            inverse = 1.0 / max(distance, 1e-9)
            ex, ey = exits[k, 5] if there else dx * inverse, exits[k, 6] if there else dy * inverse
            nearer = distance < s[5 * BLOCK + p]
            s[3 * BLOCK + p] = ex if nearer else s[3 * BLOCK + p]
            s[4 * BLOCK + p] = ey if nearer else s[4 * BLOCK + p]
            s[5 * BLOCK + p] = distance if nearer else s[5 * BLOCK + p]
    for p in range(count):
        k = people.out[first + p] - 1
        if k >= 0:
            s[3 * BLOCK + p], s[4 * BLOCK + p] = exits[k, 5], exits[k, 6]


@step_function
def _between_persons(integrator, model, people, near, touch, stretch, lead, s, touching):
    deepest = 0.0
    for first in range(0, near.i.size, BLOCK):
        count = min(BLOCK, near.i.size - first)
        i, j = near.i[first : first + count], near.j[first : first + count]
        _gather(model, people, i, j, count, s)
        _repel(model, count, s)
        _scatter(people, i, j, count, s)
        slip = near.slip[first : first + count]
        overlap = _contacts(integrator, model, people, i, j, slip, first, touch, count, stretch, lead, s, touching)
        deepest = max(deepest, overlap)
    return deepest


@inlined_step_function
def _gather(model, people, i, j, count, s):
    """Bring a block's places, radii and desired directions together; those of one i are read once."""
    x, y, radius, ex, ey = people.x, people.y, people.radius, people.ex, people.ey
    of = i[0]
    x_i, y_i, radius_i, ex_i, ey_i = x[of], y[of], radius[of], ex[of], ey[of]
    for p in range(count):
        if i[p] != of:
            of = i[p]
            x_i, y_i, radius_i, ex_i, ey_i = x[of], y[of], radius[of], ex[of], ey[of]
        k = j[p]
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = x_i - x[k], y_i - y[k], radius_i + radius[k]
        if looks(model.vision):
            s[3 * BLOCK + p], s[4 * BLOCK + p], s[5 * BLOCK + p], s[6 * BLOCK + p] = ex_i, ey_i, ex[k], ey[k]


@inlined_step_function
def _repel(model, count, s):
    """Turn scratch into n_x, n_y, gap, social force on i along n, social force on j along -n."""
    for p in range(count):
        dx, dy = s[p], s[BLOCK + p]
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        nx, ny = dx * inverse, dy * inverse
        gap = distance - s[2 * BLOCK + p]
        force = social(model.social, gap)
        on_i = force * vision(model.vision, -(s[3 * BLOCK + p] * nx + s[4 * BLOCK + p] * ny))
        on_j = force * vision(model.vision, s[5 * BLOCK + p] * nx + s[6 * BLOCK + p] * ny)
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = nx, ny, gap
        s[3 * BLOCK + p], s[4 * BLOCK + p] = on_i, on_j


@inlined_step_function
def _scatter(people, i, j, count, s):
    """Add the social forces; those of one i are summed in registers, since its pairs stand together."""
    fx, fy = people.fx, people.fy
    of, sum_x, sum_y = i[0], 0.0, 0.0
    for p in range(count):
        if i[p] != of:
            fx[of] += sum_x
            fy[of] += sum_y
            of, sum_x, sum_y = i[p], 0.0, 0.0
        nx, ny = s[p], s[BLOCK + p]
        sum_x += s[3 * BLOCK + p] * nx
        sum_y += s[3 * BLOCK + p] * ny
        fx[j[p]] -= s[4 * BLOCK + p] * nx
        fy[j[p]] -= s[4 * BLOCK + p] * ny
    fx[of] += sum_x
    fy[of] += sum_y


@inlined_step_function
def _contacts(integrator, model, people, i, j, slip, first, touch, count, stretch, lead, s, touching):
    """Normal and tangential forces of the pairs in touch; a spring ends with its contact."""
    touches = _touches(model.sliding, slip, count, s, touching)
    deepest = 0.0
    for t in range(touches):
        p = touching[t]
        a, b, overlap = i[p], j[p], -s[2 * BLOCK + p]
        nx, ny = s[p], s[BLOCK + p]
        deepest = max(deepest, overlap)
        radius = people.radius[a] * people.radius[b] / (people.radius[a] + people.radius[b])
        mass = people.mass[a] * people.mass[b] / (people.mass[a] + people.mass[b])
        ux, uy = people.vx[a] - people.vx[b], people.vy[a] - people.vy[b]
        v_n = ux * nx + uy * ny
        v_t = uy * nx - ux * ny
        if turns(model.rotation):
            v_t -= people.radius[a] * people.spin[a] + people.radius[b] * people.spin[b]
        if settles(integrator) and stiff(model.sliding):
            k = touch.counts[0]
            touch.counts[0] = k + 1
            touch.a[k], touch.b[k], touch.place[k] = a, b, first + p
            touch.nx[k], touch.ny[k], touch.overlap[k] = nx, ny, overlap
            touch.slip[k], touch.u[k] = slip[p] + v_t * stretch, v_t
            F_n = normal(model.normal, overlap, radius, mass, 0.0)
            touch.radius[k], touch.mass[k], touch.F_n[k] = radius, mass, F_n
            people.fx[a] += F_n * nx
            people.fy[a] += F_n * ny
            people.fx[b] -= F_n * nx
            people.fy[b] -= F_n * ny
            continue
        F_n = normal(model.normal, overlap, radius, mass, v_n)
        ahead = lead * v_t
        F_t, stretched = sliding(model.sliding, overlap, radius, mass, v_t, F_n, slip[p] + v_t * stretch - ahead)
        slip[p] = stretched + ahead
        fx, fy = F_n * nx - F_t * ny, F_n * ny + F_t * nx
        people.fx[a] += fx
        people.fy[a] += fy
        people.fx[b] -= fx
        people.fy[b] -= fy
        people.torque[a] -= people.radius[a] * F_t
        people.torque[b] -= people.radius[b] * F_t
    return deepest


@step_function
def _at_walls(integrator, model, scene, people, near, touch, stretch, lead, s, touching):
    """Forces of the walls: bodies of infinite mass and radius, each acting through its closest point."""
    deepest = 0.0
    for first in range(0, near.wall_i.size, BLOCK):
        count = min(BLOCK, near.wall_i.size - first)
        i, wall = near.wall_i[first : first + count], near.wall[first : first + count]
        _gather_walls(scene, people, i, wall, count, s)
        _repel_from_walls(model, count, s)
        for p in range(count):
            people.fx[i[p]] += s[3 * BLOCK + p] * s[p]
            people.fy[i[p]] += s[3 * BLOCK + p] * s[BLOCK + p]
        slip = near.wall_slip[first : first + count]
        overlap = _contacts_at_walls(
            integrator, model, people, i, slip, first, touch, count, stretch, lead, s, touching
        )
        deepest = max(deepest, overlap)
    return deepest


@inlined_step_function
def _gather_walls(scene, people, i, wall, count, s):
    """Bring the ways from a block's walls to their persons together, and radii; -AWAY where a wall does not act."""
    walls, joints = scene.walls, scene.joints
    for p in range(count):
        x, y, w = people.x[i[p]], people.y[i[p]], wall[p]
        dx, dy, end = _from_segment(x, y, walls[w, 0], walls[w, 1], walls[w, 2], walls[w, 3], walls[w, 4])
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = dx, dy, people.radius[i[p]]
        if end >= 0 and joints[w, end, 0] >= 0 and not _counts(walls, joints, w, end, x, y, dx, dy):
            s[2 * BLOCK + p] = -AWAY


@inlined_step_function
def _repel_from_walls(model, count, s):
    """Turn scratch into n_x, n_y, gap (AWAY where a wall does not act) and social force along n."""
    for p in range(count):
        dx, dy = s[p], s[BLOCK + p]
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        gap = distance - s[2 * BLOCK + p]
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = dx * inverse, dy * inverse, gap
        s[3 * BLOCK + p] = social(model.wall_social, gap)


@inlined_step_function
def _contacts_at_walls(integrator, model, people, i, slips, first, touch, count, stretch, lead, s, touching):
    """Normal and tangential forces of those who touch a wall; a spring ends with its contact."""
    touches = _touches(model.wall_sliding, slips, count, s, touching)
    deepest = 0.0
    for t in range(touches):
        p = touching[t]
        a, overlap = i[p], -s[2 * BLOCK + p]
        nx, ny = s[p], s[BLOCK + p]
        deepest = max(deepest, overlap)
        radius, mass = people.radius[a], people.mass[a]
        v_n = people.vx[a] * nx + people.vy[a] * ny
        v_t = people.vy[a] * nx - people.vx[a] * ny
        if turns(model.rotation):
            v_t -= radius * people.spin[a]
        if settles(integrator) and stiff(model.wall_sliding):
            k = touch.counts[0] + touch.counts[1]
            touch.counts[1] += 1
            touch.a[k], touch.b[k], touch.place[k] = a, a, first + p
            touch.nx[k], touch.ny[k], touch.overlap[k] = nx, ny, overlap
            touch.slip[k], touch.u[k] = slips[p] + v_t * stretch, v_t
            F_n = normal(model.wall_normal, overlap, radius, mass, 0.0)
            touch.radius[k], touch.mass[k], touch.F_n[k] = radius, mass, F_n
            people.fx[a] += F_n * nx
            people.fy[a] += F_n * ny
            continue
        F_n = normal(model.wall_normal, overlap, radius, mass, v_n)
        ahead = lead * v_t
        F_t, stretched = sliding(model.wall_sliding, overlap, radius, mass, v_t, F_n, slips[p] + v_t * stretch - ahead)
        slips[p] = stretched + ahead
        people.fx[a] += F_n * nx - F_t * ny
        people.fy[a] += F_n * ny + F_t * nx
        people.torque[a] -= radius * F_t
    return deepest


@inlined_step_function
def _touches(law, slip, count, s, touching):
    """How many pairs of a block touch, and which; the springs of the others end."""
    touches = 0
    for p in range(count):  # without a branch: most pairs do not touch
        touching[touches] = p
        touches += s[2 * BLOCK + p] < 0.0
    if remembers(law):
        for p in range(count):
            slip[p] = slip[p] if s[2 * BLOCK + p] < 0.0 else 0.0
    return touches


@inlined_step_function
def _from_segment(x, y, x0, y0, ux, uy, length):
    """From the closest point of a segment to (x, y), and which end that point is (-1: neither)."""
    along = (x - x0) * ux + (y - y0) * uy
    end = 0 if along <= 0.0 else (1 if along >= length else -1)
    along = min(max(along, 0.0), length)
    return x - x0 - along * ux, y - y0 - along * uy, end


@step_function
def _counts(walls, joints, w, end, x, y, dx, dy):
    """Whether the end of wall w, seen from (x, y) at (dx, dy), acts for w.

    An end that lies on other walls counts once, and only if it is the closest point of each of them.
    """
    for k in range(joints.shape[2]):
        other = joints[w, end, k]
        if other < 0:
            break
        ox, oy, other_end = _from_segment(
            x, y, walls[other, 0], walls[other, 1], walls[other, 2], walls[other, 3], walls[other, 4]
        )
        if other_end < 0 or other < w or (ox - dx) ** 2 + (oy - dy) ** 2 > 1e-16:
            return False
    return True
