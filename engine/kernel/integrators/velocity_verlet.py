"""Velocity Verlet as Lin et al. (2016) print it: forces at the half-step velocity (Eqs. 9-11, sub-step c)."""

from typing import NamedTuple

from engine.kernel.integrators.interface import begin, correct, kick, predict
from engine.kernel.laws import is_present


class VelocityVerlet(NamedTuple):
    """Second order where forces do not depend on velocity, first order where they do."""

    history_offset: float = 0.0
    solves_contacts: bool = False
    damping_fraction: float = 1.0


@begin.law(VelocityVerlet)
def _first_half(integrator, model, parameters, persons, pairs, wall_pairs, contacts, state, previous, dt):
    kick(is_present(model.rotation), persons, state.n, 0.5 * dt)


@predict.law(VelocityVerlet)
def _half_step_velocity(integrator, rotating, persons, n, dt):
    pass


@correct.law(VelocityVerlet)
def _second_half(integrator, rotating, persons, n, dt):
    kick(rotating, persons, n, 0.5 * dt)
