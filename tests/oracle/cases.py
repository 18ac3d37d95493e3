"""Collisions that `jamsweep` and LAMMPS must both compute alike.

A case is a plain dictionary in SI units, ready for ``json.dump``:

========================  ==========================================================
``name``                  unique label
``x, y, vx, vy, spin``    initial state, one entry per disc (spin counter-clockwise)
``radius, mass``          one entry per disc; the moment of inertia is 0.4 m r^2
``k_n, k_t``              spring constants (Pa)
``g_n, g_t``              damping constants (1/(m s))
``mu``                    Coulomb friction coefficient
``box``                   four plane walls ``[x0, x1, y0, y1]``, or None
``dt, t_end``             time step and duration (s)
``sample_times``          times at which the state is compared (s), the last is t_end
========================  ==========================================================

The law of contact, for the overlap ``d`` of two discs, is that of the LAMMPS
command ``pair_style gran/hertz/history``::

    a   = sqrt(d R),  R = r_i r_j / (r_i + r_j),  m = m_i m_j / (m_i + m_j)
    F_n =  a (k_n d - m g_n v_n)
    F_t = -a (k_t s + m g_t v_t),  |F_t| <= mu |F_n|

A wall is a disc of infinite radius and mass at rest: ``R = r_i`` and ``m = m_i``.
There is no drive and no social force.
"""

import numpy as np

Pair = tuple[float, float]

LAW = {"k_n": 3.5556e6, "k_t": 4.5714e6, "g_n": 0.8, "g_t": 0.8, "mu": 0.5}
BOX = [0.0, 4.0, 0.0, 4.0]
DT = 1e-5
# Deliberately not a multiple of any time step: the first touching step is the same for every code.
TOUCH_TIME = 0.0300043
PAIR_SAMPLES = [0.02, 0.04, 0.05, 0.06, 0.07, 0.08, 0.1, 0.15, 0.25]
WALL_SAMPLES = [0.02, 0.04, 0.05, 0.06, 0.08, 0.1, 0.15, 0.2, 0.3]


def pair_case(
    name: str,
    radius: Pair,
    mass: Pair,
    velocities: tuple[Pair, Pair],
    spin: Pair = (0.0, 0.0),
    angle: float = 0.3,
    **law: float,
) -> dict:
    """Two discs that first touch at (2 m, 2 m), ``TOUCH_TIME`` after the start.

    Parameters
    ----------
    name : str
        Label of the case.
    radius, mass, spin : pair of float
        Properties of the two discs.
    velocities : pair of (float, float)
        Velocity of each disc along the line of centres (from the first disc
        to the second, at the moment of touch) and across it.
    angle : float
        Direction of the line of centres at the moment of touch (rad).
    **law
        Constants that differ from ``LAW``.
    """
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-np.sin(angle), np.cos(angle)])
    velocity = np.array(velocities) @ np.array([along, across])
    touching = 2.0 + np.outer([-radius[0], radius[1]], along)
    start = touching - TOUCH_TIME * velocity
    return _case(name, start, velocity, spin, radius, mass, None, PAIR_SAMPLES, **law)


def oblique(speed: float, degrees: float) -> tuple[Pair, Pair]:
    """Opposite velocities of two discs that meet at an angle to their line of centres.

    Parameters
    ----------
    speed : float
        Relative speed (m/s).
    degrees : float
        Angle between relative velocity and line of centres; 0 is head-on.
    """
    along = 0.5 * speed * float(np.cos(np.radians(degrees)))
    across = 0.5 * speed * float(np.sin(np.radians(degrees)))
    return (along, across), (-along, -across)


