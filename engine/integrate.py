"""The time loop: the integrator's step, exits, lists, and the rules that end a run."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from engine.compiled import step_function
from engine.forces import BLOCK, ROWS, forces
from engine.integrators import begin, correct, lead, predict, settles, share
from engine.laws import turns
from engine.neighbours import nobody_in_touch, rebuilt
from engine.record import sampled
from engine.rest import CREEP, at_rest
from engine.stability import step_limits

FAR = 1e6  # m; whoever is farther from the origin has been thrown out of the world
MOST_PARTS = 64  # into which a step is cut
FIRST_SKIN, LEAST_SKIN = 0.12, 0.01  # m
LIST_COST = 2.4  # of making lists, in visits of all pairs
QUIET_LOOKS = 5  # until rest is tested: forces that do not balance would have set somebody in motion by then
STRIDE = 0.2  # of the smallest radius: how far a person may move in one go
LEAST_ROOM = 0.05  # of the smallest radius; with less left to be pressed through, strides do not get shorter
RUNNING, ALL_OUT, BLOCKED, FROZEN, TIME_LIMIT, UNSTABLE = range(6)


class Rules(NamedTuple):
    """How a run is computed and when it ends."""

    dt: float  # s
    reach: float  # m, largest gap of two persons that interact
    wall_reach: float  # m, of person and wall
    skin: float  # m; 0: adapted
    deepest: float  # m, the smallest radius: overlap at which bodies pass through each other
    lightest: float  # kg, the smallest mass
    turning: float  # see `engine.stability.step_limits`
    last_step: int  # the time limit
    patience: int  # steps without anybody getting out after which the exits are blocked
    look: int  # steps between two looks whether the crowd is at rest for good; 0: never


class Clock(NamedTuple):
    """Where a run stands."""

    step: int  # -1 before the first forces are known
    parts: int  # into which the present step is cut
    piece: int  # of them that are done
    moved: bool  # whether everybody has moved in the present part, so that the forces are due
    unlisted: bool  # whether the lists have to be made before
    inside: int  # persons in the arrays
    N_out: int
    last_out: int  # step at which somebody got out
    outcome: int
    rebuilds: int
    cuts: int  # steps that were cut
    skin: float  # m, of the present lists
    served: int  # for how many forces the present lists have served
    quiet: int  # looks in a row that found everybody as good as at rest
    part: float  # s, length of the present or last part of a step
    overlap: float  # m, largest now
    speed: float  # m/s, largest now
    max_overlap: float  # m, largest ever
    max_speed: float  # m/s
    culprit: int  # person who is pressed or thrown through others, or nowhere; -1: nobody
    partner: int  # the other person of that contact; -1: nobody


def begun(N: int) -> Clock:
    """The clock of N persons before the first forces: a step of no length, which makes the lists."""
    return Clock(-1, 1, 0, True, True, N, 0, 0, RUNNING, 0, 0, 0.0, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, -1, -1)


class Log(NamedTuple):
    """Who left, in the order of leaving; arrays (N,)."""

    time: np.ndarray  # s
    person: np.ndarray
    x: np.ndarray  # m
    y: np.ndarray  # m
    door: np.ndarray  # number of the exit


@njit(cache=True, error_model="numpy")
def advance(integrator, model, scene, rules, people, near, touch, log, tape, clock, until):
    """Advance a run to step `until` or its end.

    `people` and `log` are changed in place; the new lists, contacts, tape and clock are returned. A step that the
    laws do not allow at the present overlap, or in which somebody would move farther than STRIDE, is cut into equal
    parts, into more where somebody may be pressed deeper than half the smallest radius. A run is unstable when somebody
    is nowhere, moves by more than half the smallest radius in a part, or is pressed deeper than that radius into
    another, or than three quarters of it and than it less the way of one part into a wall: nobody can have passed
    through either before.
    """
    scratch, touching = np.empty(ROWS * BLOCK), np.empty(BLOCK + 1, np.uint32)
    while True:
        if clock.unlisted:
            culprit, partner = _first_nowhere(people, clock.inside, near)
            skin = rules.skin if rules.skin > 0.0 else _next_skin(clock, rules)
            n = clock.inside
            if culprit < 0:
                near, n = rebuilt(people, n, scene.walls, near, rules.reach + skin, rules.wall_reach + skin)
                if settles(integrator) and near.i.size + near.wall_i.size > touch.a.size:
                    touch = nobody_in_touch(2 * (near.i.size + near.wall_i.size))
            clock = _listed(clock, n, skin, culprit, partner)
        if clock.outcome != RUNNING or (clock.step >= until and not clock.moved):
            return near, touch, tape, clock
        due = until if tape.stride == 0 else min(until, clock.step - clock.step % tape.stride + tape.stride)
        step = clock.step
        clock = _walk(integrator, model, scene, rules, people, near, touch, log, clock, due, scratch, touching)
        if tape.stride > 0 and clock.step > step and clock.step % tape.stride == 0:
            tape = sampled(integrator, model, tape, scene.walls, people, clock.inside, near, touch, clock.step)


@step_function
def _listed(clock, n, skin, culprit, partner):
    """The clock after the lists were made, or somebody was found nowhere."""
    return Clock(
        clock.step,
        clock.parts,
        clock.piece,
        clock.moved,
        False,
        n,
        clock.N_out,
        clock.last_out,
        UNSTABLE if culprit >= 0 else clock.outcome,
        clock.rebuilds + (culprit < 0),
        clock.cuts,
        skin,
        0,
        clock.quiet,
        clock.part,
        clock.overlap,
        clock.speed,
        clock.max_overlap,
        clock.max_speed,
        culprit,
        partner,
    )


@step_function
def _walk(integrator, model, scene, rules, people, near, touch, log, clock, until, scratch, touching):
    """Go on as long as the lists hold, to step `until` or to the end."""
    step, parts, piece, moved, n = clock.step, clock.parts, clock.piece, clock.moved, clock.inside
    N_out, last_out, outcome, cuts = clock.N_out, clock.last_out, clock.outcome, clock.cuts
    served, quiet, part, overlap, speed = clock.served, clock.quiet, clock.part, clock.overlap, clock.speed
    max_overlap, max_speed, culprit, partner = clock.max_overlap, clock.max_speed, clock.culprit, clock.partner
    unlisted, turning = False, turns(model.rotation)
    while outcome == RUNNING and (moved or step < until):
        if not moved:
            if piece == 0:
                parts = _parts(integrator, model, rules, overlap, speed)
                cuts += parts > 1
            before, part = part, rules.dt / parts
            begin(integrator, model, people, near, touch, n, before, part)
            crossed = _cross(scene.exits, people, n, part, step * rules.dt + piece * part, log, N_out)
            if crossed > 0:
                N_out += crossed
                last_out = step + 1
            _drift(people, n, part)
            predict(integrator, turning, people, n, part)
            moved = True
            someone_walks_on = N_out > people.x.size - n
            unlisted = (someone_walks_on and _gone(scene.exits, people, n) > 0) or _left_their_skin(
                people, n, clock.skin
            )
            if unlisted:
                break
        served += 1
        ahead = lead(integrator) * (part if step >= 0 else rules.dt)
        stretch = part if step >= 0 else ahead
        between, at_wall = forces(integrator, model, scene, people, n, near, touch, stretch, ahead, scratch, touching)
        correct(integrator, turning, people, n, part)
        moved = False
        piece += 1
        way = part * speed
        overlap, speed = max(between, at_wall), math.sqrt(_fastest(people, n))
        way = max(way, part * speed)  # whoever is stopped by a wall was faster before
        max_overlap, max_speed = max(max_overlap, overlap), max(max_speed, speed)
        into_wall = max(0.75 * rules.deepest, rules.deepest - way)
        if part * speed > 0.5 * rules.deepest or between > rules.deepest or at_wall > into_wall:
            culprit, partner = _most_moved(people, n, near)
            outcome = UNSTABLE
        if piece == parts or outcome == UNSTABLE:
            step, piece = step + 1, 0
        if piece > 0 or outcome == UNSTABLE:
            continue
        if N_out == people.x.size:
            outcome = ALL_OUT
        elif scene.exits.shape[0] > 0 and step - last_out >= rules.patience:
            outcome = BLOCKED
        elif step >= rules.last_step:
            outcome = TIME_LIMIT
        elif rules.look > 0 and step % rules.look == 0 and scene.exits.shape[0] > 0:
            wait = (rules.patience - (step - last_out)) * rules.dt
            quiet = quiet + 1 if speed * wait < CREEP else 0
            if quiet >= QUIET_LOOKS and at_rest(model, scene, people, n, near, wait):
                outcome = FROZEN
    return Clock(
        step,
        parts,
        piece,
        moved,
        unlisted,
        n,
        N_out,
        last_out,
        outcome,
        clock.rebuilds,
        cuts,
        clock.skin,
        served,
        quiet,
        part,
        overlap,
        speed,
        max_overlap,
        max_speed,
        culprit,
        partner,
    )


@step_function
def _next_skin(clock, rules):
    """Skin of the next lists, m, at which making lists and visiting the pairs in the skin cost least together.

    The pairs grow as (D + skin)^2, D being the distance at which persons interact, and lists last for
    skin/(2 u) forces, where somebody moves by u between two; making them costs as much as LIST_COST visits of
    all pairs.
    """
    if clock.served == 0:
        return FIRST_SKIN
    distance = 2.0 * rules.deepest + rules.reach
    return min(max(math.sqrt(LIST_COST * distance * clock.skin / (2.0 * clock.served)), LEAST_SKIN), distance)


@step_function
def _parts(integrator, model, rules, overlap, speed):
    """Into how many equal parts the next step must be cut."""
    limits = step_limits(
        model, share(integrator), settles(integrator), overlap, rules.deepest, rules.lightest, rules.turning
    )
    longest = min(min(limits[0], limits[1]), limits[2])
    if speed > 0.0:
        left = rules.deepest - overlap
        room = max(left - speed * rules.dt, LEAST_ROOM * rules.deepest)
        longest = min(longest, min(STRIDE * min(rules.deepest, 2.0 * room), left) / speed)
    parts = 1
    while parts < MOST_PARTS and rules.dt > parts * longest:
        parts *= 2
    return parts


@step_function
def _fastest(people, n):
    """Largest squared speed."""
    fastest = 0.0
    for i in range(n):
        fastest = max(fastest, people.vx[i] ** 2 + people.vy[i] ** 2)
    return fastest


@step_function
def _most_moved(people, n, near):
    """Who is pressed deepest, or fastest where nobody is pressed deeper than half the own radius."""
    culprit, partner, most = np.int64(0), np.int64(-1), 0.5
    for p in range(near.i.size):
        i, j = near.i[p], near.j[p]
        apart = math.hypot(people.x[i] - people.x[j], people.y[i] - people.y[j])
        depth = (people.radius[i] + people.radius[j] - apart) / min(people.radius[i], people.radius[j])
        if depth > most:
            culprit, partner, most = np.int64(i), np.int64(j), depth
    if most == 0.5:
        fastest = 0.0
        for i in range(n):
            if people.vx[i] ** 2 + people.vy[i] ** 2 > fastest:
                culprit, fastest = np.int64(i), people.vx[i] ** 2 + people.vy[i] ** 2
    return people.who[culprit], (people.who[partner] if partner >= 0 else -1)


@step_function
def _cross(lines, people, n, dt, time, log, N_out):
    """Log who will cross an exit in this step, at the time and place interpolated in it; returns how many."""
    x, y, vx, vy, out = people.x, people.y, people.vx, people.vy, people.out
    crossed = 0
    for k in range(lines.shape[0]):
        x0, y0, ux, uy, length = lines[k, 0], lines[k, 1], lines[k, 2], lines[k, 3], lines[k, 4]
        nx, ny = lines[k, 5], lines[k, 6]
        for i in range(n):
            before = (x[i] - x0) * nx + (y[i] - y0) * ny
            after = (x[i] + dt * vx[i] - x0) * nx + (y[i] + dt * vy[i] - y0) * ny
            if before <= 0.0 < after and out[i] == 0:
                part = before / (before - after)
                at_x, at_y = x[i] + part * dt * vx[i], y[i] + part * dt * vy[i]
                if 0.0 <= (at_x - x0) * ux + (at_y - y0) * uy <= length:
                    place = N_out + crossed
                    log.time[place], log.person[place] = time + part * dt, people.who[i]
                    log.x[place], log.y[place], log.door[place] = at_x, at_y, k
                    out[i] = k + 1
                    crossed += 1
    return crossed


@step_function
def _drift(people, n, dt):
    """Move everybody by dt."""
    for i in range(n):
        people.x[i] += dt * people.vx[i]
    for i in range(n):
        people.y[i] += dt * people.vy[i]


@step_function
def _gone(lines, people, n):
    """How many are out, and as far beyond their exit as it lets people walk on; they get `who` = -1."""
    gone = 0
    for i in range(n):
        k = people.out[i] - 1
        if k >= 0:
            beyond = (people.x[i] - lines[k, 0]) * lines[k, 5] + (people.y[i] - lines[k, 1]) * lines[k, 6]
            if beyond >= lines[k, 7]:
                people.who[i] = -1
                gone += 1
    return gone


@step_function
def _left_their_skin(people, n, skin):
    """Whether somebody has moved half the skin since the lists were built, or is nowhere (nan)."""
    moved = False
    for i in range(n):
        dx, dy = people.x[i] - people.listed_x[i], people.y[i] - people.listed_y[i]
        moved |= not (dx * dx + dy * dy <= 0.25 * skin * skin)
    return moved


@njit(cache=True)
def _first_nowhere(people, n, near):
    """Look for somebody whose place is no number, or far outside any scene, and for a neighbour of the same fate.

    Returns (-1, -1) if there is nobody.
    """
    for i in range(n):
        if _nowhere(people.x[i], people.y[i]):
            for p in range(near.i.size):
                a, b = near.i[p], near.j[p]
                if (a == i or b == i) and _nowhere(people.x[a], people.y[a]) and _nowhere(people.x[b], people.y[b]):
                    return people.who[i], people.who[a + b - i]
            return people.who[i], -1
    return -1, -1


@njit(cache=True)
def _nowhere(x, y):
    return not abs(x) + abs(y) < FAR  # true for nan
