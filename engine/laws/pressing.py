"""Normal contact: what parts two bodies."""

import math
from typing import NamedTuple

from engine.dispatch import generic
from engine.laws.absent import Absent


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
