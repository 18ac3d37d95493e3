"""Leapfrog that solves for what depends on velocity: long steps with stiff friction.

Velocities stand between the steps, places and forces of position (social force, springs) on them:

    m (v' - v)/h = F(x) + [drive(v) + drive(v')]/2 + damping(v') + friction(v'),    x' = x + h v'

The drive is taken by the trapezoid rule and stays second order. Damping and friction are taken at the new
velocity (implicit Euler), so that no step is too long for them and a person who is pushed against friction creeps as
fast as the laws say. The contacts are solved one after the other with what is known of the others (Gauss-Seidel
on impulses; Moreau & Jean's contact dynamics), each exactly, by its law. Contacts whose friction is a spring are
soft enough to be taken as they are, at the old velocity.
"""

from typing import NamedTuple

from engine.compiled import step_function
from engine.integrators.choice import begin, correct, lead, predict, settles, share
from engine.laws import drive, drive_rate, normal_damping, sliding, sliding_damping, turns

SWEEPS = 8  # over the contacts, at most
STILL = 1e-3  # m/s: change of a slip velocity at which the sweeps end
EXACT = 1e-5  # m/s: error of the solution of one contact
TRIES = 60


class SemiImplicit(NamedTuple):
    """First order where friction acts, second order elsewhere; no friction without a spring limits its step."""


@begin.law(SemiImplicit)
def _leap(integrator, model, people, near, touch, n, before, dt):
    h = 0.5 * (before + dt)
    _kick_and_drive(model, people, n, h)
    if touch.counts[0] + touch.counts[1] > 0 and h > 0.0:
        _settle(model, people, near, touch, h)


@predict.law(SemiImplicit)
def _as_they_are(integrator, turning, people, n, dt):
    pass


@correct.law(SemiImplicit)
def _in_the_next_step(integrator, turning, people, n, dt):
    pass


@lead.law(SemiImplicit)
def _no_lead(integrator):
    return 0.0


@settles.law(SemiImplicit)
def _solves(integrator):
    return True


@share.law(SemiImplicit)
def _half_of_it(integrator):
    return 0.5


@step_function
def _kick_and_drive(model, people, n, h):
    """Velocities after the forces of position and the drive, but for the contacts."""
    faster = 1.0 / (1.0 + 0.5 * h * drive_rate(model.drive))
    for i in range(n):
        push = drive(model.drive, people.mass[i], people.v_d[i], people.ex[i], people.vx[i])
        people.vx[i] += h * faster * people.ease[i] * (people.fx[i] + push)
    for i in range(n):
        push = drive(model.drive, people.mass[i], people.v_d[i], people.ey[i], people.vy[i])
        people.vy[i] += h * faster * people.ease[i] * (people.fy[i] + push)
    if turns(model.rotation):
        for i in range(n):
            people.spin[i] += h * people.torque[i] * people.ease_to_turn[i]


