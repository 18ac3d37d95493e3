"""Whether a crowd is at rest for good, so that waiting for somebody to get out is idle."""

import math

from engine.compiled import step_function
from engine.laws import limit, normal, sliding, turns

CREEP = 1e-3  # m; whoever may still move farther is not at rest
SAFETY = 2.0  # on what may still change


@step_function
def at_rest(model, scene, people, n, near, wait):
    """Whether nothing but creep can happen within `wait` (s), if nobody moves faster than now.

    Nobody is as close to an exit's line as they may creep, and no contact is as close to the limit of its friction
    as its forces may change while its two surfaces creep at their present velocities. What is left is a body of
    springs and dampers that comes to rest, or goes on creeping where friction has no limit. Who touches nobody may
    spin: nothing stops that.
    """
    creep = 0.0
    for i in range(n):
        creep = max(creep, SAFETY * wait * math.sqrt(people.vx[i] ** 2 + people.vy[i] ** 2))
    if not creep < CREEP:
        return False
    for k in range(scene.exits.shape[0]):
        lines = scene.exits
        for i in range(n):
            ahead = (lines[k, 0] - people.x[i]) * lines[k, 5] + (lines[k, 1] - people.y[i]) * lines[k, 6]
            if people.out[i] > 0 or abs(ahead) < creep:
                return False
    turning = turns(model.rotation)
    for p in range(near.i.size):
        a, b = near.i[p], near.j[p]
        dx, dy = people.x[a] - people.x[b], people.y[a] - people.y[b]
        distance = math.sqrt(dx * dx + dy * dy)
        overlap = people.radius[a] + people.radius[b] - distance
        if overlap > 0.0:
            nx, ny = dx / distance, dy / distance
            ux, uy = people.vx[a] - people.vx[b], people.vy[a] - people.vy[b]
            v_n, v_t = ux * nx + uy * ny, uy * nx - ux * ny
            if turning:
                v_t -= people.radius[a] * people.spin[a] + people.radius[b] * people.spin[b]
            r = people.radius[a] * people.radius[b] / (people.radius[a] + people.radius[b])
            m = people.mass[a] * people.mass[b] / (people.mass[a] + people.mass[b])
            if _may_slip(model.normal, model.sliding, overlap, r, m, v_n, v_t, near.slip[p], SAFETY * wait):
                return False
    for p in range(near.wall_i.size):
        a, w = near.wall_i[p], near.wall[p]
        x0, y0, ux, uy = scene.walls[w, 0], scene.walls[w, 1], scene.walls[w, 2], scene.walls[w, 3]
        along = (people.x[a] - x0) * ux + (people.y[a] - y0) * uy
        along = min(max(along, 0.0), scene.walls[w, 4])
        dx, dy = people.x[a] - x0 - along * ux, people.y[a] - y0 - along * uy
        distance, r = math.sqrt(dx * dx + dy * dy), people.radius[a]
        if r > distance:
            nx, ny = dx / distance, dy / distance
            v_n = people.vx[a] * nx + people.vy[a] * ny
            v_t = people.vy[a] * nx - people.vx[a] * ny
            if turning:
                v_t -= r * people.spin[a]
            m, slip = people.mass[a], near.wall_slip[p]
            if _may_slip(model.wall_normal, model.wall_sliding, r - distance, r, m, v_n, v_t, slip, SAFETY * wait):
                return False
    return True


@step_function
def _may_slip(pressing, rubbing, overlap, radius, mass, v_n, v_t, slip, wait):
    """Whether a contact may reach the limit of its friction, or end, within `wait`."""
    later = overlap - v_n * wait
    if later <= 0.0 or abs(v_t) * wait > CREEP:
        return True
    F_n, F_n_later = normal(pressing, overlap, radius, mass, v_n), normal(pressing, later, radius, mass, 0.0)
    F_t, _ = sliding(rubbing, overlap, radius, mass, v_t, F_n, slip)
    F_t_later, _ = sliding(rubbing, later, radius, mass, v_t, F_n_later, slip + v_t * wait)
    most = limit(rubbing, F_n_later)
    return abs(F_t) >= limit(rubbing, F_n) or abs(F_t_later) >= most or 2.0 * abs(F_t_later - F_t) > most - abs(F_t)
