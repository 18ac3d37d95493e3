"""Leapfrog that solves for what depends on velocity: long steps with stiff friction.

Velocities stand between the steps, positions and what depends on them (social force, springs) on them:

    m (v' - v)/h = F(x) + [drive(v) + drive(v')]/2 + damping(v') + friction(v'),    x' = x + h v'

The drive is taken by the trapezoid rule and stays second order. Damping and friction are taken at the new velocity
(implicit Euler), so that no step is too long for them and a person who is pushed against friction creeps as fast as the
laws say. The contacts are solved one after the other with what is known of the others (Gauss-Seidel on impulses; Moreau
& Jean's contact dynamics), each exactly, by its law. Contacts whose friction is a spring are soft enough to be taken as
they are, at the old velocity.
"""

from typing import NamedTuple

from engine.kernel.compiled import step_function
from engine.kernel.contacts import inverse_masses, relative_velocity, strike
from engine.kernel.dispatch import only_for
from engine.kernel.integrators.interface import begin, correct, predict
from engine.kernel.laws import drive, friction, is_present
from engine.kernel.laws.driving import drive_rate
from engine.kernel.laws.friction import needs_implicit, viscosity

MAX_SWEEPS = 8  # over the contacts
STILL = 1e-3  # m/s: change of a slip velocity at which the sweeps end
EXACT = 1e-5  # m/s: error of the solution of one contact
MAX_ITERATIONS = 60


class SemiImplicit(NamedTuple):
    """First order where friction acts, second order elsewhere; no friction without a spring limits its step."""

    history_offset: float = 0.0
    solves_contacts: bool = True
    damping_fraction: float = 0.5


@begin.law(SemiImplicit)
def _leap(integrator, model, persons, contacts, state, previous, dt):
    h, n = 0.5 * (previous + dt), state.n
    slowing = 1.0 / (1.0 + 0.5 * h * drive_rate(model.drive))
    for i in range(n):
        push = drive(model.drive, persons.mass[i], persons.v_d[i], persons.ex[i], persons.vx[i])
        persons.vx[i] += h * slowing * persons.inv_mass[i] * (persons.fx[i] + push)
    for i in range(n):
        push = drive(model.drive, persons.mass[i], persons.v_d[i], persons.ey[i], persons.vy[i])
        persons.vy[i] += h * slowing * persons.inv_mass[i] * (persons.fy[i] + push)
    if is_present(model.rotation):
        for i in range(n):
            persons.spin[i] += h * persons.torque[i] * persons.inv_inertia[i]
    between, every, rotating = state.contacts, state.contacts + state.wall_contacts, is_present(model.rotation)
    for _sweep in range(MAX_SWEEPS if h > 0.0 else 0):
        change = max(
            _sweep_over(model.friction, persons, contacts, 0, between, rotating, h, slowing),
            _sweep_over(model.wall_friction, persons, contacts, between, every, rotating, h, slowing),
        )
        if change < STILL:
            break


@predict.law(SemiImplicit)
def _half_step_velocity(integrator, rotating, persons, n, dt):
    pass


@correct.law(SemiImplicit)
def _in_the_next_step(integrator, rotating, persons, n, dt):
    pass


@only_for(needs_implicit, otherwise=0.0)
def _sweep_over(law, persons, contacts, first, last, rotating, h, slowing):
    """Solve each contact once; returns the largest change of a velocity, m/s."""
    change = 0.0
    for k in range(first, last):
        c = contacts[k]
        v_n, v_t = relative_velocity(persons, c, rotating)
        inv_mass_n, inv_mass_t = inverse_masses(persons, c, rotating, slowing)
        free_n, free_t = v_n - inv_mass_n * c.J_n, v_t - inv_mass_t * c.J_t
        damping = h * c.damping
        J_n = -damping * free_n / (1.0 + damping * inv_mass_n)
        J_t, c.v_t = _friction_impulse(law, c, c.F_elastic + J_n / h, free_t, inv_mass_t, h)
        d_n, d_t = J_n - c.J_n, J_t - c.J_t
        c.J_n, c.J_t = J_n, J_t
        strike(persons, c, d_n, d_t, rotating, slowing)
        change = max(change, abs(d_n) * inv_mass_n, abs(d_t) * inv_mass_t)
    return change


@step_function
def _friction_impulse(law, c, F_n, free, inv_mass, h):
    """Impulse of friction that a contact ends with, N s, and its slip velocity, m/s.

    The slip velocity solves u = free + h inv_mass F_t(u). F_t falls with u, so the left side less the right rises at
    least as fast as u, and the one root lies between u and u less the difference there: false position (Illinois)
    between the two.

    Parameters
    ----------
    free : float
        Slip velocity that there would be without this impulse, m/s.
    inv_mass : float
        Change of the slip velocity by a unit impulse, 1/kg.
    """
    overlap, radius, mass, u = c.overlap, c.radius, c.mass, c.v_t
    linear = viscosity(law, overlap)
    if linear > 0.0:
        u = free / (1.0 + h * inv_mass * linear)  # the solution
    F_t, _ = friction(law, overlap, radius, mass, u, F_n, 0.0)
    d = u - free - h * inv_mass * F_t
    if abs(d) > EXACT:
        other, d_other, u = u, d, u - d
        F_t, _ = friction(law, overlap, radius, mass, u, F_n, 0.0)
        d = u - free - h * inv_mass * F_t
        for _iteration in range(MAX_ITERATIONS):
            if not abs(d) > EXACT:
                break
            last, d_last = u, d
            u = (d_other * u - d * other) / (d_other - d)
            F_t, _ = friction(law, overlap, radius, mass, u, F_n, 0.0)
            d = u - free - h * inv_mass * F_t
            if d * d_last < 0.0:
                other, d_other = last, d_last
            else:
                d_other *= 0.5
    return h * F_t, u
