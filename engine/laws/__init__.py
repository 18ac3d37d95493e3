"""The laws of force: parameters as small types, each with its law beside it.

A law is a scalar function of one person or one pair. The kind of law is a generic function; which law is
meant is said by the type of its parameters, and `Absent` is the law of physics that is not there. A new law
is a `NamedTuple` of floats and a function registered for it (see `engine.dispatch`). One file each: `driving`,
`repulsion` (social force), `sight` (vision), `pressing` (normal contact), `friction`, `turning`.

Signs: n points from j to i, t = (-n_y, n_x); forces act on i; overlap > 0 in contact; v_n > 0 when the two
part; v_t is the slip velocity of the two surfaces along t.
"""

from engine.laws.absent import Absent
from engine.laws.driving import Relaxation, drive, drive_rate
from engine.laws.friction import (
    Coulomb,
    Kinetic,
    Mindlin,
    MindlinReset,
    Viscous,
    limit,
    remembers,
    sliding,
    sliding_damping,
    sliding_stiffness,
    stiff,
)
from engine.laws.pressing import Hertz, Hooke, normal, normal_damping, normal_stiffness
from engine.laws.repulsion import Exponential, cut_at, reach, social, social_stiffness
from engine.laws.sight import Cosine, Lambda, looks, vision
from engine.laws.turning import Turning, turns

KINDS = {  # a model's field -> the generics that its parameters must have a law of
    "drive": (drive, drive_rate),
    "social": (social, social_stiffness, cut_at, reach),
    "vision": (vision, looks),
    "normal": (normal, normal_stiffness, normal_damping),
    "sliding": (sliding, remembers, stiff, sliding_stiffness, sliding_damping, limit),
    "wall_social": (social, social_stiffness, cut_at, reach),
    "wall_normal": (normal, normal_stiffness, normal_damping),
    "wall_sliding": (sliding, remembers, stiff, sliding_stiffness, sliding_damping, limit),
    "rotation": (turns,),
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
    "Relaxation",
    "Turning",
    "Viscous",
    "cut_at",
    "drive",
    "drive_rate",
    "limit",
    "looks",
    "normal",
    "normal_damping",
    "normal_stiffness",
    "reach",
    "remembers",
    "sliding",
    "sliding_damping",
    "sliding_stiffness",
    "social",
    "social_stiffness",
    "stiff",
    "turns",
    "vision",
]
