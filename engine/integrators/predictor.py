"""Velocity Verlet with predicted velocities: second order also where forces depend on velocity.

v_1/2 = v + a dt/2, x' = x + v_1/2 dt, forces at (x', v + a dt), v' = v_1/2 + a' dt/2 (the form of velocity Verlet
for dissipative particle dynamics with lambda = 1: Groot & Warren 1997, Eq. 12). The tangential springs stretch by
the mean of the slip velocities at both ends of the step.
"""

from typing import NamedTuple

from engine.integrators.choice import begin, correct, kick, lead, predict, settles, share
from engine.laws import turns


class Predictor(NamedTuple):
    """Second order on smooth stretches; half the stability limit of velocity Verlet for sliding friction."""


@begin.law(Predictor)
def _first_half(integrator, model, people, near, touch, n, before, dt):
    kick(turns(model.rotation), people, n, 0.5 * dt)


@predict.law(Predictor)
def _full_step(integrator, turning, people, n, dt):
    for i in range(n):
        people.fx_before[i], people.fy_before[i] = people.fx[i], people.fy[i]
        people.torque_before[i] = people.torque[i]
    kick(turning, people, n, 0.5 * dt)


@correct.law(Predictor)
def _mean_force(integrator, turning, people, n, dt):
    for i in range(n):
        people.vx[i] += 0.5 * dt * (people.fx[i] - people.fx_before[i]) * people.ease[i]
        people.vy[i] += 0.5 * dt * (people.fy[i] - people.fy_before[i]) * people.ease[i]
        if turning:
            people.spin[i] += 0.5 * dt * (people.torque[i] - people.torque_before[i]) * people.ease_to_turn[i]


@lead.law(Predictor)
def _half_a_step(integrator):
    return 0.5


@settles.law(Predictor)
def _evaluates(integrator):
    return False


@share.law(Predictor)
def _half_of_it(integrator):
    return 0.5
