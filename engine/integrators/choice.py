"""What an integrator must say, and how velocities are changed by forces."""

from typing import Any

from engine.compiled import step_function
from engine.dispatch import generic

INTEGRATORS: dict[str, Any] = {}  # by the name that `Numerics.integrator` gives


@generic
def begin(integrator, model, people, near, touch, n, before, dt):
    """Bring the velocities to where the step moves with them; the step before was `before` long, s."""


@generic
def predict(integrator, turning, people, n, dt):
    """Bring the half-step velocities to the time at which the forces are taken."""


@generic
def correct(integrator, turning, people, n, dt):
    """Bring the velocities to the end of the step, with the new forces."""


@generic
def lead(integrator):
    """Part of a step by which springs are kept ahead of the slip that acts (0 or 1/2)."""


@generic
def settles(integrator):
    """Whether `begin` solves for drive, damping and friction, which `forces` then leaves out (of the type)."""


@generic
def share(integrator):
    """Part of velocity Verlet's longest step with damping and friction that this integrator stands."""


@step_function
def kick(turning, people, n, time):
    """Change the velocities by the forces over `time`."""
    for i in range(n):
        people.vx[i] += time * people.fx[i] * people.ease[i]
    for i in range(n):
        people.vy[i] += time * people.fy[i] * people.ease[i]
    if turning:
        for i in range(n):
            people.spin[i] += time * people.torque[i] * people.ease_to_turn[i]
