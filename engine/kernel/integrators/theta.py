"""Leapfrog that solves for what depends on velocity: second order, and long steps with stiff friction.

Velocities stand between the steps, positions and what depends on them (social force, springs) on them:

    m (v' - v)/h = F(x) + [drive(v) + drive(v')]/2 + damping([w + w']/2) + friction((1 - theta) u + theta u'),

with x' = x + h v', w the velocity at which the bodies of a contact part, and u its slip velocity. Each contact has its
own theta, fitted to the rate z/h at which its friction would stop it alone: theta = 1/(1 - exp(-z)) - 1/z, by which a
single contact decays exactly (exponential fitting: Liniger & Willoughby 1970). It is 1/2 where friction is weak, the
trapezoid rule of second order, and 1 where it is stiff, implicit Euler, so that no step is too long for it; a person
who is pushed against friction creeps as fast as the laws say. The contacts are solved one after the other with what is
known of the others (Gauss-Seidel on impulses; Moreau & Jean's contact dynamics), each exactly, by its law, beginning
with the friction of the step before. Contacts whose friction is a spring are soft enough not to be solved: their
dampers are taken at the velocities extrapolated from the last two steps.
"""

from typing import NamedTuple

from engine.kernel.compiled import inlined_function, step_function
from engine.kernel.contacts import add_to_sums, inverse_masses, relative_velocity, strike
from engine.kernel.dispatch import only_for
from engine.kernel.exponential import exp
from engine.kernel.integrators.interface import begin, correct, predict
from engine.kernel.laws import drive, friction, is_present
from engine.kernel.laws.driving import drive_rate
from engine.kernel.laws.friction import needs_implicit, viscosity

MAX_SWEEPS = 60  # over the contacts
SINGLE = 0.01  # of the tolerance: error of the solution of one contact
MAX_ITERATIONS = 60
SLOW = 1e-6  # m/s, at which friction that is not linear is differentiated


class Theta(NamedTuple):
    """Second order, with friction that no step is too long for, unless it is a spring."""

    history_offset: float = 0.0
    solves_contacts: bool = True
    damping_fraction: float = 0.5


@begin.law(Theta)
def _leap(integrator, model, parameters, persons, pairs, wall_pairs, contacts, state, previous, dt):
    h, n, tolerance = 0.5 * (previous + dt), state.n, parameters.solver_tolerance
    slowing = 1.0 / (1.0 + 0.5 * h * drive_rate(model.drive))
    state.extrapolation = 0.5 * dt / h if h > 0.0 else 0.0
    for i in range(n):
        persons.previous_x[i], persons.previous_y[i] = persons.vx[i], persons.vy[i]
        persons.previous_spin[i] = persons.spin[i]
    for i in range(n):
        push = drive(model.drive, persons.mass[i], persons.v_d[i], persons.ex[i], persons.vx[i])
        persons.vx[i] += h * slowing * persons.inv_mass[i] * (persons.fx[i] + push)
    for i in range(n):
        push = drive(model.drive, persons.mass[i], persons.v_d[i], persons.ey[i], persons.vy[i])
        persons.vy[i] += h * slowing * persons.inv_mass[i] * (persons.fy[i] + push)
    if is_present(model.rotation):
        for i in range(n):
            persons.spin[i] += h * persons.torque[i] * persons.inv_inertia[i]
    if h == 0.0:
        return
    between, every, rotating = state.contacts, state.contacts + state.wall_contacts, is_present(model.rotation)
    p, w = pairs.history, wall_pairs.history
    _start(model.friction, persons, contacts, 0, between, p, rotating, h, slowing)
    _start(model.wall_friction, persons, contacts, between, every, w, rotating, h, slowing)
    for _sweep in range(MAX_SWEEPS):
        change = max(
            _sweep_over(model.friction, persons, contacts, 0, between, rotating, h, slowing, tolerance),
            _sweep_over(model.wall_friction, persons, contacts, between, every, rotating, h, slowing, tolerance),
        )
        if change < tolerance:
            break
    _keep(model.friction, contacts, 0, between, p, h, state, 0)
    _keep(model.wall_friction, contacts, between, every, w, h, state, 1)


