"""Rotation about the vertical."""

import math
from typing import Annotated, NamedTuple

from engine.kernel.dispatch import generic
from engine.kernel.laws.absent import Absent
from engine.kernel.laws.parameters import above


class Rotation(NamedTuple):
    """Bodies rotate: I = inertia_factor m r^2 (Lin et al. 2016, Eqs. 5, 6); 0.4 for a sphere, 0.5 for a disc."""

    inertia_factor: Annotated[float, above(0.0, "1", "I/(m r^2)")]


@generic()
def inertia(p, mass, radius):
    """Moment of inertia about the vertical, kg m^2; inf for bodies that do not rotate."""


@inertia.law(Absent)
def _no_rotation(p, mass, radius):
    return math.inf


@inertia.law(Rotation)
def _of_a_round_body(p, mass, radius):
    return p.inertia_factor * mass * radius**2
