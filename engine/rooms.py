"""Rooms: the papers' scenes as functions of named parameters."""

from collections.abc import Callable

from engine import models
from engine.accuracy import numerics_for
from engine.crowd import Crowd
from engine.errors import number, require
from engine.scenario import Numerics, Record, Scenario, Stopping
from engine.scene import Exit, Scene

LIN_2016 = Numerics(dt=1e-3, force_tolerance=1e-3, integrator="velocity_verlet")  # Table 1; no cut is named
PARISI_2005 = Numerics(dt=1e-4, force_tolerance=1e-3, integrator="velocity_verlet")  # Sec. 3; no cut is named


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
    mu: float = 0.5,
    tau: float = 0.5,
    reading: str = "RK",
    inertia: str = "sphere",
    size: float = 15.0,
    numerics: str = "accurate",
    accuracy: str = "2%",
    dt: float | None = None,
    force_tolerance: float | None = None,
    integrator: str | None = None,
    patience: float = 120.0,
    time_limit: float = 1000.0,
    every: float = 0.0,
    contacts: bool = False,
    state: str = "whole",
) -> Scenario:
    """The room of Lin, Ma & Lo (2016), Fig. 3 and Table 1.

    Parameters
    ----------
    v_d : desired speed of everybody, m/s
    N : number of persons
    seed : number of the run; places, radii and masses follow from it
    L : width of the exit, m
    A, B, phi : strength (N), range (m) and anisotropy of the social force (Eq. 2)
    E, poisson : Young's modulus (Pa) and Poisson's ratio of the bodies
    g_n, g_t : normal and tangential damping, 1/(m s)
    mu : friction coefficient
    tau : reaction time, s
    reading : what sliding does, see `models.lin_dem`
    inertia : "sphere", "disc" or "none", see `models.lin_dem`
    size : side of the room, m
    numerics : "accurate" for those that follow from `accuracy`, "paper" for the paper's
    accuracy : error that is tolerated: "2%" of the statistics, "1mm" or "0.1mm" of the places before chaos, see
        `engine.accuracy`
    dt, force_tolerance, integrator : where given they hold instead, see `Numerics`
    patience, time_limit : see `Stopping`
    every, contacts, state : see `Record`

    Raises
    ------
    BadInput
        If a parameter is out of its range or the crowd cannot fit.
    """
    scene = square_room(size, L)
    model = models.lin_dem(reading, A, B, phi, E, poisson, g_n, g_t, mu, tau, inertia)
    crowd = Crowd.uniform(N, (0.0, size, 0.0, size), radius=(0.25, 0.35), mass=(60.0, 80.0), v_d=v_d)
    return Scenario(
        scene=scene,
        crowd=crowd,
        model=model,
        numerics=numerics_for(numerics, accuracy, model, crowd, LIN_2016, every, dt, force_tolerance, integrator),
        stopping=Stopping(patience=patience, time_limit=time_limit),
        record=Record(every=every, contacts=contacts, state=state),
        seed=seed,
    )


def parisi_room(
    v_d: float = 1.0,
    N: int = 200,
    seed: int = 0,
    L: float = 1.2,
    A: float | None = None,
    B: float = 0.08,
    k_n: float = 1.2e5,
    kappa: float = 2.4e5,
    g: float = 100.0,
    tau: float = 0.5,
    reading: str = "default",
    mass: float = 80.0,
    size: float = 20.0,
    numerics: str = "accurate",
    accuracy: str = "2%",
    dt: float | None = None,
    force_tolerance: float | None = None,
    integrator: str | None = None,
    patience: float = 120.0,
    time_limit: float = 1000.0,
    every: float = 0.0,
    contacts: bool = False,
    state: str = "whole",
) -> Scenario:
    """The room of Parisi & Dorso (2005), Sec. 3: 20 m x 20 m, a door of 1.2 m, 200 persons.

    Whoever has crossed the door walks on, and is felt, for another metre.

    Parameters
    ----------
    v_d : middle of the desired speeds, which spread by 0.05 m/s to both sides, m/s
    N : number of persons
    seed : number of the run; places, radii, desired speeds and initial directions follow from it
    L : width of the door, m
    A, B : strength (N) and range (m) of the social force (Eq. 2); A follows from the reading if it is not given
    k_n, kappa, g : stiffness (N/m), sliding friction (kg/(m s)) and damping (kg/s) of contacts (Eq. 3)
    tau : reaction time, s
    reading : "default" or "printed", see `models.parisi_dorso`
    mass : of everybody, kg (the paper does not say)
    size : side of the room, m
    numerics : "accurate" for those that follow from `accuracy`, "paper" for the paper's
    accuracy : error that is tolerated: "2%" of the statistics, "1mm" or "0.1mm" of the places before chaos, see
        `engine.accuracy`
    dt, force_tolerance, integrator : where given they hold instead, see `Numerics`
    patience, time_limit : see `Stopping`
    every, contacts, state : see `Record`

    Raises
    ------
    BadInput
        If a parameter is out of its range or the crowd cannot fit.
    """
    v_d = number("v_d", v_d, "give the desired speed in m/s")
    require(v_d >= 0.05, "v_d", v_d, "is below 0.05 m/s, by which desired speeds spread", "give a larger one")
    scene = square_room(size, L, walk_on=1.0)
    model = models.parisi_dorso(reading, A, B, k_n, kappa, g, tau)
    v_ds, speed = (v_d - 0.05, v_d + 0.05), (0.995, 1.005)
    crowd = Crowd.uniform(N, (0.0, size, 0.0, size), (0.25, 0.29), mass, v_ds, speed)
    return Scenario(
        scene=scene,
        crowd=crowd,
        model=model,
        numerics=numerics_for(numerics, accuracy, model, crowd, PARISI_2005, every, dt, force_tolerance, integrator),
        stopping=Stopping(patience=patience, time_limit=time_limit),
        record=Record(every=every, contacts=contacts, state=state),
        seed=seed,
    )


ROOMS: dict[str, Callable[..., Scenario]] = {"lin_room": lin_room, "parisi_room": parisi_room}
