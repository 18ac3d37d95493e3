"""Models: named sets of laws."""

from typing import Any, NamedTuple

from engine.errors import number, require
from engine.kernel import laws
from engine.kernel.laws import (
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
    MindlinResetToZero,
    Relaxation,
    Rotation,
    Viscous,
)
from engine.kernel.laws.custom import UntraceableError, fingerprint_of, is_custom, stands_outside


class Model(NamedTuple):
    """One law of each kind; the types of the fields are the model."""

    drive: Any = Absent()
    social: Any = Absent()  # between persons
    anisotropy: Any = Absent()
    normal: Any = Absent()
    friction: Any = Absent()
    wall_social: Any = Absent()
    wall_normal: Any = Absent()
    wall_friction: Any = Absent()
    rotation: Any = Absent()


INERTIA = {"sphere": Rotation(0.4), "disc": Rotation(0.5), "none": Absent()}
FRICTION = ("reset", "reset_to_zero", "kept", "kinetic", "coulomb", "none")
SLIP_KINETIC, SLIP_COULOMB = 0.01, 0.001  # m/s, slip velocities at which friction without a spring sets in


def lin_dem(
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
) -> Model:
    """The discrete element crowd model of Lin, Ma & Lo (2016), Eqs. 1-6 and Table 1.

    The paper leaves open what friction does; the defaults reproduce its numbers (docs/variants.md).

    Parameters
    ----------
    A, B : float
        Strength (N) and range (m) of the social force (Eq. 2).
    phi : float
        Anisotropy of the social force (Eq. 2).
    E, poisson : float
        Young's modulus (Pa) and Poisson's ratio of the bodies.
    g_n, g_t : float
        Normal and tangential damping, 1/(m s).
    mu : float
        Friction coefficient of persons. Table 1 has 0.5; a spring that is kept at the limit gives the published
        clearance times with 0.3, one that is reset with 0.5, which on average is 0.25.
    tau : float
        Reaction time, s.
    friction : str
        Between persons: "reset", a spring that starts anew when it slips, from what it is beyond the Coulomb limit;
        "reset_to_zero", from zero, whose mean depends on the time step; "kept", one that is kept at the limit (LAMMPS's
        law); without a spring "kinetic", mu tanh(v_t/0.01 m/s), or "coulomb", mu sign(v_t);
        or "none".
    wall_friction : str
        The same at walls.
    wall_mu : float
        Friction coefficient at walls.
    wall_social : bool
        Whether walls exert the social force.
    wall_A : float or None
        Strength of the social force of walls, N; None for `A`.
    inertia : str
        "sphere" (0.4 m r^2), "disc" (0.5 m r^2) or "none" (nobody rotates).

    Raises
    ------
    BadInput
        If a word is none of these, or a parameter is out of its range.
    """
    words = {
        "friction": (friction, FRICTION),
        "wall_friction": (wall_friction, FRICTION),
        "inertia": (inertia, INERTIA),
    }
    for name, (word, known) in words.items():
        good = isinstance(word, str) and word in known
        require(good, name, repr(word), "is not known", f"choose one of {', '.join(known)}")
    require(isinstance(wall_social, bool), "wall_social", repr(wall_social), "is not true or false", "give one of them")
    E, poisson = number("E", E, "give Young's modulus in Pa"), number("poisson", poisson, "give Poisson's ratio")
    require(E > 0, "E", E, "is not above 0 Pa", "give Young's modulus")
    require(-1.0 < poisson < 1.0, "poisson", poisson, "is outside (-1, 1)", "give Poisson's ratio of the bodies")
    k_n = 2.0 * E / (3.0 * (1.0 + poisson) * (1.0 - poisson))
    k_t = 2.0 * E / ((1.0 + poisson) * (2.0 - poisson))

    def sliding(word: str, mu: float) -> Any:
        return {
            "reset": MindlinReset(k_t, g_t, mu),
            "reset_to_zero": MindlinResetToZero(k_t, g_t, mu),
            "kept": Mindlin(k_t, g_t, mu),
            "kinetic": Kinetic(mu, SLIP_KINETIC),
            "coulomb": Coulomb(mu, SLIP_COULOMB),
            "none": Absent(),
        }[word]

    return validated(
        Model(
            drive=Relaxation(tau),
            social=Exponential(A, B),
            anisotropy=Cosine(phi),
            normal=Hertz(k_n, g_n),
            friction=sliding(friction, mu),
            wall_social=Exponential(A if wall_A is None else wall_A, B) if wall_social else Absent(),
            wall_normal=Hertz(k_n, g_n),
            wall_friction=sliding(wall_friction, wall_mu),
            rotation=INERTIA[inertia],
        )
    )


