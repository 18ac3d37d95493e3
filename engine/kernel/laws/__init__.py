"""The laws of force: parameters as a small type, and one function beside it.

A law is a scalar function of one person or one pair, chosen by the type of its parameters; `Absent` is the law of
physics that is not there. All else (cutoff, stiffness, damping, limit) follows from the function.

Signs: n points from j to i, t = (-n_y, n_x); forces act on i; overlap > 0 in contact; v_n > 0 when the two part; v_t
is the slip velocity of the two surfaces along t.
"""

from engine.kernel.exponential import exp
from engine.kernel.laws.absent import Absent, is_present
from engine.kernel.laws.anisotropy import Cosine, Lambda, anisotropy
from engine.kernel.laws.driving import Relaxation, drive
from engine.kernel.laws.friction import (
    Coulomb,
    Kinetic,
    Mindlin,
    MindlinReset,
    MindlinResetToZero,
    Viscous,
    friction,
    has_history,
)
from engine.kernel.laws.normal_contact import Hertz, Hooke, normal
from engine.kernel.laws.parameters import above, at_least, between, parameters_of
from engine.kernel.laws.rotation import Rotation, inertia
from engine.kernel.laws.social_force import Exponential, cutoff, social

KINDS = {  # field of a model -> the function that its parameters must have a law of
    "drive": drive,
    "social": social,
    "anisotropy": anisotropy,
    "normal": normal,
    "friction": friction,
    "wall_social": social,
    "wall_normal": normal,
    "wall_friction": friction,
    "rotation": inertia,
}

__all__ = [
    "KINDS",
    "Absent",
    "Cosine",
    "Coulomb",
    "Exponential",
    "Hertz",
    "Hooke",
    "Kinetic",
    "Lambda",
    "Mindlin",
    "MindlinReset",
    "MindlinResetToZero",
    "Relaxation",
    "Rotation",
    "Viscous",
    "above",
    "anisotropy",
    "at_least",
    "between",
    "cutoff",
    "drive",
    "exp",
    "friction",
    "has_history",
    "inertia",
    "is_present",
    "normal",
    "parameters_of",
    "social",
]
