"""What an integrator must say, and how velocities are changed by forces.

Its type names three constants (`history_offset`, `solves_contacts`, `damping_fraction`); `begin`, `predict` and
`correct` are its functions.
"""

from typing import Any

from engine.kernel.compiled import step_function
from engine.kernel.dispatch import generic, type_constant


@generic()
def begin(integrator, model, parameters, persons, pairs, wall_pairs, contacts, state, previous, dt):
    """Bring the velocities to where the step moves with them; the step before was `previous` long, s."""


@generic()
def predict(integrator, rotating, persons, n, dt):
    """Bring the half-step velocities to the time at which the forces are taken."""


@generic()
def correct(integrator, rotating, persons, n, dt):
    """Bring the velocities to the end of the step, with the new forces."""


@type_constant
def history_offset(integrator: Any) -> float:
    """Part of a step by which springs are kept ahead of the slip that acts (0 or 1/2)."""
    return float(integrator._field_defaults["history_offset"])


@type_constant
def solves_contacts(integrator: Any) -> bool:
    """Whether `begin` solves for drive, damping and friction, which `forces` then leaves out."""
    return bool(integrator._field_defaults["solves_contacts"])


@type_constant
def damping_fraction(integrator: Any) -> float:
    """Part of velocity Verlet's longest step with damping and friction that an integrator stands."""
    return float(integrator._field_defaults["damping_fraction"])


@step_function
def kick(rotating, persons, n, time):
    """Change the velocities by the forces over `time`."""
    for i in range(n):
        persons.vx[i] += time * persons.fx[i] * persons.inv_mass[i]
    for i in range(n):
        persons.vy[i] += time * persons.fy[i] * persons.inv_mass[i]
    if rotating:
        for i in range(n):
            persons.spin[i] += time * persons.torque[i] * persons.inv_inertia[i]
