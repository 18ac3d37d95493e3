"""The longest time step that a model's laws allow."""

import math

from engine.compiled import step_function
from engine.laws import (
    drive_rate,
    normal_damping,
    normal_stiffness,
    sliding_damping,
    sliding_stiffness,
    social_stiffness,
    stiff,
)

CAUSES = ("stiffness of the contacts", "damping of the contacts", "friction of the contacts", "drive's tau")


def plain_step_limits(model, share, settled, overlap, radius, mass, turning):
    """Longest stable time steps, s, one for each of CAUSES.

    For springs 2/omega of the stiffest mode of a triangular packing, omega^2 = 3 k/m of one pair; the tangential
    spring also turns the bodies, and so acts on a smaller mass. For dampers and friction, `share` of a third of
    2/rate, since a person has up to six neighbours; for the drive tau.

    Parameters
    ----------
    share : part of the limit of damping that the integrator stands
    settled : whether the integrator solves for damping and friction where friction is stiff
    overlap : at which the laws are taken, m
    radius, mass : of the smallest and of the lightest person, m, kg
    turning : 1 + mass radius^2/inertia: how much easier a surface is to move than a body (1 if nobody turns)
    """
    # two persons have half the radius and half the mass of one at a wall
    pair_spring = social_stiffness(model.social) + normal_stiffness(model.normal, overlap, 0.5 * radius)
    wall_spring = social_stiffness(model.wall_social) + normal_stiffness(model.wall_normal, overlap, radius)
    pair_slip = sliding_stiffness(model.sliding, overlap, 0.5 * radius) * turning
    wall_slip = sliding_stiffness(model.wall_sliding, overlap, radius) * turning
    spring = max(max(pair_spring, pair_slip) / (0.5 * mass), max(wall_spring, wall_slip) / mass)
    between = 0.0 if settled and stiff(model.sliding) else 1.0
    at_wall = 0.0 if settled and stiff(model.wall_sliding) else 1.0
    damping = max(
        between * normal_damping(model.normal, overlap, 0.5 * radius, 0.5 * mass),
        at_wall * normal_damping(model.wall_normal, overlap, radius, mass),
    )
    friction = turning * max(
        between * sliding_damping(model.sliding, overlap, 0.5 * radius, 0.5 * mass),
        at_wall * sliding_damping(model.wall_sliding, overlap, radius, mass),
    )
    drive = drive_rate(model.drive)
    return (
        2.0 / math.sqrt(3.0 * spring) if spring > 0.0 else math.inf,
        share / (1.5 * damping) if damping > 0.0 else math.inf,
        share / (1.5 * friction) if friction > 0.0 else math.inf,
        1.0 / drive if drive > 0.0 else math.inf,
    )


step_limits = step_function(plain_step_limits)  # for the kernel
