"""The tape of a run: its state and contacts, written by the kernel every so many steps, with room that grows."""

from typing import NamedTuple

import numpy as np
from numba import njit

from engine.integrators.choice import settles
from engine.laws import stiff

ROOM = 1 << 21  # values of each quantity on a new tape, at most; memory that is never written to costs nothing
GROWTH = 2


class Tape(NamedTuple):
    """What was sampled so far; rows and contacts beyond `counts` are room."""

    stride: int  # steps between two samples; 0: nothing is recorded
    contacts: bool  # whether also who touches whom
    whole: bool  # whether also velocities, spins and springs
    counts: np.ndarray  # (2,) int64, samples and contacts so far
    step: np.ndarray  # (samples,) int64
    x: np.ndarray  # (samples, N) m, nan for those who have left
    y: np.ndarray  # (samples, N) m
    vx: np.ndarray  # (samples, N) m/s; (0, N) unless whole, as the next two
    vy: np.ndarray  # (samples, N) m/s
    spin: np.ndarray  # (samples, N) rad/s
    row_size: np.ndarray  # (samples,) int32, contacts of each sample
    contact_i: np.ndarray  # (contacts,) int32
    contact_j: np.ndarray  # (contacts,) int32, -1 - w for wall w
    contact_slip: np.ndarray  # (contacts,) m; (0,) unless whole


def blank(stride: int, contacts: bool, whole: bool, N: int, steps: int) -> Tape:
    """A tape for N persons and a run of so many steps, with nothing on it."""
    rows = min(steps // stride + 1, max(ROOM // N, 1)) if stride else 0
    moving = rows if whole else 0
    found = max(ROOM // 2, 1) if contacts else 0
    return Tape(
        stride,
        contacts,
        whole,
        np.zeros(2, np.int64),
        np.empty(rows, np.int64),
        np.empty((rows, N)),
        np.empty((rows, N)),
        np.empty((moving, N)),
        np.empty((moving, N)),
        np.empty((moving, N)),
        np.empty(rows, np.int32),
        np.empty(found, np.int32),
        np.empty(found, np.int32),
        np.empty(found if whole else 0),
    )


@njit(cache=True, error_model="numpy")
def sampled(integrator, model, tape, walls, people, n, near, touch, step):
    """The tape with the state of the first n persons at this step; a longer one if it was full."""
    k = tape.counts[0]
    if k == tape.step.size:
        tape = _with_more_samples(tape)
    tape.step[k] = step
    _note(tape.x, k, people.x, people.who, n)
    _note(tape.y, k, people.y, people.who, n)
    if tape.whole:
        _note(tape.vx, k, people.vx, people.who, n)
        _note(tape.vy, k, people.vy, people.who, n)
        _note(tape.spin, k, people.spin, people.who, n)
    tape.row_size[k] = 0
    if tape.contacts:
        while tape.counts[1] + near.i.size + near.wall_i.size > tape.contact_i.size:
            tape = _with_more_contacts(tape)
        before = tape.counts[1]
        if settles(integrator) and stiff(model.sliding):  # the last forces have listed who touches whom
            _note_touch(tape, people, near, touch)
        else:
            _note_pairs(tape, people, near)
        _note_walls(tape, walls, people, near)
        tape.row_size[k] = tape.counts[1] - before
    tape.counts[0] = k + 1
    return tape


@njit(cache=True, error_model="numpy")
def _note(rows, k, values, who, n):
    """One quantity of all persons in their order at the start; nan where somebody has left."""
    for i in range(rows.shape[1]):
        rows[k, i] = np.nan
    for i in range(n):
        if who[i] >= 0:  # the gone have no number
            rows[k, who[i]] = values[i]


@njit(cache=True, error_model="numpy")
def _note_pairs(tape, people, near):
    """Persons in touch, r_ij < R_i + R_j (Parisi & Dorso 2005, Eq. 5), from the list of pairs."""
    x, y, radius, who = people.x, people.y, people.radius, people.who
    contact_i, contact_j, count = tape.contact_i, tape.contact_j, tape.counts[1]
    for p in range(near.i.size):
        i, j = near.i[p], near.j[p]
        dx, dy, wide = x[i] - x[j], y[i] - y[j], radius[i] + radius[j]
        if dx * dx + dy * dy < wide * wide and who[i] >= 0 and who[j] >= 0:
            contact_i[count], contact_j[count] = who[i], who[j]
            if tape.whole:
                tape.contact_slip[count] = near.slip[p]
            count += 1
    tape.counts[1] = count


@njit(cache=True, error_model="numpy")
def _note_touch(tape, people, near, touch):
    """The same, from the contacts of the last forces."""
    who, count = people.who, tape.counts[1]
    for t in range(touch.counts[0]):
        i, j = who[touch.a[t]], who[touch.b[t]]
        if i >= 0 and j >= 0:
            tape.contact_i[count], tape.contact_j[count] = i, j
            if tape.whole:
                tape.contact_slip[count] = near.slip[touch.place[t]]
            count += 1
    tape.counts[1] = count


@njit(cache=True, error_model="numpy")
def _note_walls(tape, walls, people, near):
    """Persons whose distance to a wall's nearest point is below their radius, an end of the wall included."""
    count = tape.counts[1]
    for p in range(near.wall_i.size):
        i, w = near.wall_i[p], near.wall[p]
        dx, dy = people.x[i] - walls[w, 0], people.y[i] - walls[w, 1]
        ux, uy = walls[w, 2], walls[w, 3]
        along = min(max(dx * ux + dy * uy, 0.0), walls[w, 4])
        if (dx - along * ux) ** 2 + (dy - along * uy) ** 2 < people.radius[i] ** 2 and people.who[i] >= 0:
            tape.contact_i[count], tape.contact_j[count] = people.who[i], -1 - np.int64(w)
            if tape.whole:
                tape.contact_slip[count] = near.wall_slip[p]
            count += 1
    tape.counts[1] = count


@njit(cache=True)
def _with_more_samples(tape):
    return Tape(
        tape.stride,
        tape.contacts,
        tape.whole,
        tape.counts,
        _longer(tape.step),
        _longer_rows(tape.x),
        _longer_rows(tape.y),
        _longer_rows(tape.vx),
        _longer_rows(tape.vy),
        _longer_rows(tape.spin),
        _longer(tape.row_size),
        tape.contact_i,
        tape.contact_j,
        tape.contact_slip,
    )


@njit(cache=True)
def _with_more_contacts(tape):
    return Tape(
        tape.stride,
        tape.contacts,
        tape.whole,
        tape.counts,
        tape.step,
        tape.x,
        tape.y,
        tape.vx,
        tape.vy,
        tape.spin,
        tape.row_size,
        _longer(tape.contact_i),
        _longer(tape.contact_j),
        _longer(tape.contact_slip),
    )


@njit(cache=True)
def _longer(full):
    longer = np.empty(GROWTH * full.size, full.dtype)
    longer[: full.size] = full
    return longer


@njit(cache=True)
def _longer_rows(full):
    longer = np.empty((GROWTH * full.shape[0], full.shape[1]), full.dtype)
    longer[: full.shape[0]] = full
    return longer