def parisi_dorso(
    A: float = 2000.0,
    B: float = 0.08,
    k_n: float = 1.2e5,
    kappa: float = 2.4e5,
    g: float = 100.0,
    tau: float = 0.5,
) -> Model:
    """The social force model with granular contact of Parisi & Dorso (2005), Eqs. 1-3.

    Parameters
    ----------
    A, B : float
        Strength (N) and range (m) of the social force (Eq. 2). The paper prints A = 1000 N; the default with 80 kg a
        person gives its evacuation times, which that does not.
    k_n, kappa, g : float
        Stiffness (N/m), sliding friction (kg/(m s)) and damping (kg/s) of contacts (Eq. 3, k_t there is kappa).
    tau : float
        Reaction time, s.

    Raises
    ------
    BadInput
        If a parameter is out of its range.
    """
    return _granular(Exponential(A, B), k_n, kappa, g, tau)


def helbing_2000(
    A: float = 2000.0,
    B: float = 0.08,
    k_n: float = 1.2e5,
    kappa: float = 2.4e5,
    tau: float = 0.5,
) -> Model:
    """The social force model of Helbing, Farkas & Vicsek (2000): `parisi_dorso` without damping of contacts."""
    return _granular(Exponential(A, B), k_n, kappa, 0.0, tau)


def lambda_anisotropic(
    A: float = 2000.0,
    B: float = 0.08,
    lam: float = 0.3,
    k_n: float = 1.2e5,
    kappa: float = 2.4e5,
    g: float = 0.0,
    tau: float = 0.5,
) -> Model:
    """The same with a social force that is weaker from behind (text of Lin et al. 2016; FDS+Evac, CrowdDMX).

    `lam` is the weight of those straight behind, 1 of those straight ahead; walls push the same from all sides.
    """
    return _granular(Exponential(A, B), k_n, kappa, g, tau, Lambda(lam))


ISOTROPIC = Absent()


def _granular(
    repulsion: Exponential, k_n: float, kappa: float, g: float, tau: float, anisotropy: Any = ISOTROPIC
) -> Model:
    normal, sliding = Hooke(k_n, g), Viscous(kappa)
    return validated(
        Model(Relaxation(tau), repulsion, anisotropy, normal, sliding, repulsion, normal, sliding, Absent())
    )


def validated(model: Model) -> Model:
    """The model with all parameters as floats (an int would compile the kernel twice).

    Raises
    ------
    BadInput
        If a field is no law of its kind, or a parameter is not a finite number or not in its range.
    """
    model = Model(*(_validated(kind, law) for kind, law in zip(Model._fields, model, strict=True)))
    try:
        fingerprint_of(model)
    except UntraceableError as error:
        require(False, "model", "with a law of one's own", f"that {error}, which no run's key can tell", "use numbers")
    return model


def _validated(kind: str, law: Any) -> Any:
    known = laws.KINDS[kind].laws
    names = ", ".join(sorted(p.__name__ for p in known if not p.__name__.rpartition("_")[0]))
    remedy = f"choose one of {names}, or register one with @laws.{laws.KINDS[kind].__name__}.law"
    require(type(law) in known, kind, repr(law), "is not a law of this kind", remedy)
    if is_custom(law):
        ours = [p.__name__ for call in laws.KINDS.values() for p in call.laws if not stands_outside(p)]
        taken = type(law).__name__ in ours
        require(not taken, kind, type(law).__name__, "has the name of a law of the engine", "give it another")
    law_type: Any = type(law)
    for name, parameter in laws.parameters_of(law_type).items():
        thing, remedy = f"{kind} {name}", "give a number in its range"
        value = number(thing, getattr(law, name), remedy)
        require(value in parameter, thing, value, f"is not a finite number {parameter.requirement}", remedy)
    return type(law)(*map(float, law))
