"""Lin's model in plain numpy, all pairs at once, written for reading and not for speed.

Shares no code with the engine: forces are N x N arrays, walls are segments taken one by one.
"""

import numpy as np


class Reference:
    """Persons as arrays (N,), integrated by velocity Verlet with half-step velocities in the forces."""

    def __init__(self, scenario):
        self.model, self.dt = scenario.model, scenario.numerics.dt
        self.walls, self.exit = scenario.scene.walls, scenario.scene.exits[0]
        start = scenario.crowd.draw(scenario.seed, walls=None)
        self.x = np.stack([start.x, start.y], axis=1)
        self.v = np.stack([start.vx, start.vy], axis=1)
        self.w, self.r, self.m, self.v_d = start.spin, start.radius, start.mass, start.v_d
        self.inertia = self.model.rotation.inertia_factor * self.m * self.r**2
        N = len(self.r)
        self.displacement, self.wall_displacement = np.zeros((N, N)), np.zeros((len(self.walls), N))
        self.force, self.torque = self.forces(0.0)

    def step(self):
        """Advance by dt."""
        self.v += 0.5 * self.dt * self.force / self.m[:, None]
        self.w += 0.5 * self.dt * self.torque / self.inertia
        self.x += self.dt * self.v
        self.force, self.torque = self.forces(self.dt)
        self.v += 0.5 * self.dt * self.force / self.m[:, None]
        self.w += 0.5 * self.dt * self.torque / self.inertia

    def forces(self, dt):
        """Force (N, 2) and torque (N,) on everybody; springs stretch for dt."""
        e = self.direction()
        force = self.m[:, None] * (self.v_d[:, None] * e - self.v) / self.model.drive.tau
        torque = np.zeros(len(self.r))
        for part, turn in (self.persons(e, dt), *(self.wall(k, dt) for k in range(len(self.walls)))):
            force, torque = force + part, torque + turn
        return force, torque

    def direction(self):
        """Unit vectors to the nearest point of the exit, shortened by r at both ends."""
        (x0, low), (_, high) = self.exit.start, self.exit.end
        aim = np.stack([np.full_like(self.r, x0), np.clip(self.x[:, 1], low + self.r, high - self.r)], axis=1)
        way = aim - self.x
        return way / np.linalg.norm(way, axis=1)[:, None]

    def persons(self, e, dt):
        """Social and contact forces of all pairs."""
        apart = self.x[:, None] - self.x[None, :]
        d = np.linalg.norm(apart, axis=2) + np.eye(len(self.r)) * 1e9
        n = apart / d[..., None]
        gap = d - self.r[:, None] - self.r[None, :]
        cos_beta = -np.einsum("ik,ijk->ij", e, n)
        social = self.model.social.A * np.exp(-gap / self.model.social.B) * (1 + self.model.anisotropy.phi * cos_beta)
        radius = self.r[:, None] * self.r / (self.r[:, None] + self.r)
        mass = self.m[:, None] * self.m / (self.m[:, None] + self.m)
        u = self.v[:, None] - self.v[None, :]
        of_spin = self.r[:, None] * self.w[:, None] + (self.r * self.w)[None, :]
        laws = self.model.normal, self.model.friction
        F_n, F_t, self.displacement = contact(*laws, -gap, radius, mass, n, u, of_spin, self.displacement, dt)
        t = np.stack([-n[..., 1], n[..., 0]], axis=-1)
        force = (social + F_n)[..., None] * n + F_t[..., None] * t
        return force.sum(axis=1), -self.r * F_t.sum(axis=1)

    def wall(self, k, dt):
        """Social and contact forces of one wall, through its closest point."""
        a, b = np.array(self.walls[k][:2]), np.array(self.walls[k][2:])
        along = np.clip((self.x - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        apart = self.x - (a + along[:, None] * (b - a))
        d = np.linalg.norm(apart, axis=1)
        n, gap = apart / d[:, None], d - self.r
        social = self.model.wall_social.A * np.exp(-gap / self.model.wall_social.B)
        laws = self.model.wall_normal, self.model.wall_friction
        state = self.r, self.m, n, self.v, self.r * self.w, self.wall_displacement[k], dt
        F_n, F_t, self.wall_displacement[k] = contact(*laws, -gap, *state)
        t = np.stack([-n[:, 1], n[:, 0]], axis=1)
        return (social + F_n)[:, None] * n + F_t[:, None] * t, -self.r * F_t


def contact(normal, friction, overlap, radius, mass, n, u, of_spin, displacement, dt):
    """Normal and tangential force, and the new displacements of the springs."""
    touch = overlap > 0
    alpha = np.sqrt(np.where(touch, overlap, 0.0) * radius)
    v_n = (u * n).sum(axis=-1)
    v_t = u[..., 1] * n[..., 0] - u[..., 0] * n[..., 1] - of_spin
    F_n = alpha * (normal.k_n * overlap - mass * normal.g_n * v_n)
    if not hasattr(friction, "k_t"):
        return F_n, -friction.mu * np.abs(F_n) * np.tanh(v_t / friction.v_0), displacement
    displacement = np.where(touch, displacement + v_t * dt, 0.0)
    F_t = -alpha * (friction.k_t * displacement + mass * friction.g_t * v_t)
    limit = friction.mu * np.abs(F_n)
    slips = np.abs(F_t) > limit
    kind, sign = type(friction).__name__, np.sign(F_t)
    damping = -sign * alpha * mass * friction.g_t * v_t
    tooth = np.where(slips, limit - damping, 1.0)
    spring = np.where(tooth > 0.0, np.mod(abs(F_t) - limit, np.where(tooth > 0.0, tooth, 1.0)), 0.0)
    if kind == "MindlinReset":
        F_t = np.where(slips, sign * np.where(tooth > 0.0, np.maximum(spring + damping, -limit), limit), F_t)
        rest = -sign * spring / (np.where(touch, alpha, 1.0) * friction.k_t)
    else:
        F_t = np.where(slips, sign * limit, F_t)
        rest = -(F_t / np.where(touch, alpha, 1.0) + mass * friction.g_t * v_t) / friction.k_t
    return F_n, F_t, np.where(slips, rest, displacement)
