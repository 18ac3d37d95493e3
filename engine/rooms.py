"""Rooms: the papers' scenes as functions of named parameters; a room says what is simulated."""

from collections.abc import Callable

from engine import models
from engine.crowd import Crowd
from engine.errors import number, require
from engine.options import Numerics, with_options
from engine.scenario import Scenario
from engine.scene import Exit, Scene

LIN_2016 = Numerics(dt=1e-3, force_tolerance=1e-3, integrator="velocity_verlet")  # Table 1; no cutoff is named
PARISI_2005 = Numerics(dt=1e-4, force_tolerance=1e-3, integrator="velocity_verlet")  # Sec. 3; no cutoff is named


def square_room(size: float, L: float, walk_on: float = 0.0) -> Scene:
    """A square room [0, size]^2 with one exit of width L in the middle of its right wall, m."""
    L, size = number("L", L, "give the width of the exit"), number("size", size, "give the side of the room")
    require(L > 0, "L", L, "is not a width above 0 m", "give the width of the exit")
    require(size > L, "size", size, f"has no room for an exit of L = {L:g} m", "enlarge it")
    low, high = (size - L) / 2, (size + L) / 2
    walls = (
        (0.0, 0.0, size, 0.0),
        (0.0, 0.0, 0.0, size),
        (0.0, size, size, size),
        (size, 0.0, size, low),
        (size, high, size, size),
    )
    return Scene(walls, (Exit((size, low), (size, high), (1.0, 0.0), walk_on),))


@with_options
def lin_room(
    v_d: float = 1.0,
    N: int = 200,
    seed: int = 0,
    L: float = 1.0,
    A: float = 300.0,
    B: float = 0.05,
    phi: float = 0.3,
    E: float = 5e6,
    poisson: float = 0.25,
    g_n: float = 0.8,
    g_t: float = 0.8,
    mu: float = 0.3,
    tau: float = 0.5,
    friction: str = "kept",
    wall_friction: str = "kinetic",
    wall_mu: float = 0.5,
    wall_social: bool = True,
    wall_A: float | None = None,
    inertia: str = "sphere",
    size: float = 15.0,
) -> Scenario:
    """The room of Lin, Ma & Lo (2016), Fig. 3 and Table 1.

    Parameters
    ----------
    v_d : float
        Desired speed of everybody, m/s.
    N : int
        Number of persons.
    seed : int
        Number of the run; positions, radii and masses follow from it.
    L : float
        Width of the exit, m.
    A, B, phi, E, poisson, g_n, g_t, mu, tau, friction, wall_friction, wall_mu, wall_social, wall_A, inertia
        Of the model, see `models.lin_dem`.
    size : float
        Side of the room, m.

    Raises
    ------
    BadInput
        If a parameter is out of its range or the crowd cannot fit.
    """
    model = models.lin_dem(
        A, B, phi, E, poisson, g_n, g_t, mu, tau, friction, wall_friction, wall_mu, wall_social, wall_A, inertia
    )
    scene = square_room(size, L)
    crowd = Crowd.uniform(N, (0.0, size, 0.0, size), radius=(0.25, 0.35), mass=(60.0, 80.0), v_d=v_d)
    return Scenario(scene, crowd, model, seed=seed, paper=LIN_2016)


@with_options
def parisi_room(
    v_d: float = 1.0,
    N: int = 200,
    seed: int = 0,
    L: float = 1.2,
    A: float = 2000.0,
    B: float = 0.08,
    k_n: float = 1.2e5,
    kappa: float = 2.4e5,
    g: float = 100.0,
    tau: float = 0.5,
    mass: float = 80.0,
    size: float = 20.0,
) -> Scenario:
    """The room of Parisi & Dorso (2005), Sec. 3: 20 m x 20 m, a door of 1.2 m, 200 persons.

    Whoever has crossed the door walks on, and is felt, for another metre.

    Parameters
    ----------
    v_d : float
        Middle of the desired speeds, which spread by 0.05 m/s to both sides, m/s.
    N : int
        Number of persons.
    seed : int
        Number of the run; positions, radii, desired speeds and initial directions follow from it.
    L : float
        Width of the door, m.
    A, B, k_n, kappa, g, tau
        Of the model, see `models.parisi_dorso`; the paper prints A = 1000 N.
    mass : float
        Of everybody, kg (the paper does not say).
    size : float
        Side of the room, m.

    Raises
    ------
    BadInput
        If a parameter is out of its range or the crowd cannot fit.
    """
    v_d = number("v_d", v_d, "give the desired speed in m/s")
    require(v_d >= 0.05, "v_d", v_d, "is below 0.05 m/s, by which desired speeds spread", "give a larger one")
    model = models.parisi_dorso(A, B, k_n, kappa, g, tau)
    v_ds, speed = (v_d - 0.05, v_d + 0.05), (0.995, 1.005)
    scene = square_room(size, L, walk_on=1.0)
    crowd = Crowd.uniform(N, (0.0, size, 0.0, size), (0.25, 0.29), mass, v_ds, speed)
    return Scenario(scene, crowd, model, seed=seed, paper=PARISI_2005)


ROOMS: dict[str, Callable[..., Scenario]] = {"lin_room": lin_room, "parisi_room": parisi_room}
