"""Models: named sets of laws."""

import math
from typing import Any, NamedTuple

from engine import laws
from engine.errors import number, require
from engine.laws import (
    Absent,
    Cosine,
    Coulomb,
    Exponential,
    Hertz,
    Hooke,
    Kinetic,
    Lambda,
    Mindlin,
    MindlinReset,
    Relaxation,
    Turning,
    Viscous,
)


class Model(NamedTuple):
    """One law of each kind; the types of the fields are the model."""

    drive: Any = Absent()
    social: Any = Absent()  # between persons
    vision: Any = Absent()
    normal: Any = Absent()
    sliding: Any = Absent()
    wall_social: Any = Absent()
    wall_normal: Any = Absent()
    wall_sliding: Any = Absent()
    rotation: Any = Absent()


INERTIA = {"sphere": Turning(0.4), "disc": Turning(0.5), "none": Absent()}
READINGS = ("RK", "RS", "W", "W01", "R02", "WK", "WR", "B")


def lin_dem(
    reading: str = "RK",
    A: float = 300.0,  # N
    B: float = 0.05,  # m
    phi: float = 0.3,
    E: float = 5e6,  # Pa, Young's modulus
    poisson: float = 0.25,
    g_n: float = 0.8,  # 1/(m s)
    g_t: float = 0.8,  # 1/(m s)
    mu: float = 0.5,
    tau: float = 0.5,  # s
    inertia: str = "sphere",
) -> Model:
    """The discrete element crowd model of Lin, Ma & Lo (2016), Eqs. 1-6 and Table 1.

    Parameters
    ----------
    reading : what sliding does, which the paper leaves open; between persons, and at walls:
        RK spring reset on slip, kinetic friction mu tanh(v_t/0.01 m/s) (the default);
        RS spring reset, Coulomb friction; R02 spring reset, the same with mu = 0.2; WR the same both, with mu;
        W spring kept at the Coulomb limit (LAMMPS's law) for both; W01 at walls with mu = 0.1;
        WK LAMMPS's law, kinetic as RK; B as W, with walls that do not push socially.
    inertia : "sphere" (0.4 m r^2), "disc" (0.5 m r^2) or "none" (nobody turns)

    Raises
    ------
    BadInput
        If the reading or the inertia is none of these, or a parameter is out of its range.
    """
    for name, word, known in (("reading", reading, READINGS), ("inertia", inertia, tuple(INERTIA))):
        good = isinstance(word, str) and word in known
        require(good, name, repr(word), "is not known", f"choose one of {', '.join(known)}")
    E, poisson = number("E", E, "give Young's modulus in Pa"), number("poisson", poisson, "give Poisson's ratio")
    require(E > 0, "E", E, "is not above 0 Pa", "give Young's modulus")
    require(-1.0 < poisson < 1.0, "poisson", poisson, "is outside (-1, 1)", "give Poisson's ratio of the bodies")
    k_n = 2.0 * E / (3.0 * (1.0 + poisson) * (1.0 - poisson))
    k_t = 2.0 * E / ((1.0 + poisson) * (2.0 - poisson))
    kept, reset = Mindlin(k_t, g_t, mu), MindlinReset(k_t, g_t, mu)
    kinetic, coulomb = Kinetic(mu, 0.01), Coulomb(mu, 0.001)
    sliding, wall_sliding = {
        "RK": (reset, kinetic),
        "RS": (reset, coulomb),
        "W": (kept, kept),
        "W01": (kept, kept._replace(mu=0.1)),
        "R02": (reset, reset._replace(mu=0.2)),
        "WK": (kept, kinetic),
        "WR": (reset, reset),
        "B": (kept, kept),
    }[reading]
    repulsion = Exponential(A, B)
    return checked(
        Model(
            drive=Relaxation(tau),
            social=repulsion,
            vision=Cosine(phi),
            normal=Hertz(k_n, g_n),
            sliding=sliding,
            wall_social=Absent() if reading == "B" else repulsion,
            wall_normal=Hertz(k_n, g_n),
            wall_sliding=wall_sliding,
            rotation=INERTIA[inertia],
        )
    )


ALL_ROUND = Absent()  # nobody looks: everybody weighs the same
PARISI_READINGS = {"default": 2000.0, "printed": 1000.0}  # N, A


