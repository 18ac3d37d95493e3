"""Normal contact: what parts two bodies."""

import math
from typing import Annotated, Any, NamedTuple

from engine.kernel.dispatch import generic
from engine.kernel.laws.absent import Absent
from engine.kernel.laws.parameters import above, at_least


class Hertz(NamedTuple):
    """sqrt(overlap radius) (k_n overlap - mass g_n v_n) (Lin et al. 2016, Eq. 3; LAMMPS gran/hertz)."""

    k_n: Annotated[float, above(0.0, "Pa", "stiffness")]
    g_n: Annotated[float, at_least(0.0, "1/(m s)", "damping")]


class Hooke(NamedTuple):
    """k_n overlap - g_n v_n (Helbing et al. 2000; Parisi & Dorso 2005, Eq. 3)."""

    k_n: Annotated[float, above(0.0, "N/m", "stiffness")]
    g_n: Annotated[float, at_least(0.0, "kg/s", "damping")]


@generic()
def normal(p, overlap, radius, mass, v_n):
    """Force that parts two bodies, N, linear in v_n; radius and mass of the pair, r_i r_j/(r_i + r_j) and likewise."""


@normal.law(Absent)
def _no_normal(p, overlap, radius, mass, v_n):
    return 0.0


@normal.law(Hertz)
def _hertz(p, overlap, radius, mass, v_n):
    return math.sqrt(overlap * radius) * (p.k_n * overlap - mass * p.g_n * v_n)


@normal.law(Hooke)
def _hooke(p, overlap, radius, mass, v_n):
    return p.k_n * overlap - p.g_n * v_n


def normal_stiffness(law: Any, overlap: float, radius: float) -> float:
    """d(force)/d(overlap) at an overlap above 0, N/m, by central difference."""
    step = 1e-5 * overlap
    rise = normal(law, overlap + step, radius, 1.0, 0.0) - normal(law, overlap - step, radius, 1.0, 0.0)
    return rise / (2.0 * step)


def normal_damping_rate(law: Any, overlap: float, radius: float, mass: float) -> float:
    """Rate at which damping takes velocity, 1/s, from the difference of the force over 1 m/s."""
    return (normal(law, overlap, radius, mass, 0.0) - normal(law, overlap, radius, mass, 1.0)) / mass
