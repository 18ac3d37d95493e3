"""Velocity Verlet with predicted velocities: second order also where forces depend on velocity.

v_1/2 = v + a dt/2, x' = x + v_1/2 dt, forces at (x', v + a dt), v' = v_1/2 + a' dt/2 (the form of velocity Verlet
for dissipative particle dynamics with lambda = 1: Groot & Warren 1997, Eq. 12). The tangential springs stretch by
the mean of the slip velocities at both ends of the step.
"""

from typing import NamedTuple

from engine.integrators.choice import correct, kick, lead, predict


class Predictor(NamedTuple):
    """Second order on smooth stretches; half the stability limit of velocity Verlet for sliding friction."""


@predict.law(Predictor)
def _full_step(integrator, turning, people, n, dt):
    for i in range(n):
        people.fx_before[i], people.fy_before[i] = people.fx[i], people.fy[i]
        people.torque_before[i] = people.torque[i]
    kick(turning, people, n, 0.5 * dt)


@correct.law(Predictor)
def _mean_force(integrator, turning, people, n, dt):
    for i in range(n):
        people.vx[i] += 0.5 * dt * (people.fx[i] - people.fx_before[i]) / people.mass[i]
        people.vy[i] += 0.5 * dt * (people.fy[i] - people.fy_before[i]) / people.mass[i]
        if turning:
            people.spin[i] += 0.5 * dt * (people.torque[i] - people.torque_before[i]) / people.inertia[i]


@lead.law(Predictor)
def _half_a_step(integrator):
    return 0.5