def parisi_dorso(
    reading: str = "default",
    A: float | None = None,  # N
    B: float = 0.08,  # m
    k_n: float = 1.2e5,  # N/m
    kappa: float = 2.4e5,  # kg/(m s)
    g: float = 100.0,  # kg/s
    tau: float = 0.5,  # s
) -> Model:
    """The social force model with granular contact of Parisi & Dorso (2005), Eqs. 1-3.

    Parameters
    ----------
    reading : "default", A = 2000 N, which with 80 kg a person gives the paper's evacuation times; or "printed",
        A = 1000 N as the paper prints it, which does not. Only used where A is not given.
    A, B : strength (N) and range (m) of the social force (Eq. 2)
    k_n, kappa, g : stiffness, sliding friction and damping of contacts (Eq. 3, k_t there is kappa)
    tau : reaction time, s

    Raises
    ------
    BadInput
        If the reading is not known, or a parameter is out of its range.
    """
    good = isinstance(reading, str) and reading in PARISI_READINGS
    require(good, "reading", repr(reading), "is not known", f"choose one of {', '.join(PARISI_READINGS)}")
    return _granular(Exponential(PARISI_READINGS[reading] if A is None else A, B), k_n, kappa, g, tau)


def helbing_2000(
    A: float = 2000.0,  # N
    B: float = 0.08,  # m
    k_n: float = 1.2e5,  # N/m
    kappa: float = 2.4e5,  # kg/(m s)
    tau: float = 0.5,  # s
) -> Model:
    """The social force model of Helbing, Farkas & Vicsek (2000): `parisi_dorso` without damping of contacts."""
    return _granular(Exponential(A, B), k_n, kappa, 0.0, tau)


def lambda_anisotropic(
    A: float = 2000.0,  # N
    B: float = 0.08,  # m
    lam: float = 0.3,
    k_n: float = 1.2e5,  # N/m
    kappa: float = 2.4e5,  # kg/(m s)
    g: float = 0.0,  # kg/s
    tau: float = 0.5,  # s
) -> Model:
    """The same with a social force that is weaker from behind (text of Lin et al. 2016; FDS+Evac, CrowdDMX).

    `lam` is the weight of those straight behind, 1 of those straight ahead; walls push the same from all sides.
    """
    return _granular(Exponential(A, B), k_n, kappa, g, tau, vision=Lambda(lam))


def _granular(repulsion: Exponential, k_n: float, kappa: float, g: float, tau: float, vision: Any = ALL_ROUND) -> Model:
    pressing, friction = Hooke(k_n, g), Viscous(kappa)
    return checked(
        Model(Relaxation(tau), repulsion, vision, pressing, friction, repulsion, pressing, friction, Absent())
    )


POSITIVE = {"tau", "B", "k_n", "k_t", "v_0", "shape"}  # parameters that a law divides by, or needs to exist
RANGES = {"phi": (-1.0, 1.0), "lam": (0.0, 1.0)}  # beyond, people in the back would attract; all others: 0 or more


def checked(model: Model) -> Model:
    """The model with all parameters as floats (an int would compile the kernel twice).

    Raises
    ------
    BadInput
        If a field is no law of its kind, or a parameter is not a finite number or not in its range.
    """
    return Model(*(_checked(kind, law) for kind, law in zip(Model._fields, model, strict=True)))


def _checked(kind: str, law: Any) -> Any:
    first, *companions = laws.KINDS[kind]
    names = ", ".join(sorted(p.__name__ for p in first.laws))
    require(type(law) in first.laws, kind, repr(law), "is not a law of this kind", f"choose one of {names}")
    for other in companions:
        remedy = f"register one with @{other.__name__}.law({type(law).__name__})"
        require(type(law) in other.laws, kind, repr(law), f"has no law of {other.__name__}", remedy)
    for name, value in law._asdict().items():
        _check_parameter(f"{kind} {name}", name, value)
    return type(law)(*map(float, law))


def _check_parameter(thing: str, name: str, value: Any) -> None:
    low, high = RANGES.get(name, (0.0, math.inf))
    value = number(thing, value, "give a number in its range")
    inside = low <= value <= high and (value > 0.0 or name not in POSITIVE)
    wanted = "above 0" if name in POSITIVE else "of 0 or more" if high == math.inf else f"from {low:g} to {high:g}"
    require(inside, thing, value, f"is not a finite number {wanted}", "give a number in its range")
