"""The one place where laws meet pairs of persons and walls.

Pairs are taken in blocks that fit the first-level cache, each block in four plain loops: gather, arithmetic that the
compiler vectorises, scatter, and one that lists the few pairs that touch. The listed contacts then get their forces.
"""

import math

from engine.kernel.compiled import inlined_function, step_function
from engine.kernel.contacts import (
    add_to_sums,
    end_acts,
    extrapolated_velocity,
    from_closest_point,
    push,
    relative_velocity,
    slip_of_turning,
)
from engine.kernel.guidance import aim
from engine.kernel.integrators.interface import solves_contacts
from engine.kernel.laws import anisotropy, drive, friction, has_history, is_present, normal, social
from engine.kernel.laws.friction import needs_implicit
from engine.kernel.state import BLOCK

TINY = 1e-300  # m/s
AWAY = 1e9  # m, out of the reach of any law


@step_function
def forces(integrator, model, scene, parameters, persons, pairs, wall_pairs, contacts, scratch, state):
    """Sum all forces and torques into `persons`, and list the contacts with theirs.

    For an integrator that solves contacts itself: neither the drive nor what depends on velocity in contacts whose
    friction needs it.

    Returns
    -------
    float, float
        Largest overlap of two persons, of a person and a wall, m.
    """
    s, tolerance, rotating = scratch.block, parameters.force_tolerance, is_present(model.rotation)
    aim(scene.exits, persons, state.n, s)
    _driving_forces(integrator, model, persons, state.n)
    state.contacts = state.wall_contacts = 0
    for first in range(0, state.pairs, BLOCK):
        count = min(BLOCK, state.pairs - first)
        social_forces(model, tolerance, persons, pairs, first, count, s)
        _list_contacts(model.friction, persons, pairs, contacts, first, count, scratch, state, False)
    for first in range(0, state.wall_pairs, BLOCK):
        count = min(BLOCK, state.wall_pairs - first)
        _wall_social_forces(model, tolerance, scene, persons, wall_pairs, first, count, s)
        _list_contacts(model.wall_friction, persons, wall_pairs, contacts, first, count, scratch, state, True)
    n, every, p, w = state.contacts, state.contacts + state.wall_contacts, pairs.history, wall_pairs.history
    return (
        _contact_forces(model.friction, model.normal, integrator, rotating, persons, contacts, 0, n, p, state, 0),
        _contact_forces(
            model.wall_friction, model.wall_normal, integrator, rotating, persons, contacts, n, every, w, state, 1
        ),
    )


@inlined_function
def _driving_forces(integrator, model, persons, n):
    """Start the sums with the driving force."""
    if solves_contacts(integrator):
        for i in range(n):
            persons.fx[i], persons.fy[i] = 0.0, 0.0
    else:
        for i in range(n):
            persons.fx[i] = drive(model.drive, persons.mass[i], persons.v_d[i], persons.ex[i], persons.vx[i])
        for i in range(n):
            persons.fy[i] = drive(model.drive, persons.mass[i], persons.v_d[i], persons.ey[i], persons.vy[i])
    for i in range(n):
        persons.torque[i] = 0.0


@step_function
def social_forces(model, tolerance, persons, pairs, first, count, s):
    """Social forces of a block of pairs; leaves n_x, n_y and the gap of each in the first three rows of `s`."""
    _gather(model, persons, pairs.i[first:], pairs.j[first:], count, s)
    for p in range(count):
        dx, dy = s[p], s[BLOCK + p]
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        nx, ny = dx * inverse, dy * inverse
        gap = distance - s[2 * BLOCK + p]
        force = max(social(model.social, gap) - tolerance, 0.0)
        on_i = force * anisotropy(model.anisotropy, -(s[3 * BLOCK + p] * nx + s[4 * BLOCK + p] * ny))
        on_j = force * anisotropy(model.anisotropy, s[5 * BLOCK + p] * nx + s[6 * BLOCK + p] * ny)
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = nx, ny, gap
        s[3 * BLOCK + p], s[4 * BLOCK + p] = on_i, on_j
    _scatter(persons, pairs.i[first:], pairs.j[first:], count, s)


@inlined_function
def _gather(model, persons, i, j, count, s):
    """Bring a block's positions, radii and desired directions together; those of one i are read once."""
    x, y, radius, ex, ey = persons.x, persons.y, persons.radius, persons.ex, persons.ey
    of = i[0]
    x_i, y_i, radius_i, ex_i, ey_i = x[of], y[of], radius[of], ex[of], ey[of]
    for p in range(count):
        if i[p] != of:
            of = i[p]
            x_i, y_i, radius_i, ex_i, ey_i = x[of], y[of], radius[of], ex[of], ey[of]
        k = j[p]
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = x_i - x[k], y_i - y[k], radius_i + radius[k]
        if is_present(model.anisotropy):
            s[3 * BLOCK + p], s[4 * BLOCK + p], s[5 * BLOCK + p], s[6 * BLOCK + p] = ex_i, ey_i, ex[k], ey[k]


