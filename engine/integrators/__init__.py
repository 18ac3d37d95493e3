"""Integrators: what happens to the velocities around the forces of a step, one file each.

Every step begins with a kick of the velocities, moves everybody, predicts the velocities at which the forces
are taken, and corrects them to the end of the step. The integrator's type chooses, as with the laws.
"""

from engine.integrators.choice import INTEGRATORS, begin, correct, lead, predict, settles, share
from engine.integrators.predictor import Predictor
from engine.integrators.semi_implicit import SemiImplicit
from engine.integrators.velocity_verlet import VelocityVerlet

INTEGRATORS.update(velocity_verlet=VelocityVerlet(), predictor=Predictor(), semi_implicit=SemiImplicit())

__all__ = [
    "INTEGRATORS",
    "Predictor",
    "SemiImplicit",
    "VelocityVerlet",
    "begin",
    "correct",
    "lead",
    "predict",
    "settles",
    "share",
]
