"""Velocity Verlet as Lin et al. (2016) print it: forces at the half-step velocity (Eqs. 9-11, sub-step c)."""

from typing import NamedTuple

from engine.integrators.choice import begin, correct, kick, lead, predict, settles, share
from engine.laws import turns


class VelocityVerlet(NamedTuple):
    """Second order where forces do not depend on velocity, first order where they do."""


@begin.law(VelocityVerlet)
def _first_half(integrator, model, people, near, touch, n, before, dt):
    kick(turns(model.rotation), people, n, 0.5 * dt)


@predict.law(VelocityVerlet)
def _as_they_are(integrator, turning, people, n, dt):
    pass


@correct.law(VelocityVerlet)
def _second_half(integrator, turning, people, n, dt):
    kick(turning, people, n, 0.5 * dt)


@lead.law(VelocityVerlet)
def _no_lead(integrator):
    return 0.0


@settles.law(VelocityVerlet)
def _evaluates(integrator):
    return False


@share.law(VelocityVerlet)
def _all_of_it(integrator):
    return 1.0
