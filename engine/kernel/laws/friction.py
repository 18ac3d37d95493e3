"""Friction: tangential contact.

A law without memory gives the force from the slip velocity; one with a spring also takes and gives back the spring's
tangential displacement:

    kinetic(p, overlap, radius, mass, v_t, F_n) -> F_t
    mindlin(p, overlap, radius, mass, v_t, F_n, displacement) -> F_t, displacement
"""

import inspect
import math
from typing import Annotated, Any, NamedTuple

from engine.kernel.compiled import formula
from engine.kernel.dispatch import Law, generic, type_constant
from engine.kernel.laws.absent import Absent
from engine.kernel.laws.parameters import above, at_least

WITHOUT_MEMORY: set[type] = set()
ARGUMENTS = 7  # of a law with a spring
STRONG = 1e30  # N, a normal force under which a spring holds
FAR = 1e6  # m, a displacement at which any spring slips
FAST = 10.0  # m/s, beyond which a friction that has a limit has reached it


class Mindlin(NamedTuple):
    """Tangential spring and damper; while it slips the spring is kept at the Coulomb limit.

    sqrt(overlap radius) (k_t displacement + mass g_t v_t), at most mu abs(F_n) (Lin et al. 2016, Eq. 4; the law of
    LAMMPS gran/hertz/history with the displacement as a scalar along t, which needs no projection in two dimensions).
    """

    k_t: Annotated[float, above(0.0, "Pa", "tangential stiffness")]
    g_t: Annotated[float, at_least(0.0, "1/(m s)", "tangential damping")]
    mu: Annotated[float, at_least(0.0, "1", "friction coefficient")]


class MindlinReset(NamedTuple):
    """The same spring and damper; when it slips the spring starts anew, from what it is beyond the limit.

    Under steady slip the force is a sawtooth of mean mu F_n/2, at any time step.
    """

    k_t: Annotated[float, above(0.0, "Pa", "tangential stiffness")]
    g_t: Annotated[float, at_least(0.0, "1/(m s)", "tangential damping")]
    mu: Annotated[float, at_least(0.0, "1", "friction coefficient")]


class MindlinResetToZero(NamedTuple):
    """The same, but the spring starts anew from zero, and the limit acts for the whole step at which it slips.

    The mean force under steady slip depends on the time step: (1 + 1/k) mu F_n/2 where k steps make a tooth of the
    sawtooth.
    """

    k_t: Annotated[float, above(0.0, "Pa", "tangential stiffness")]
    g_t: Annotated[float, at_least(0.0, "1/(m s)", "tangential damping")]
    mu: Annotated[float, at_least(0.0, "1", "friction coefficient")]


class Kinetic(NamedTuple):
    """No spring: mu abs(F_n) tanh(v_t/v_0)."""

    mu: Annotated[float, at_least(0.0, "1", "friction coefficient")]
    v_0: Annotated[float, above(0.0, "m/s", "slip velocity at which friction sets in")]


class Coulomb(NamedTuple):
    """No spring: mu abs(F_n) sign(v_t), linear in v_t below v_0."""

    mu: Annotated[float, at_least(0.0, "1", "friction coefficient")]
    v_0: Annotated[float, above(0.0, "m/s", "slip velocity at which friction is complete")]


class Viscous(NamedTuple):
    """No spring and no limit: kappa overlap v_t (Helbing et al. 2000; Parisi & Dorso 2005, Eq. 3)."""

    kappa: Annotated[float, at_least(0.0, "kg/(m s)", "sliding friction")]


def _with_displacement(parameters: type, law: Law) -> Law:
    """The law in the form that the kernel calls; one without memory leaves no displacement."""
    count = len(inspect.signature(law).parameters)
    if count not in (ARGUMENTS - 1, ARGUMENTS):
        raise TypeError(
            f"law {law.__name__} takes {count} arguments: friction takes (p, overlap, radius, mass, v_t, F_n), "
            "and with a spring also its displacement"
        )
    WITHOUT_MEMORY.discard(parameters)
    if count == ARGUMENTS:
        return law
    WITHOUT_MEMORY.add(parameters)
    memoryless = formula(law)

    def form(p, overlap, radius, mass, v_t, F_n, displacement):
        return memoryless(p, overlap, radius, mass, v_t, F_n), 0.0

    return form


@generic(adapted=_with_displacement)
def friction(p, overlap, radius, mass, v_t, F_n, displacement):
    """Tangential force on i along t, N, and the spring's new displacement, m."""