@predict.law(Theta)
def _half_step_velocity(integrator, rotating, persons, n, dt):
    pass


@correct.law(Theta)
def _in_the_next_step(integrator, rotating, persons, n, dt):
    pass


@only_for(needs_implicit, otherwise=None)
def _start(law, persons, contacts, first, last, history, rotating, h, slowing):
    """Find each contact's theta, and let the friction of the step before act."""
    for k in range(first, last):
        c = contacts[k]
        c.inv_mass_n, c.inv_mass_t = inverse_masses(persons, c, rotating, slowing)
        rate = viscosity(law, c.overlap)
        if rate == 0.0:
            rate = -friction(law, c.overlap, c.radius, c.mass, SLOW, c.F_elastic, 0.0)[0] / SLOW
        c.theta = _theta(h * c.inv_mass_t * rate)
        c.J_n, c.J_t = 0.0, h * history[c.entry] * c.F_elastic
        if c.J_t != 0.0:
            strike(persons, c, 0.0, c.J_t, rotating, slowing)


@inlined_function
def _theta(z):
    """Weight of the new velocity by which one contact decays as exp(-z)."""
    return 0.5 + z / 12.0 if z < 1e-2 else 1.0 / (1.0 - exp(-z)) - 1.0 / z


@only_for(needs_implicit, otherwise=0.0)
def _sweep_over(law, persons, contacts, first, last, rotating, h, slowing, tolerance):
    """Solve each contact once; returns the largest change of a velocity, m/s."""
    change = 0.0
    for k in range(first, last):
        c = contacts[k]
        v_n, v_t = relative_velocity(persons, c, rotating)
        free_n, free_t = v_n - c.inv_mass_n * c.J_n, v_t - c.inv_mass_t * c.J_t
        damping = 0.5 * h * c.damping
        J_n = -damping * (c.v_n + free_n) / (1.0 + damping * c.inv_mass_n)
        free = c.v_t + c.theta * (free_t - c.v_t)
        J_t, c.slip = _friction_impulse(law, c, c.F_elastic + J_n / h, free, c.theta * c.inv_mass_t, h, tolerance)
        d_n, d_t = J_n - c.J_n, J_t - c.J_t
        c.J_n, c.J_t = J_n, J_t
        strike(persons, c, d_n, d_t, rotating, slowing)
        change = max(change, abs(d_n) * c.inv_mass_n, abs(d_t) * c.inv_mass_t)
    return change


@only_for(needs_implicit, otherwise=None)
def _keep(law, contacts, first, last, history, h, state, at_walls):
    """Keep the friction of this step over the normal force, for the next."""
    for k in range(first, last):
        c = contacts[k]
        history[c.entry] = c.J_t / (h * c.F_elastic) if c.F_elastic > 0.0 else 0.0
        add_to_sums(state, at_walls, c.J_t, h * c.F_elastic + c.J_n, c.slip)


@step_function
def _friction_impulse(law, c, F_n, free, inv_mass, h, tolerance):
    """Impulse of friction that a contact ends with, N s, and the slip velocity at which it acts, m/s.

    The slip velocity solves u = free + h inv_mass F_t(u). F_t falls with u, so the left side less the right rises at
    least as fast as u, and the one root lies between u and u less the difference there: false position (Illinois)
    between the two.

    Parameters
    ----------
    free : float
        Slip velocity that there would be without this impulse, m/s.
    inv_mass : float
        Change of the slip velocity by a unit impulse, 1/kg.
    tolerance : float
        Of the solution of all contacts, m/s.
    """
    overlap, radius, mass, u = c.overlap, c.radius, c.mass, c.slip
    linear = viscosity(law, overlap)
    if linear > 0.0:
        u = free / (1.0 + h * inv_mass * linear)  # the solution
    F_t, _ = friction(law, overlap, radius, mass, u, F_n, 0.0)
    d = u - free - h * inv_mass * F_t
    if abs(d) > SINGLE * tolerance:
        other, d_other, u = u, d, u - d
        F_t, _ = friction(law, overlap, radius, mass, u, F_n, 0.0)
        d = u - free - h * inv_mass * F_t
        for _iteration in range(MAX_ITERATIONS):
            if not abs(d) > SINGLE * tolerance:
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
