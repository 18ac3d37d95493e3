"""State of a run: persons, pairs, contacts, exits passed, and how far it is; all changed in place."""

from typing import Any, NamedTuple

import numba
import numpy as np

BLOCK = 512  # pairs; a constant, so that the compiler sees that the rows of a block do not overlap
ROWS = 7  # of a block: dx, dy, r_i + r_j, desired directions of i and j
PAIRS_EACH, WALLS_EACH = 16, 2  # for so many pairs a person there is room at first
RUNNING, ALL_OUT, BLOCKED, FROZEN, TIME_LIMIT, UNSTABLE = range(6)


class Persons(NamedTuple):
    """State of the persons, each an array (N,); the first n are in the scene, sorted by cell."""

    person_id: np.ndarray  # number of the person at the start; -1: gone
    exited: np.ndarray  # number of the exit that the person has crossed, from 1; 0: inside
    x: np.ndarray  # m
    y: np.ndarray  # m
    vx: np.ndarray  # m/s
    vy: np.ndarray  # m/s
    spin: np.ndarray  # rad/s
    radius: np.ndarray  # m
    mass: np.ndarray  # kg
    v_d: np.ndarray  # m/s
    inv_mass: np.ndarray  # 1/kg
    inv_inertia: np.ndarray  # 1/(kg m^2), 0 where nobody rotates
    previous_x: np.ndarray  # of the step before, what the integrator keeps: forces (N, N m) or velocities (m/s, rad/s)
    previous_y: np.ndarray
    previous_spin: np.ndarray
    fx: np.ndarray  # N
    fy: np.ndarray  # N
    torque: np.ndarray  # N m
    ex: np.ndarray  # desired direction
    ey: np.ndarray
    listed_x: np.ndarray  # m, position when the lists were made
    listed_y: np.ndarray


MOVED_TOGETHER = Persons._fields.index("previous_spin") + 1  # fields that follow a person when persons are sorted


class PairList(NamedTuple):
    """Pairs of persons, or of persons and walls, that can interact before the next list; how many: `RunState`."""

    i: np.ndarray  # (room,) uint32: an unsigned index costs no test for a negative one
    j: np.ndarray  # (room,) uint32, the other person, j > i, or the wall
    history: np.ndarray  # (room,) displacement of the tangential spring, m; F_t/F_n where friction is solved for
    carried: np.ndarray  # (room,) HISTORY, from one list to the next


HISTORY = np.dtype([("i", np.int64), ("j", np.int64), ("value", np.float64)])

CONTACT = np.dtype(
    [
        ("i", np.uint32),  # person
        ("j", np.uint32),  # the other person; i at a wall
        ("wall", np.int32),  # -1 between persons
        ("entry", np.uint32),  # of the pair in its list
        ("nx", np.float64),  # from j, or the wall, to i
        ("ny", np.float64),
        ("overlap", np.float64),  # m
        ("radius", np.float64),  # m, reduced
        ("mass", np.float64),  # kg, reduced
        ("F_n", np.float64),  # N, normal and
        ("F_t", np.float64),  # N, tangential force
        ("F_elastic", np.float64),  # N, normal force without damping; this and what follows for solved contacts
        ("damping", np.float64),  # kg/s, of the normal force
        ("v_n", np.float64),  # m/s, velocity at which the bodies part, and
        ("v_t", np.float64),  # m/s, slip velocity before the contacts are solved
        ("inv_mass_n", np.float64),  # 1/kg, change of these by a unit impulse
        ("inv_mass_t", np.float64),  # 1/kg
        ("theta", np.float64),  # weight of the new slip velocity
        ("J_n", np.float64),  # N s, impulse of damping along n
        ("J_t", np.float64),  # N s, impulse of friction along t
        ("slip", np.float64),  # m/s, slip velocity at which friction acts
    ],
    align=True,
)

EXIT = np.dtype(
    [("time", np.float64), ("person", np.int64), ("x", np.float64), ("y", np.float64), ("exit", np.int64)], align=True
)