@friction.law(Absent)
def _no_friction(p, overlap, radius, mass, v_t, F_n):
    return 0.0


@friction.law(Mindlin)
def _mindlin(p, overlap, radius, mass, v_t, F_n, displacement):
    alpha = math.sqrt(overlap * radius)
    F_t = -alpha * (p.k_t * displacement + mass * p.g_t * v_t)
    limit = p.mu * abs(F_n)
    if abs(F_t) > limit:
        held = math.copysign(limit, F_t)
        return held, -(held / alpha + mass * p.g_t * v_t) / p.k_t
    return F_t, displacement


@friction.law(MindlinReset)
def _mindlin_reset(p, overlap, radius, mass, v_t, F_n, displacement):
    alpha = math.sqrt(overlap * radius)
    F_t = -alpha * (p.k_t * displacement + mass * p.g_t * v_t)
    limit = p.mu * abs(F_n)
    if abs(F_t) > limit:
        direction = math.copysign(1.0, F_t)
        damping = -direction * alpha * mass * p.g_t * v_t
        tooth = limit - damping  # force of the spring at which the contact slips
        if tooth <= 0.0:
            return direction * limit, 0.0
        spring = (abs(F_t) - limit) % tooth
        return direction * max(spring + damping, -limit), -direction * spring / (alpha * p.k_t)
    return F_t, displacement


@friction.law(MindlinResetToZero)
def _mindlin_reset_to_zero(p, overlap, radius, mass, v_t, F_n, displacement):
    F_t = -math.sqrt(overlap * radius) * (p.k_t * displacement + mass * p.g_t * v_t)
    limit = p.mu * abs(F_n)
    if abs(F_t) > limit:
        return math.copysign(limit, F_t), 0.0
    return F_t, displacement


@friction.law(Kinetic)
def _kinetic(p, overlap, radius, mass, v_t, F_n):
    return -p.mu * abs(F_n) * math.tanh(v_t / p.v_0)


@friction.law(Coulomb)
def _coulomb(p, overlap, radius, mass, v_t, F_n):
    return -p.mu * abs(F_n) * min(max(v_t / p.v_0, -1.0), 1.0)


@friction.law(Viscous)
def _viscous(p, overlap, radius, mass, v_t, F_n):
    return -p.kappa * overlap * v_t


@generic(default=lambda p, overlap: 0.0)
def viscosity(p, overlap):
    """-F_t/v_t of a friction that is linear in v_t, kg/s, by which the solver knows its solution at once; else 0."""


@viscosity.law(Viscous)
def _linear(p, overlap):
    return p.kappa * overlap


@type_constant
def has_history(parameters: type) -> bool:
    """Whether a friction law has a spring, whose displacement is carried along."""
    return parameters not in WITHOUT_MEMORY


def _limit_from_far_displacement(p, overlap, radius, mass, F_n):
    return abs(friction(p, overlap, radius, mass, 0.0, F_n, FAR)[0]) if has_history(p) else math.inf


@type_constant
def needs_implicit(parameters: type) -> bool:
    """Whether friction follows the slip velocity so closely that it has to be solved for."""
    return parameters in WITHOUT_MEMORY and parameters is not Absent


@generic(default=_limit_from_far_displacement)
def friction_limit(p, overlap, radius, mass, F_n):
    """Largest force of a spring, N; inf where there is none: such friction vanishes with the slip velocity."""


@friction_limit.law(MindlinReset)
def _coulomb_limit(p, overlap, radius, mass, F_n):
    return p.mu * abs(F_n)


def tangential_stiffness(law: Any, overlap: float, radius: float) -> float:
    """-d(force)/d(displacement) of the spring that holds, N/m."""
    small = 1e-6  # m
    return -float(friction(law, overlap, radius, 1.0, 0.0, STRONG, small)[0]) / small


def sliding_damping_rate(law: Any, overlap: float, radius: float, mass: float, F_n: float) -> float:
    """Rate at which slip velocity of bodies that do not rotate is taken, 1/s, while a spring holds.

    Without a spring a force that ends at a limit bounds what a step that is too long can do, and does not count: the
    rate is that at FAST.
    """
    F_n = STRONG if has_history(law) else F_n
    slow, fast = (friction(law, overlap, radius, mass, v, F_n, 0.0)[0] for v in (FAST, FAST + 1.0))
    return float(slow - fast) / mass