def two_body_cases() -> list[dict]:
    """Collisions of two discs: head-on, sticking, sliding, spinning and damped."""
    same = {"radius": (0.3, 0.3), "mass": (70.0, 70.0)}
    small_large = {"radius": (0.25, 0.35), "mass": (60.0, 80.0)}
    damped = {"g_n": 2000.0, "g_t": 2000.0}
    other_law = {"k_t": 2.0e6, "g_n": 1500.0, "g_t": 400.0, "mu": 0.3}
    return [
        pair_case("head_on_equal", **same, velocities=oblique(1.0, 0)),
        pair_case("head_on_unequal", **small_large, velocities=((0.7, 0), (-0.5, 0)), g_n=500.0, g_t=500.0),
        pair_case("oblique_sticking", **same, velocities=oblique(1.0, 20)),
        pair_case("oblique_sliding", **same, velocities=oblique(1.0, 76), angle=2.0),
        pair_case("oblique_unequal", **small_large, velocities=((1.0, 0.6), (0, 0)), angle=-1.0),
        pair_case("spinning", **small_large, velocities=oblique(1.0, 0), spin=(4.0, -1.5), angle=4.0),
        pair_case("top_spin", **same, velocities=oblique(1.2, 45), spin=(3.0, 5.0)),
        pair_case("strong_damping", **same, velocities=oblique(1.0, 40), **damped),
        pair_case("other_law", **small_large, velocities=oblique(1.5, 25), **other_law),
    ]


def wall_cases() -> list[dict]:
    """Collisions of a single disc with the walls of a square room."""
    return [
        wall_case("wall_head_on", (0.35, 2.0), (-1.0, 0.0)),
        wall_case("wall_oblique", (2.0, 3.65), (0.5, 0.9), spin=-2.0),
        wall_case("wall_grazing", (3.66, 1.0), (0.3, -1.0)),
        wall_case("wall_corner", (3.63, 0.44), (0.8, -1.0), spin=3.0, g_n=1500.0, g_t=500.0),
    ]


def wall_case(name: str, position: Pair, velocity: Pair, spin: float = 0.0, **law: float) -> dict:
    """One disc, of radius 0.3 m and mass 70 kg, in a room of 4 m by 4 m.

    Parameters
    ----------
    name : str
        Label of the case.
    position, velocity : (float, float)
        Initial centre (m) and velocity (m/s).
    spin : float
        Initial angular velocity (rad/s).
    **law
        Constants that differ from ``LAW``.
    """
    state = np.array([position]), np.array([velocity]), np.array([spin])
    return _case(name, *state, np.array([0.3]), np.array([70.0]), BOX, WALL_SAMPLES, **law)


def crowd_case(seed: int = 7) -> dict:
    """Thirty discs of random size, velocity and spin in a room of 4 m by 4 m."""
    rng = np.random.default_rng(seed)
    start = staggered_rows() + rng.uniform(-0.01, 0.01, (30, 2))
    heading, speed = rng.uniform(0, 2 * np.pi, 30), rng.uniform(0.7, 1.3, 30)
    velocity = np.column_stack([speed * np.cos(heading), speed * np.sin(heading)])
    spin = rng.uniform(-3, 3, 30)
    radius, mass = rng.uniform(0.25, 0.35, 30), rng.uniform(60, 80, 30)
    samples = [round(0.05 * k, 2) for k in range(1, 11)]
    return _case("crowd", start, velocity, spin, radius, mass, BOX, samples, g_n=200.0, g_t=200.0)


def staggered_rows() -> np.ndarray:
    """Centres of six rows of five discs, 0.02 m apart or more if no radius exceeds 0.35 m."""
    row, column = np.divmod(np.arange(30), 5)
    x = 0.36 + 0.72 * column + 0.36 * (row % 2)
    y = 0.36 + 0.656 * row
    return np.column_stack([x, y])


def all_cases() -> list[dict]:
    """Every case: two bodies, one body and walls, thirty bodies and walls."""
    return [*two_body_cases(), *wall_cases(), crowd_case()]


def _case(
    name: str,
    position: np.ndarray,
    velocity: np.ndarray,
    spin: np.ndarray,
    radius: np.ndarray,
    mass: np.ndarray,
    box: list[float] | None,
    sample_times: list[float],
    **law: float,
) -> dict:
    """Gather the pieces of a case, with lists of plain floats in place of arrays."""
    (x, y), (vx, vy) = np.transpose(position), np.transpose(velocity)
    discs = {"x": x, "y": y, "vx": vx, "vy": vy, "spin": spin, "radius": radius, "mass": mass}
    plain = {key: np.asarray(values, dtype=float).tolist() for key, values in discs.items()}
    times = {"dt": DT, "t_end": sample_times[-1], "sample_times": list(sample_times)}
    return {"name": name, **plain, **LAW, **law, "box": box, **times}