@inlined_function
def _scatter(persons, i, j, count, s):
    """Add the social forces; those of one i are summed in registers, since its pairs stand together."""
    fx, fy = persons.fx, persons.fy
    of, sum_x, sum_y = i[0], 0.0, 0.0
    for p in range(count):
        if i[p] != of:
            fx[of] += sum_x
            fy[of] += sum_y
            of, sum_x, sum_y = i[p], 0.0, 0.0
        nx, ny = s[p], s[BLOCK + p]
        on_i, on_j, k = s[3 * BLOCK + p], s[4 * BLOCK + p], j[p]
        sum_x += on_i * nx
        sum_y += on_i * ny
        fx[k] -= on_j * nx
        fy[k] -= on_j * ny
    fx[of] += sum_x
    fy[of] += sum_y


@inlined_function
def _wall_social_forces(model, tolerance, scene, persons, pairs, first, count, s):
    """The same of persons and walls, bodies of infinite mass and radius, each acting through its closest point."""
    i, wall, walls, joints = pairs.i[first:], pairs.j[first:], scene.walls, scene.joints
    for p in range(count):
        k, w = i[p], wall[p]
        x, y = persons.x[k], persons.y[k]
        dx, dy, end = from_closest_point(walls, w, x, y)
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = dx, dy, persons.radius[k]
        if end >= 0 and joints[w, end, 0] >= 0 and not end_acts(walls, joints, w, end, x, y, dx, dy):
            s[2 * BLOCK + p] = -AWAY
    for p in range(count):
        dx, dy = s[p], s[BLOCK + p]
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        gap = distance - s[2 * BLOCK + p]
        s[p], s[BLOCK + p], s[2 * BLOCK + p] = dx * inverse, dy * inverse, gap
        s[3 * BLOCK + p] = max(social(model.wall_social, gap) - tolerance, 0.0)
    for p in range(count):
        k, force = i[p], s[3 * BLOCK + p]
        persons.fx[k] += force * s[p]
        persons.fy[k] += force * s[BLOCK + p]


@step_function
def _list_contacts(friction_law, persons, pairs, contacts, first, count, scratch, state, at_walls):
    """List the pairs of a block that touch, those at walls behind the others; the histories of the rest end."""
    s, touching, history, number = scratch.block, scratch.touching, pairs.history[first : first + count], 0
    for p in range(count):  # without a branch: most pairs do not touch
        touching[number] = p
        number += s[2 * BLOCK + p] < 0.0
    if is_present(friction_law):
        for p in range(count):
            history[p] = history[p] if s[2 * BLOCK + p] < 0.0 else 0.0
    for t in range(number):
        p = touching[t]
        i, j, c = pairs.i[first + p], pairs.j[first + p], contacts[state.contacts + state.wall_contacts]
        r, m = persons.radius[i], persons.mass[i]
        c.i, c.entry, c.nx, c.ny, c.overlap = i, first + p, s[p], s[BLOCK + p], -s[2 * BLOCK + p]
        if at_walls:
            c.j, c.wall, c.radius, c.mass = i, j, r, m
            state.wall_contacts += 1
        else:
            r_j, m_j = persons.radius[j], persons.mass[j]
            c.j, c.wall, c.radius, c.mass = j, -1, r * r_j / (r + r_j), m * m_j / (m + m_j)
            state.contacts += 1


@step_function
def _contact_forces(
    friction_law, normal_law, integrator, rotating, persons, contacts, first, last, history, state, at_walls
):
    """Normal and tangential forces of listed contacts; returns the largest overlap."""
    deepest = 0.0
    for k in range(first, last):
        c = contacts[k]
        overlap, radius, mass = c.overlap, c.radius, c.mass
        deepest = max(deepest, overlap)
        v_n, v_t = relative_velocity(persons, c, rotating)
        if solves_contacts(integrator) and needs_implicit(friction_law):
            c.F_elastic = normal(normal_law, overlap, radius, mass, 0.0)
            c.damping = c.F_elastic - normal(normal_law, overlap, radius, mass, 1.0)
            c.v_n, c.v_t, c.slip = v_n, v_t, v_t
            push(persons, c, c.F_elastic, 0.0)
            if state.recording:
                c.F_n = normal(normal_law, overlap, radius, mass, v_n)
                c.F_t, _ = friction(friction_law, overlap, radius, mass, v_t, c.F_n, 0.0)
        else:
            ahead = state.history_offset * v_t
            acting = history[c.entry] + v_t * state.stretch - ahead
            if solves_contacts(integrator):
                lasts = min(state.stretch, overlap / max(-v_n, TINY))  # what a contact made in this step has lasted
                acting += v_t * (lasts - state.stretch)
                acting += 0.5 * lasts**2 * slip_of_turning(persons, c, rotating, v_n, v_t)
                v_n, v_t = extrapolated_velocity(persons, c, rotating, v_n, v_t, state.extrapolation)
            c.F_n = normal(normal_law, overlap, radius, mass, v_n)
            c.F_t, left = friction(friction_law, overlap, radius, mass, v_t, c.F_n, acting)
            if has_history(friction_law):
                history[c.entry] = left + ahead
            push(persons, c, c.F_n, c.F_t)
            add_to_sums(state, at_walls, c.F_t * state.dt, c.F_n * state.dt, v_t)
    return deepest
