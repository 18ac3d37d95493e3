"""The laws of force: parameters as small types, each with its law beside it.

A law is a scalar function of one person or one pair. The kind of law is a generic function; which law is
meant is said by the type of its parameters, and `Absent` is the law of physics that is not there. A new law
is a `NamedTuple` of floats and a function registered for it (see `engine.dispatch`).

Signs: n points from j to i, t = (-n_y, n_x); forces act on i; overlap > 0 in contact; v_n > 0 when the two
part; v_t is the slip velocity of the two surfaces along t.
"""

import math
from typing import NamedTuple

from engine.dispatch import generic
from engine.exponential import exp


class Absent(NamedTuple):
    """Physics that is not there; it costs nothing."""


# --- Drive: what makes a person walk --------------------------------------------------------------------


class Relaxation(NamedTuple):
    """Relaxation towards the desired velocity (Lin et al. 2016, Eq. 1)."""

    tau: float  # s


@generic
def drive(p, mass, v_d, e, v):
    """Driving force along one axis, N; e: desired direction and v: velocity along that axis."""


@drive.law(Absent)
def _no_drive(p, mass, v_d, e, v):
    return 0.0


@drive.law(Relaxation)
def _relaxation(p, mass, v_d, e, v):
    return mass * (v_d * e - v) / p.tau


@generic
def drive_rate(p):
    """Rate at which the drive takes velocity, 1/s."""


@drive_rate.law(Absent)
def _no_drive_rate(p):
    return 0.0


@drive_rate.law(Relaxation)
def _relaxation_rate(p):
    return 1.0 / p.tau


# --- Social force: keeping a distance -------------------------------------------------------------------


class Exponential(NamedTuple):
    """A exp(-gap/B), going on in overlap (Lin et al. 2016, Eq. 2; Helbing et al. 2000).

    `cut` is taken off, so that the force ends without a jump at the gap where it has fallen to `cut`.
    """

    A: float  # N
    B: float  # m
    cut: float = 0.0  # N


@generic
def social(p, gap):
    """Repulsion at a gap between two surfaces (negative in overlap), N."""


@social.law(Absent)
def _no_social(p, gap):
    return 0.0


@social.law(Exponential)
def _exponential(p, gap):
    return max(p.A * exp(-gap / p.B) - p.cut, 0.0)


@generic
def social_stiffness(p):
    """Change of the force with the gap where two surfaces meet, N/m."""


@social_stiffness.law(Absent)
def _no_social_stiffness(p):
    return 0.0


@social_stiffness.law(Exponential)
def _exponential_stiffness(p):
    return p.A / p.B


@generic
def cut_at(p, tolerance):
    """The same law, ending without a jump where it has fallen to `tolerance` (N)."""


@cut_at.law(Absent)
def _nothing_to_cut(p, tolerance):
    return p


@cut_at.law(Exponential)
def _cut_exponential(p, tolerance):
    return p._replace(cut=tolerance)


@generic
def reach(p):
    """Largest gap at which a law that has been cut acts, m."""


@reach.law(Absent)
def _reaches_nobody(p):
    return 0.0


@reach.law(Exponential)
def _reach_of_exponential(p):
    return p.B * math.log(p.A / p.cut) if p.cut < p.A else 0.0


# --- Vision: who in front weighs more -------------------------------------------------------------------


class Cosine(NamedTuple):
    """1 + phi cos(beta) (Lin et al. 2016, Eq. 2)."""

    phi: float


class Lambda(NamedTuple):
    """lambda + (1 - lambda)(1 + cos(beta))/2 (text of Lin et al. 2016; FDS+Evac, CrowdDMX)."""

    lam: float


@generic
def vision(p, cos_beta):
    """Weight of the social force; beta: angle between the desired direction and that to the other person."""


@vision.law(Absent)
def _all_round(p, cos_beta):
    return 1.0


@vision.law(Cosine)
def _cosine(p, cos_beta):
    return 1.0 + p.phi * cos_beta


@vision.law(Lambda)
def _lambda(p, cos_beta):
    return p.lam + (1.0 - p.lam) * (1.0 + cos_beta) / 2.0


@generic
def looks(p):
    """Whether the vision depends on the angle (a constant of the law's type)."""


@looks.law(Absent)
def _looks_not(p):
    return False


@looks.law(Cosine, Lambda)
def _looks(p):
    return True


# --- Normal contact -------------------------------------------------------------------------------------


