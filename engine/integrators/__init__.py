"""Integrators: what happens to the velocities around the forces of a step, one file each.

Every step kicks the velocities by half a step, moves everybody, predicts the velocities at which the forces
are taken, and corrects them to the end of the step. The integrator's type chooses, as with the laws.
"""

from engine.integrators.choice import INTEGRATORS, correct, lead, predict
from engine.integrators.predictor import Predictor
from engine.integrators.velocity_verlet import VelocityVerlet

INTEGRATORS.update(velocity_verlet=VelocityVerlet(), predictor=Predictor())

__all__ = ["INTEGRATORS", "Predictor", "VelocityVerlet", "correct", "lead", "predict"]