RUN_STATE = np.dtype(
    [
        ("step", np.int64),  # -1 before the first forces are known
        ("substeps", np.int64),  # of the present step
        ("substep", np.int64),  # how many of them are done
        ("forces_due", np.bool_),  # everybody has moved in the present substep
        ("lists_due", np.bool_),
        ("room_needed", np.bool_),  # the lists are full, and wait for larger ones
        ("outcome", np.int64),
        ("n", np.int64),  # persons in the scene
        ("N_out", np.int64),
        ("last_out", np.int64),  # step at which somebody got out
        ("pairs", np.int64),
        ("wall_pairs", np.int64),
        ("carried", np.int64),  # histories, to the next list
        ("wall_carried", np.int64),
        ("contacts", np.int64),  # between persons; those at walls follow
        ("wall_contacts", np.int64),
        ("rebuilds", np.int64),  # of the lists
        ("substepped_steps", np.int64),
        ("list_uses", np.int64),  # forces that the present lists have served
        ("skin", np.float64),  # m, of the present lists
        ("dt", np.float64),  # s, length of the present or last substep
        ("stretch", np.float64),  # s, time over which tangential springs stretch
        ("history_offset", np.float64),  # s, by which springs are kept ahead of the slip that acts
        ("extrapolation", np.float64),  # of velocities to the end of a step, over their last change
        ("recording", np.bool_),  # the forces of solved contacts are wanted as well
        ("overlap", np.float64),  # m, largest now
        ("speed", np.float64),  # m/s, largest now
        ("max_overlap", np.float64),  # m, largest ever
        ("max_speed", np.float64),  # m/s
        # Sums over contacts and steps, first between persons, then at walls: impulses of friction and of normal forces,
        # N s, and each times the slip speed, N m
        ("contact_sums", np.float64, (2, 4)),
    ],
    align=True,
)


class StepParameters(NamedTuple):
    """How a run is computed and when it ends."""

    dt: float  # s
    cutoff: float  # m, largest gap of two persons that interact
    wall_cutoff: float  # m, of person and wall
    force_tolerance: float  # N, subtracted from the social force, so that it ends without a jump
    solver_tolerance: float  # m/s, change of velocities at which contacts count as solved
    skin: float  # m; 0: adapted
    min_radius: float  # m: overlap at which bodies pass through each other
    allowed_overlap: np.ndarray  # (7,) m: up to which a step stands that is cut into 1, 2, 4 ... 64 substeps
    last_step: int  # the time limit
    blocked_after: int  # steps without anybody getting out


class Scratch(NamedTuple):
    """Room for intermediate values."""

    block: np.ndarray  # (ROWS * BLOCK,)
    touching: np.ndarray  # (BLOCK + 1,) uint32
    numbers: np.ndarray  # (N,) one value of every person
    ids: np.ndarray  # (N,) int64
    cell: np.ndarray  # (N,) int64
    moved_to: np.ndarray  # (N,) int64
    cell_start: np.ndarray  # (12 N + 64,) int64
    pair_start: np.ndarray  # (N + 1,) int64
    near_wall: np.ndarray  # (walls, N) uint8


def records(count: int, dtype: np.dtype) -> np.ndarray:
    """So many records of zeros, whose fields are attributes in compiled code and in plain Python."""
    zeros = np.zeros(count, dtype)
    return zeros.view(np.recarray) if numba.config.DISABLE_JIT else zeros  # type: ignore[attr-defined]  # set by name


def new_persons(start: Any, inertia: np.ndarray) -> Persons:
    """Everybody of a crowd at the start."""
    N = start.x.size
    state: dict[str, np.ndarray] = {name: np.zeros(N) for name in Persons._fields}
    state |= {name: value.copy() for name, value in start._asdict().items()}
    state |= {"person_id": np.arange(N), "exited": np.zeros(N, np.int64)}
    state |= {"previous_x": start.vx.copy(), "previous_y": start.vy.copy(), "previous_spin": start.spin.copy()}
    state |= {"inv_mass": 1.0 / start.mass, "inv_inertia": 1.0 / inertia}
    return Persons(**state | {"listed_x": np.full(N, np.nan), "listed_y": np.full(N, np.nan)})


def empty_pair_list(room: int) -> PairList:
    """Room for so many pairs."""
    return PairList(np.empty(room, np.uint32), np.empty(room, np.uint32), np.zeros(room), records(room, HISTORY))


def larger_pair_list(pairs: PairList) -> PairList:
    """Twice the room, with the histories that wait to be carried on."""
    larger = empty_pair_list(2 * pairs.i.size)
    larger.carried[: pairs.carried.size] = pairs.carried
    return larger


def empty_contact_list(pairs: PairList, wall_pairs: PairList) -> np.ndarray:
    """Room for the contacts of lists of pairs."""
    return records(pairs.i.size + wall_pairs.i.size, CONTACT)


def initial_state(N: int) -> np.ndarray:
    """Before the first forces of N persons: a step of no length, which makes the lists; (1,) RUN_STATE."""
    state = records(1, RUN_STATE)
    for name, value in {"step": -1, "substeps": 1, "forces_due": True, "lists_due": True, "n": N}.items():
        state[name] = value
    return state


def new_scratch(N: int, walls: int) -> Scratch:
    """Scratch for N persons among so many walls."""
    ids, cell, moved_to = (np.empty(N, np.int64) for _ in range(3))
    starts = np.empty(12 * N + 64, np.int64), np.empty(N + 1, np.int64)
    block = np.empty(ROWS * BLOCK), np.empty(BLOCK + 1, np.uint32)
    return Scratch(*block, np.empty(N), ids, cell, moved_to, *starts, np.empty((walls, N), np.uint8))