class Hertz(NamedTuple):
    """sqrt(overlap radius) (k_n overlap - mass g_n v_n) (Lin et al. 2016, Eq. 3; LAMMPS gran/hertz)."""

    k_n: float  # Pa
    g_n: float  # 1/(m s)


class Hooke(NamedTuple):
    """k_n overlap - g_n v_n (Helbing et al. 2000; Parisi & Dorso 2005, Eq. 3)."""

    k_n: float  # N/m
    g_n: float  # kg/s


@generic
def normal(p, overlap, radius, mass, v_n):
    """Force that parts two bodies, N; radius r_i r_j/(r_i + r_j) and mass m_i m_j/(m_i + m_j) of the pair."""


@normal.law(Absent)
def _no_normal(p, overlap, radius, mass, v_n):
    return 0.0


@normal.law(Hertz)
def _hertz(p, overlap, radius, mass, v_n):
    return math.sqrt(overlap * radius) * (p.k_n * overlap - mass * p.g_n * v_n)


@normal.law(Hooke)
def _hooke(p, overlap, radius, mass, v_n):
    return p.k_n * overlap - p.g_n * v_n


@generic
def normal_damping(p, overlap, radius, mass):
    """Rate at which damping takes velocity, 1/s."""


@normal_damping.law(Absent)
def _no_normal_damping(p, overlap, radius, mass):
    return 0.0


@normal_damping.law(Hertz)
def _hertz_damping(p, overlap, radius, mass):
    return p.g_n * math.sqrt(overlap * radius)


@normal_damping.law(Hooke)
def _hooke_damping(p, overlap, radius, mass):
    return p.g_n / mass


@generic
def normal_stiffness(p, overlap, radius):
    """d(force)/d(overlap), N/m."""


@normal_stiffness.law(Absent)
def _no_normal_stiffness(p, overlap, radius):
    return 0.0


@normal_stiffness.law(Hertz)
def _hertz_stiffness(p, overlap, radius):
    return 1.5 * p.k_n * math.sqrt(overlap * radius)


@normal_stiffness.law(Hooke)
def _hooke_stiffness(p, overlap, radius):
    return p.k_n


# --- Sliding: tangential contact ------------------------------------------------------------------------


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
        F_t = math.copysign(limit, F_t)
        slip = -(F_t / alpha + mass * p.g_t * v_t) / p.k_t
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


@generic
def remembers(p):
    """Whether a sliding law has a spring, so that its slip is carried along (a constant of the type)."""


@remembers.law(Absent, Kinetic, Coulomb)
def _remembers_not(p):
    return False


@remembers.law(Mindlin, MindlinReset)
def _remembers(p):
    return True


@generic
def sliding_stiffness(p, overlap, radius):
    """d(force)/d(slip), N/m."""


@sliding_stiffness.law(Absent, Kinetic, Coulomb)
def _no_sliding_stiffness(p, overlap, radius):
    return 0.0


@sliding_stiffness.law(Mindlin, MindlinReset)
def _mindlin_stiffness(p, overlap, radius):
    return p.k_t * math.sqrt(overlap * radius)


@generic
def sliding_damping(p, overlap, radius):
    """Rate at which the tangential damper takes slip velocity of bodies that do not turn, 1/s."""


@sliding_damping.law(Absent, Kinetic, Coulomb)
def _no_sliding_damping(p, overlap, radius):
    return 0.0


@sliding_damping.law(Mindlin, MindlinReset)
def _mindlin_damping(p, overlap, radius):
    return p.g_t * math.sqrt(overlap * radius)


# --- Rotation about the vertical ------------------------------------------------------------------------


class Turning(NamedTuple):
    """Bodies turn: I = shape m r^2 (Lin et al. 2016, Eqs. 5, 6); shape 0.4 for a sphere, 0.5 for a disc."""

    shape: float


@generic
def turns(p):
    """Whether bodies turn (a constant of the type)."""


@turns.law(Absent)
def _turns_not(p):
    return False


@turns.law(Turning)
def _turns(p):
    return True


KINDS = {  # a model's field -> the generics that its parameters must have a law of
    "drive": (drive, drive_rate),
    "social": (social, social_stiffness, cut_at, reach),
    "vision": (vision, looks),
    "normal": (normal, normal_stiffness, normal_damping),
    "sliding": (sliding, remembers, sliding_stiffness, sliding_damping),
    "wall_social": (social, social_stiffness, cut_at, reach),
    "wall_normal": (normal, normal_stiffness, normal_damping),
    "wall_sliding": (sliding, remembers, sliding_stiffness, sliding_damping),
    "rotation": (turns,),
}
