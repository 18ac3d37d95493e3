"""Sliding: tangential contact."""

import math
from typing import NamedTuple

from engine.dispatch import generic
from engine.laws.absent import Absent


class Mindlin(NamedTuple):
    """Tangential spring and damper; while it slips the spring is kept at the Coulomb limit.

    sqrt(overlap radius) (k_t slip + mass g_t v_t), at most mu abs(F_n) (Lin et al. 2016, Eq. 4; the law of
    LAMMPS gran/hertz/history with the spring as a scalar along t, which needs no projection in two
    dimensions).
    """

    k_t: float  # Pa
    g_t: float  # 1/(m s)
    mu: float


class MindlinReset(NamedTuple):
    """The same spring and damper; when it slips the limit acts and the spring starts anew from zero."""

    k_t: float  # Pa
    g_t: float  # 1/(m s)
    mu: float


class Kinetic(NamedTuple):
    """No spring: mu abs(F_n) tanh(v_t/v_0)."""

    mu: float
    v_0: float  # m/s


class Coulomb(NamedTuple):
    """No spring: mu abs(F_n) sign(v_t), linear in v_t below v_0."""

    mu: float
    v_0: float  # m/s


class Viscous(NamedTuple):
    """No spring and no limit: kappa overlap v_t (Helbing et al. 2000; Parisi & Dorso 2005, Eq. 3)."""

    kappa: float  # kg/(m s)


@generic
def sliding(p, overlap, radius, mass, v_t, F_n, slip):
    """Tangential force on i along t, N, and the spring's new slip, m."""


@sliding.law(Absent)
def _no_sliding(p, overlap, radius, mass, v_t, F_n, slip):
    return 0.0, 0.0


@sliding.law(Mindlin)
def _mindlin(p, overlap, radius, mass, v_t, F_n, slip):
    alpha = math.sqrt(overlap * radius)
    F_t = -alpha * (p.k_t * slip + mass * p.g_t * v_t)
    limit = p.mu * abs(F_n)
    if abs(F_t) > limit:
        held = math.copysign(limit, F_t)
        return held, -(held / alpha + mass * p.g_t * v_t) / p.k_t
    return F_t, slip


@sliding.law(MindlinReset)
def _mindlin_reset(p, overlap, radius, mass, v_t, F_n, slip):
    F_t = -math.sqrt(overlap * radius) * (p.k_t * slip + mass * p.g_t * v_t)
    limit = p.mu * abs(F_n)
    if abs(F_t) > limit:
        return math.copysign(limit, F_t), 0.0
    return F_t, slip


@sliding.law(Kinetic)
def _kinetic(p, overlap, radius, mass, v_t, F_n, slip):
    return -p.mu * abs(F_n) * math.tanh(v_t / p.v_0), 0.0


@sliding.law(Coulomb)
def _coulomb(p, overlap, radius, mass, v_t, F_n, slip):
    return -p.mu * abs(F_n) * min(max(v_t / p.v_0, -1.0), 1.0), 0.0


@sliding.law(Viscous)
def _viscous(p, overlap, radius, mass, v_t, F_n, slip):
    return -p.kappa * overlap * v_t, 0.0


@generic
def remembers(p):
    """Whether a sliding law has a spring, so that its slip is carried along (a constant of the type)."""


@remembers.law(Absent, Kinetic, Coulomb, Viscous)
def _remembers_not(p):
    return False


@remembers.law(Mindlin, MindlinReset)
def _remembers(p):
    return True


@generic
def sliding_stiffness(p, overlap, radius):
    """d(force)/d(slip), N/m."""


@sliding_stiffness.law(Absent, Kinetic, Coulomb, Viscous)
def _no_sliding_stiffness(p, overlap, radius):
    return 0.0


@sliding_stiffness.law(Mindlin, MindlinReset)
def _mindlin_stiffness(p, overlap, radius):
    return p.k_t * math.sqrt(overlap * radius)


@generic
def sliding_damping(p, overlap, radius, mass):
    """Rate at which slip velocity of bodies that do not turn is taken without limit, 1/s.

    A force that ends at a limit bounds what a step that is too long can do, and does not count.
    """


@sliding_damping.law(Absent, Kinetic, Coulomb)
def _no_sliding_damping(p, overlap, radius, mass):
    return 0.0


@sliding_damping.law(Mindlin, MindlinReset)
def _mindlin_damping(p, overlap, radius, mass):
    return p.g_t * math.sqrt(overlap * radius)


@sliding_damping.law(Viscous)
def _viscous_damping(p, overlap, radius, mass):
    return p.kappa * overlap / mass


@generic
def stiff(p):
    """Whether friction follows the slip velocity so closely that it has to be solved for (a constant of the type)."""


@stiff.law(Absent, Mindlin, MindlinReset)
def _soft(p):
    return False


@stiff.law(Kinetic, Coulomb, Viscous)
def _stiff(p):
    return True


@generic
def limit(p, F_n):
    """Largest force of friction at the normal force F_n, N; inf where friction vanishes with the slip velocity."""


@limit.law(Absent, Kinetic, Coulomb, Viscous)
def _creeps(p, F_n):
    return math.inf


@limit.law(Mindlin, MindlinReset)
def _holds_up_to(p, F_n):
    return p.mu * abs(F_n)
