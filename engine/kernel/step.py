"""The time loop: the integrator's step, exits, lists, and the rules that end a run."""

import math

from engine.kernel.compiled import entry_point, shared_function
from engine.kernel.forces import forces
from engine.kernel.integrators.interface import begin, correct, history_offset, predict
from engine.kernel.laws import is_present
from engine.kernel.pair_list import rebuild
from engine.kernel.stability import MAX_HALVINGS
from engine.kernel.state import ALL_OUT, BLOCKED, RUNNING, TIME_LIMIT, UNSTABLE

MAX_SUBSTEPS = 2**MAX_HALVINGS
STRIDE = 0.2  # of the smallest radius: how far a person may move in one go
LEAST_ROOM = 0.05  # of the smallest radius; with less left to be pressed through, strides do not get shorter


@entry_point
def advance(integrator, model, scene, parameters, persons, pairs, wall_pairs, contacts, exits, scratch, states, until):
    """Advance a run to step `until`, to its end, or to where its lists need more room; all is changed in place.

    A step that the laws do not allow at the present overlap, or in which somebody would move farther than STRIDE, is
    cut into equal substeps, into more where somebody may be pressed deeper than half the smallest radius. A run is
    unstable when somebody is nowhere, moves by more than half the smallest radius in a substep, or is pressed deeper
    than that radius into another, or than three quarters of it and than it less the way of one substep into a wall:
    nobody can have passed through either before.
    """
    state = states[0]
    while state.outcome == RUNNING and (state.forces_due or state.step < until):
        if not state.forces_due:
            previous = _begin_substep(parameters, state)
            begin(integrator, model, parameters, persons, pairs, wall_pairs, contacts, state, previous, state.dt)
            _move(scene.exits, parameters, persons, exits, state)
            predict(integrator, is_present(model.rotation), persons, state.n, state.dt)
        if state.lists_due:
            rebuild(scene.walls, parameters, persons, pairs, wall_pairs, scratch, state)
            if state.outcome != RUNNING or state.room_needed:
                return
        state.recording = state.step + 1 == until
        state.history_offset = history_offset(integrator) * (state.dt if state.step >= 0 else parameters.dt)
        state.stretch = state.dt if state.step >= 0 else state.history_offset
        between, at_wall = forces(
            integrator, model, scene, parameters, persons, pairs, wall_pairs, contacts, scratch, state
        )
        correct(integrator, is_present(model.rotation), persons, state.n, state.dt)
        _finish_substep(parameters, persons, state, between, at_wall)
        if state.substep == 0:
            _end_if_over(parameters, state, exits.size, scene.exits.size)


@shared_function
def _begin_substep(parameters, state):
    """Set the length of the substep, s; returns that of the one before."""
    if state.substep == 0:
        state.substeps = _substeps(parameters, state.overlap, state.speed)
        state.substepped_steps += state.substeps > 1
    previous = state.dt
    state.dt = parameters.dt / state.substeps
    return previous


@shared_function
def _move(lines, parameters, persons, exits, state):
    """Move everybody by a substep, note who leaves, and see whether the lists still hold."""
    n, dt = state.n, state.dt
    time = state.step * parameters.dt + state.substep * dt
    crossed = _log_exits(lines, persons, n, dt, time, exits, state.N_out)
    if crossed > 0:
        state.N_out += crossed
        state.last_out = state.step + 1
    for i in range(n):
        persons.x[i] += dt * persons.vx[i]
    for i in range(n):
        persons.y[i] += dt * persons.vy[i]
    state.forces_due = True
    someone_walks_on = state.N_out > exits.size - n
    state.lists_due = (someone_walks_on and _mark_gone(lines, persons, n)) or _skin_exceeded(persons, n, state.skin)