@step_function
def _settle(model, people, near, touch, h):
    """Find the impulses of all contacts; the springs keep what their laws leave them."""
    vx, vy, spin, radius = people.vx, people.vy, people.spin, people.radius
    faster, turning = 1.0 / (1.0 + 0.5 * h * drive_rate(model.drive)), turns(model.rotation)
    pairs, walls = touch.counts[0], touch.counts[1]
    for t in range(pairs + walls):
        touch.J_n[t], touch.J_t[t] = 0.0, 0.0
    for _sweep in range(SWEEPS):
        change = 0.0
        for t in range(pairs):
            a, b, nx, ny, m = touch.a[t], touch.b[t], touch.nx[t], touch.ny[t], touch.mass[t]
            ux, uy = vx[a] - vx[b], vy[a] - vy[b]
            v_n, v_t = ux * nx + uy * ny, uy * nx - ux * ny
            ease = faster / m
            ease_t = ease
            if turning:
                v_t -= radius[a] * spin[a] + radius[b] * spin[b]
                ease_t += radius[a] ** 2 * people.ease_to_turn[a] + radius[b] ** 2 * people.ease_to_turn[b]
            free_n, free_t = v_n - ease * touch.J_n[t], v_t - ease_t * touch.J_t[t]
            r, overlap, F_n = touch.radius[t], touch.overlap[t], touch.F_n[t]
            damping = h * m * normal_damping(model.normal, overlap, r, m)
            J_n = -damping * free_n / (1.0 + damping * ease)
            J_t, u, slip = _friction(
                model.sliding, overlap, r, m, F_n + J_n / h, touch.slip[t], free_t, ease_t, h, touch.u[t]
            )
            d_n, d_t = J_n - touch.J_n[t], J_t - touch.J_t[t]
            touch.J_n[t], touch.J_t[t], touch.u[t], near.slip[touch.place[t]] = J_n, J_t, u, slip
            jx, jy = (d_n * nx - d_t * ny) * faster, (d_n * ny + d_t * nx) * faster
            vx[a] += jx * people.ease[a]
            vy[a] += jy * people.ease[a]
            vx[b] -= jx * people.ease[b]
            vy[b] -= jy * people.ease[b]
            if turning:
                spin[a] -= radius[a] * d_t * people.ease_to_turn[a]
                spin[b] -= radius[b] * d_t * people.ease_to_turn[b]
            change = max(change, abs(d_n) * ease, abs(d_t) * ease_t)
        for t in range(pairs, pairs + walls):
            a, nx, ny, m, r = touch.a[t], touch.nx[t], touch.ny[t], touch.mass[t], touch.radius[t]
            v_n, v_t = vx[a] * nx + vy[a] * ny, vy[a] * nx - vx[a] * ny
            ease = faster / m
            ease_t = ease
            if turning:
                v_t -= r * spin[a]
                ease_t += r**2 * people.ease_to_turn[a]
            free_n, free_t = v_n - ease * touch.J_n[t], v_t - ease_t * touch.J_t[t]
            overlap, F_n = touch.overlap[t], touch.F_n[t]
            damping = h * m * normal_damping(model.wall_normal, overlap, r, m)
            J_n = -damping * free_n / (1.0 + damping * ease)
            J_t, u, slip = _friction(
                model.wall_sliding, overlap, r, m, F_n + J_n / h, touch.slip[t], free_t, ease_t, h, touch.u[t]
            )
            d_n, d_t = J_n - touch.J_n[t], J_t - touch.J_t[t]
            touch.J_n[t], touch.J_t[t], touch.u[t], near.wall_slip[touch.place[t]] = J_n, J_t, u, slip
            vx[a] += (d_n * nx - d_t * ny) * ease
            vy[a] += (d_n * ny + d_t * nx) * ease
            if turning:
                spin[a] -= r * d_t * people.ease_to_turn[a]
            change = max(change, abs(d_n) * ease, abs(d_t) * ease_t)
        if change < STILL:
            break


@step_function
def _friction(law, overlap, radius, mass, F_n, slip, free, ease, h, u):
    """Impulse of friction that a contact ends with, N s, with its slip velocity, m/s, and its spring's slip, m.

    The slip velocity solves u = free + h ease F_t(u). F_t falls with u, so the left side less the right rises at
    least as fast as u, and the one root lies between u and u less the difference there: false position (Illinois)
    between the two.

    Parameters
    ----------
    free : slip velocity that there would be without this impulse, m/s
    ease : change of the slip velocity by a unit impulse, 1/kg
    u : where to begin
    """
    damping = mass * sliding_damping(law, overlap, radius, mass)
    if damping > 0.0:
        u = free / (1.0 + h * ease * damping)  # at once the solution where friction is linear
    F_t, stretched = sliding(law, overlap, radius, mass, u, F_n, slip)
    d = u - free - h * ease * F_t
    if abs(d) > EXACT:
        other, d_other, u = u, d, u - d
        F_t, stretched = sliding(law, overlap, radius, mass, u, F_n, slip)
        d = u - free - h * ease * F_t
        for _ in range(TRIES):
            if not abs(d) > EXACT:
                break
            last, d_last = u, d
            u = (d_other * u - d * other) / (d_other - d)
            F_t, stretched = sliding(law, overlap, radius, mass, u, F_n, slip)
            d = u - free - h * ease * F_t
            if d * d_last < 0.0:
                other, d_other = last, d_last
            else:
                d_other *= 0.5
    return h * F_t, u, stretched
