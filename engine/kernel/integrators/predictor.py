"""Velocity Verlet with predicted velocities: second order also where forces depend on velocity.

v_1/2 = v + a dt/2, x' = x + v_1/2 dt, forces at (x', v + a dt), v' = v_1/2 + a' dt/2 (the form of velocity Verlet
for dissipative particle dynamics with lambda = 1: Groot & Warren 1997, Eq. 12). The tangential springs stretch by
the mean of the slip velocities at both ends of the step.
"""

from typing import NamedTuple

from engine.kernel.integrators.interface import begin, correct, kick, predict
from engine.kernel.laws import is_present


class Predictor(NamedTuple):
    """Second order on smooth stretches; half the stability limit of velocity Verlet for sliding friction."""

    history_offset: float = 0.5
    solves_contacts: bool = False
    damping_fraction: float = 0.5


@begin.law(Predictor)
def _first_half(integrator, model, parameters, persons, pairs, wall_pairs, contacts, state, previous, dt):
    kick(is_present(model.rotation), persons, state.n, 0.5 * dt)


@predict.law(Predictor)
def _full_step(integrator, rotating, persons, n, dt):
    for i in range(n):
        persons.previous_x[i], persons.previous_y[i] = persons.fx[i], persons.fy[i]
        persons.previous_spin[i] = persons.torque[i]
    kick(rotating, persons, n, 0.5 * dt)


@correct.law(Predictor)
def _mean_force(integrator, rotating, persons, n, dt):
    for i in range(n):
        persons.vx[i] += 0.5 * dt * (persons.fx[i] - persons.previous_x[i]) * persons.inv_mass[i]
        persons.vy[i] += 0.5 * dt * (persons.fy[i] - persons.previous_y[i]) * persons.inv_mass[i]
        if rotating:
            persons.spin[i] += 0.5 * dt * (persons.torque[i] - persons.previous_spin[i]) * persons.inv_inertia[i]
