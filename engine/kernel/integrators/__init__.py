"""Integrators: what happens to the velocities around the forces of a step, one file each.

Every step begins with a kick of the velocities, moves everybody, predicts the velocities at which the forces are taken,
and corrects them to the end of the step. The integrator's type chooses, as with the laws.
"""

from typing import Any

from engine.kernel.integrators.predictor import Predictor
from engine.kernel.integrators.theta import Theta
from engine.kernel.integrators.velocity_verlet import VelocityVerlet

INTEGRATORS: dict[str, Any] = {
    "velocity_verlet": VelocityVerlet(),
    "predictor": Predictor(),
    "theta": Theta(),
}

__all__ = ["INTEGRATORS", "Predictor", "Theta", "VelocityVerlet"]