@shared_function
def _finish_substep(parameters, persons, state, between, at_wall):
    """Count the substep, and see whether somebody was pressed or thrown through others."""
    state.list_uses += 1
    state.forces_due = False
    state.substep += 1
    way = state.dt * state.speed
    state.overlap, state.speed = max(between, at_wall), math.sqrt(_fastest(persons, state.n))
    way = max(way, state.dt * state.speed)  # whoever is stopped by a wall was faster before
    state.max_overlap, state.max_speed = max(state.max_overlap, state.overlap), max(state.max_speed, state.speed)
    into_wall = max(0.75 * parameters.min_radius, parameters.min_radius - way)
    thrown = state.dt * state.speed > 0.5 * parameters.min_radius
    if thrown or between > parameters.min_radius or at_wall > into_wall:
        state.outcome = UNSTABLE
    if state.substep == state.substeps or state.outcome == UNSTABLE:
        state.step += 1
        state.substep = 0


@shared_function
def _end_if_over(parameters, state, N, exits):
    """End the run where everybody is out, or nobody gets out."""
    if state.outcome == UNSTABLE:
        return
    if state.N_out == N:
        state.outcome = ALL_OUT
    elif exits > 0 and state.step - state.last_out >= parameters.blocked_after:
        state.outcome = BLOCKED
    elif state.step >= parameters.last_step:
        state.outcome = TIME_LIMIT


@shared_function
def _substeps(parameters, overlap, speed):
    """Into how many equal substeps the next step must be cut."""
    longest = math.inf
    if speed > 0.0:
        left = parameters.min_radius - overlap
        room = max(left - speed * parameters.dt, LEAST_ROOM * parameters.min_radius)
        longest = min(STRIDE * min(parameters.min_radius, 2.0 * room), left) / speed
    substeps, k = 1, 0
    while substeps < MAX_SUBSTEPS and (parameters.dt > substeps * longest or overlap > parameters.allowed_overlap[k]):
        substeps *= 2
        k += 1
    return substeps


@shared_function
def _fastest(persons, n):
    """Largest squared speed."""
    fastest = 0.0
    for i in range(n):
        fastest = max(fastest, persons.vx[i] ** 2 + persons.vy[i] ** 2)
    return fastest


@shared_function
def _log_exits(lines, persons, n, dt, time, exits, N_out):
    """Log who will cross an exit in this substep, at the interpolated time and position; returns how many."""
    x, y, vx, vy, exited = persons.x, persons.y, persons.vx, persons.vy, persons.exited
    crossed = 0
    for k in range(lines.size):
        line = lines[k]
        for i in range(n):
            x_i, y_i, dx, dy = x[i], y[i], dt * vx[i], dt * vy[i]
            before = (x_i - line.x0) * line.nx + (y_i - line.y0) * line.ny
            after = (x_i + dx - line.x0) * line.nx + (y_i + dy - line.y0) * line.ny
            if before <= 0.0 < after and exited[i] == 0:
                part = before / (before - after)
                at_x, at_y = x_i + part * dx, y_i + part * dy
                if 0.0 <= (at_x - line.x0) * line.ux + (at_y - line.y0) * line.uy <= line.length:
                    leaving = exits[N_out + crossed]
                    leaving.time, leaving.person, leaving.exit = time + part * dt, persons.person_id[i], k
                    leaving.x, leaving.y = at_x, at_y
                    exited[i] = k + 1
                    crossed += 1
    return crossed


@shared_function
def _mark_gone(lines, persons, n):
    """Mark who is out, and as far beyond their exit as it lets people walk on; whether there is somebody."""
    gone = False
    for i in range(n):
        k = persons.exited[i] - 1
        if k >= 0:
            line = lines[k]
            beyond = (persons.x[i] - line.x0) * line.nx + (persons.y[i] - line.y0) * line.ny
            if beyond >= line.walk_on:
                persons.person_id[i] = -1
                gone = True
    return gone


@shared_function
def _skin_exceeded(persons, n, skin):
    """Whether somebody has moved half the skin since the lists were made, or is nowhere (nan)."""
    moved = False
    for i in range(n):
        dx, dy = persons.x[i] - persons.listed_x[i], persons.y[i] - persons.listed_y[i]
        moved |= not (dx * dx + dy * dy <= 0.25 * skin * skin)
    return moved
