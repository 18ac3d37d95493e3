"""The time loop: the integrator's step, exits, lists, and the rules that end a run."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from engine.forces import BLOCK, ROWS, forces
from engine.integrators import correct, lead, predict
from engine.integrators.choice import kick
from engine.laws import turns
from engine.neighbours import rebuilt

FAR = 1e6  # m; whoever is farther from the origin has been thrown out of the world
RUNNING, ALL_OUT, BLOCKED, FROZEN, TIME_LIMIT, UNSTABLE = range(6)


class Rules(NamedTuple):
    """How a run is computed and when it ends."""

    dt: float  # s
    reach: float  # m, largest gap of two persons that interact
    wall_reach: float  # m, of person and wall
    skin: float  # m
    deepest: float  # m, the smallest radius: overlap at which bodies pass through each other
    last_step: int  # the time limit
    patience: int  # steps without anybody getting out after which the exits are blocked


class Clock(NamedTuple):
    """Where a run stands."""

    step: int  # -1 before the first forces are known
    inside: int  # persons in the arrays
    N_out: int
    last_out: int  # step at which somebody got out
    outcome: int
    rebuilds: int
    max_overlap: float  # m
    max_speed: float  # m/s
    culprit: int  # person who is nowhere; -1: none


class Log(NamedTuple):
    """Who left, in the order of leaving; arrays (N,)."""

    time: np.ndarray  # s
    person: np.ndarray
    x: np.ndarray  # m
    y: np.ndarray  # m
    door: np.ndarray  # number of the exit


@njit(cache=True, error_model="numpy")
def advance(integrator, model, scene, rules, people, near, log, clock, until):
    """Advance a run to step `until` or its end.

    `people` and `log` are changed in place; the new lists and clock are returned. A run begins with a step
    of no length, which makes the lists and the first forces. It is unstable when somebody is nowhere, moves by
    more than half the smallest radius in a step, or is pressed deeper than that radius into another, or than
    three quarters of it into a wall: nobody can have passed through either before.
    """
    step, n, turning = clock.step, clock.inside, turns(model.rotation)
    N_out, last_out, outcome, rebuilds = clock.N_out, clock.last_out, clock.outcome, clock.rebuilds
    max_overlap, max_speed_squared, culprit = clock.max_overlap, clock.max_speed**2, clock.culprit
    scratch, touching = np.empty(ROWS * BLOCK), np.empty(BLOCK + 1, np.uint32)
    gap, wall_gap = rules.reach + rules.skin, rules.wall_reach + rules.skin
    while step < until and outcome == RUNNING:
        dt = rules.dt if step >= 0 else 0.0
        kick(turning, people, n, 0.5 * dt)
        crossed = _cross(scene.exits, people, n, dt, step, log, N_out)
        _drift(people, n, dt)
        predict(integrator, turning, people, n, dt)
        step += 1
        if crossed > 0:
            N_out += crossed
            last_out = step
        someone_walks_on = N_out > people.x.size - n
        if (someone_walks_on and _gone(scene.exits, people, n)) or _left_their_skin(people, n, rules.skin):
            culprit = _first_nowhere(people, n)
            if culprit >= 0:
                outcome = UNSTABLE
                break
            moved_to, n = _compacted(people, n)
            near = rebuilt(people, n, scene.walls, near, moved_to, gap, wall_gap)
            rebuilds += 1
        ahead = lead(integrator) * rules.dt
        stretch = dt if step > 0 else ahead
        overlap, at_wall = forces(model, scene, people, n, near, stretch, ahead, scratch, touching)
        correct(integrator, turning, people, n, dt)
        max_overlap = max(max_overlap, overlap, at_wall)
        max_speed_squared = max(max_speed_squared, _fastest(people, n))
        too_fast = dt * dt * max_speed_squared > 0.25 * rules.deepest**2
        if too_fast or overlap > rules.deepest or at_wall > 0.75 * rules.deepest:
            culprit = _most_moved(people, n, near)
            outcome = UNSTABLE
            break
        if N_out == people.x.size:
            outcome = ALL_OUT
        elif scene.exits.shape[0] > 0 and step - last_out >= rules.patience:
            outcome = BLOCKED
        elif step >= rules.last_step:
            outcome = TIME_LIMIT
    max_speed = np.sqrt(max_speed_squared)
    return near, Clock(step, n, N_out, last_out, outcome, rebuilds, max_overlap, max_speed, culprit)


@njit(cache=True, error_model="numpy")
def _fastest(people, n):
    """Largest squared speed."""
    fastest = 0.0
    for i in range(n):
        fastest = max(fastest, people.vx[i] ** 2 + people.vy[i] ** 2)
    return fastest


@njit(cache=True, error_model="numpy")
def _most_moved(people, n, near):
    """Who is pressed deepest, or fastest where nobody is pressed deeper than half the own radius."""
    culprit, most = np.int64(0), 0.5
    for p in range(near.i.size):
        i, j = near.i[p], near.j[p]
        apart = math.hypot(people.x[i] - people.x[j], people.y[i] - people.y[j])
        depth = (people.radius[i] + people.radius[j] - apart) / min(people.radius[i], people.radius[j])
        if depth > most:
            culprit, most = np.int64(i), depth
    if most == 0.5:
        fastest = 0.0
        for i in range(n):
            if people.vx[i] ** 2 + people.vy[i] ** 2 > fastest:
                culprit, fastest = np.int64(i), people.vx[i] ** 2 + people.vy[i] ** 2
    return people.who[culprit]


@njit(cache=True, error_model="numpy")
def _cross(lines, people, n, dt, step, log, N_out):
    """Log who will cross an exit in this step, at the time and place interpolated in it; returns how many.

    No helper functions in this loop: a call with arrays counts references, which costs more than the work.
    """
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
                    log.time[place], log.person[place] = (step + part) * dt, people.who[i]
                    log.x[place], log.y[place], log.door[place] = at_x, at_y, k
                    out[i] = k + 1
                    crossed += 1
    return crossed


@njit(cache=True, error_model="numpy")
def _drift(people, n, dt):
    """Move everybody by dt."""
    for i in range(n):
        people.x[i] += dt * people.vx[i]
    for i in range(n):
        people.y[i] += dt * people.vy[i]


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def _left_their_skin(people, n, skin):
    """Whether somebody has moved half the skin since the lists were built, or is nowhere (nan)."""
    moved = False
    for i in range(n):
        dx, dy = people.x[i] - people.listed_x[i], people.y[i] - people.listed_y[i]
        moved |= not (dx * dx + dy * dy <= 0.25 * skin * skin)
    return moved


@njit(cache=True)
def _first_nowhere(people, n):
    """Look for somebody whose place is no number, or far outside any scene; -1: nobody."""
    for i in range(n):
        if not abs(people.x[i]) + abs(people.y[i]) < FAR:  # true for nan
            return people.who[i]
    return -1


@njit(cache=True, error_model="numpy")
def _compacted(people, n):
    """Close the gaps that the gone leave; returns everybody's new number (-1: gone) and how many stay."""
    moved_to, stay = np.empty(n, np.int64), 0
    for i in range(n):
        if people.who[i] < 0:
            moved_to[i] = -1
            continue
        moved_to[i] = stay
        if stay != i:
            _move(people, i, stay)
        stay += 1
    return moved_to, stay


@njit(cache=True)
def _move(people, i, to):
    people.who[to], people.out[to] = people.who[i], people.out[i]
    people.x[to], people.y[to] = people.x[i], people.y[i]
    people.vx[to], people.vy[to], people.spin[to] = people.vx[i], people.vy[i], people.spin[i]
    people.radius[to], people.mass[to], people.inertia[to] = people.radius[i], people.mass[i], people.inertia[i]
    people.v_d[to] = people.v_d[i]
    people.fx_before[to], people.fy_before[to] = people.fx_before[i], people.fy_before[i]
    people.torque_before[to] = people.torque_before[i]
