"""The longest time step that a model's laws allow."""

import math
from typing import Any

import numpy as np

from engine.kernel.integrators.interface import damping_fraction, solves_contacts
from engine.kernel.laws import inertia, normal
from engine.kernel.laws.custom import cached_by_laws
from engine.kernel.laws.driving import drive_rate
from engine.kernel.laws.friction import needs_implicit, sliding_damping_rate, tangential_stiffness
from engine.kernel.laws.normal_contact import normal_damping_rate, normal_stiffness
from engine.kernel.laws.social_force import social_stiffness

CAUSES = ("stiffness of the contacts", "damping of the contacts", "friction of the contacts", "drive's tau")
MAX_HALVINGS = 6  # of a step: into 64 substeps
SMALLEST_OVERLAP = 1e-9  # m, at which laws are differentiated


def step_limits(model: Any, integrator: Any, overlap: float, radius: float, mass: float) -> tuple[float, ...]:
    """Longest stable time steps, s, one for each of CAUSES.

    For springs 2/omega of the stiffest mode of a triangular packing, omega^2 = 3 k/m of one pair; the tangential spring
    also turns the bodies, and so acts on a smaller mass. For dampers and friction, the integrator's fraction of a third
    of 2/rate, since a person has up to six neighbours; for the drive tau.

    Parameters
    ----------
    model : Model
    integrator : NamedTuple
    overlap : float
        At which the laws are taken, m.
    radius, mass : float
        Of the smallest and of the lightest person, m, kg.
    """
    overlap = max(overlap, SMALLEST_OVERLAP)
    easier = _rolling_factor(model.rotation)
    # two persons have half the radius and half the mass of one at a wall
    pair = _rates(model.social, model.normal, model.friction, overlap, 0.5 * radius, 0.5 * mass, easier, integrator)
    wall = _rates(model.wall_social, model.wall_normal, model.wall_friction, overlap, radius, mass, easier, integrator)
    spring, damping, friction = map(max, zip(pair, wall, strict=True))
    rate, fraction = drive_rate(model.drive), damping_fraction(integrator)
    return (
        2.0 / math.sqrt(3.0 * spring) if spring > 0.0 else math.inf,
        fraction / (1.5 * damping) if damping > 0.0 else math.inf,
        fraction / (1.5 * friction) if friction > 0.0 else math.inf,
        1.0 / rate if rate > 0.0 else math.inf,
    )


def _rates(
    social: Any, pressing: Any, rubbing: Any, overlap: float, radius: float, mass: float, easier: float, integrator: Any
) -> tuple[float, float, float]:
    """Stiffness over mass, 1/s^2, and rates of damping and of friction, 1/s, of one contact."""
    stiffness = social_stiffness(social) + normal_stiffness(pressing, overlap, radius)
    spring = max(stiffness, tangential_stiffness(rubbing, overlap, radius) * easier) / mass
    if solves_contacts(integrator) and needs_implicit(rubbing):
        return spring, 0.0, 0.0
    F_n = normal(pressing, overlap, radius, mass, 0.0)
    friction = easier * sliding_damping_rate(rubbing, overlap, radius, mass, F_n)
    return spring, normal_damping_rate(pressing, overlap, radius, mass), friction


def _rolling_factor(rotation: Any) -> float:
    """How much easier a surface is to move than its body, which also rotates: 1 + mass radius^2/inertia."""
    return 1.0 + 1.0 / inertia(rotation, 1.0, 1.0)


@cached_by_laws
def allowed_overlaps(model: Any, integrator: Any, dt: float, radius: float, mass: float) -> np.ndarray:
    """Overlaps up to which a step stands that is cut into 1, 2, 4 ... 64 substeps, m (7,), by bisection."""

    def stands(overlap: float, substep: float) -> bool:
        return min(step_limits(model, integrator, overlap, radius, mass)[:3]) >= substep

    allowed = np.empty(MAX_HALVINGS + 1)
    for k in range(MAX_HALVINGS + 1):
        low, high, substep = 0.0, radius, dt / 2**k
        if stands(high, substep):
            allowed[k] = math.inf
            continue
        while high - low > 1e-9 * radius:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if stands(middle, substep) else (low, middle)
        allowed[k] = low
    return allowed
