"""One contact: the closest point of a wall, how fast two bodies part and slide, and how a force acts on both."""

from engine.kernel.compiled import inlined_function, step_function


@inlined_function
def from_closest_point(walls, w, x, y):
    """From the closest point of wall w to (x, y), m, and which end of it that is (-1: neither)."""
    wall = walls[w]
    x0, y0, ux, uy, length = wall.x0, wall.y0, wall.ux, wall.uy, wall.length
    along = (x - x0) * ux + (y - y0) * uy
    end = 0 if along <= 0.0 else (1 if along >= length else -1)
    along = min(max(along, 0.0), length)
    return x - x0 - along * ux, y - y0 - along * uy, end


@step_function
def end_acts(walls, joints, w, end, x, y, dx, dy):
    """Whether the end of wall w, seen from (x, y) at (dx, dy), acts for w.

    An end that lies on other walls acts once, for the first of them, and only if it is the closest point of each.
    """
    for k in range(joints.shape[2]):
        other = joints[w, end, k]
        if other < 0:
            break
        ox, oy, other_end = from_closest_point(walls, other, x, y)
        if other_end < 0 or other < w or (ox - dx) ** 2 + (oy - dy) ** 2 > 1e-16:
            return False
    return True


@inlined_function
def relative_velocity(persons, c, rotating):
    """Velocity at which the bodies of a contact part, and slip velocity of their surfaces, m/s."""
    return _relative(c, persons.vx, persons.vy, persons.spin, persons.radius, rotating)


@inlined_function
def extrapolated_velocity(persons, c, rotating, v_n, v_t, extrapolation):
    """The same extrapolated from the velocities of the step before."""
    before_n, before_t = _relative(
        c, persons.previous_x, persons.previous_y, persons.previous_spin, persons.radius, rotating
    )
    return v_n + extrapolation * (v_n - before_n), v_t + extrapolation * (v_t - before_t)


@inlined_function
def slip_of_turning(persons, c, rotating, v_n, v_t):
    """Slip velocity by which the middle of a step differs from its end, over half its length, m/s^2.

    The tangent of two persons turns while they slide along each other; that of a wall does not.
    """
    if c.wall >= 0:
        return 0.0
    r_i, r_j, u_t = persons.radius[c.i], persons.radius[c.j], v_t
    if rotating:
        u_t += r_i * persons.spin[c.i] + r_j * persons.spin[c.j]
    return v_n * u_t / (r_i + r_j - c.overlap)


@inlined_function
def add_to_sums(state, row, J_t, J_n, slip):
    """Count what a contact did in a step: impulses, N s, at a slip velocity, m/s."""
    J_t, J_n, slip = abs(J_t), abs(J_n), abs(slip)
    state.contact_sums[row, 0] += J_t
    state.contact_sums[row, 1] += J_n
    state.contact_sums[row, 2] += J_t * slip
    state.contact_sums[row, 3] += J_n * slip


@inlined_function
def _relative(c, vx, vy, spin, radius, rotating):
    i, j, nx, ny = c.i, c.j, c.nx, c.ny
    ux, uy, turn = vx[i], vy[i], 0.0
    if rotating:
        turn = radius[i] * spin[i]
    if c.wall < 0:
        ux -= vx[j]
        uy -= vy[j]
        if rotating:
            turn += radius[j] * spin[j]
    return ux * nx + uy * ny, uy * nx - ux * ny - turn


@inlined_function
def push(persons, c, F_n, F_t):
    """Add the forces of a contact to those on its bodies."""
    i, j, nx, ny = c.i, c.j, c.nx, c.ny
    fx, fy = F_n * nx - F_t * ny, F_n * ny + F_t * nx
    persons.fx[i] += fx
    persons.fy[i] += fy
    persons.torque[i] -= persons.radius[i] * F_t
    if c.wall < 0:
        persons.fx[j] -= fx
        persons.fy[j] -= fy
        persons.torque[j] -= persons.radius[j] * F_t


@inlined_function
def strike(persons, c, J_n, J_t, rotating, slowing):
    """Change the velocities of a contact's bodies by impulses, N s, the linear ones by `slowing` less."""
    i, j, nx, ny = c.i, c.j, c.nx, c.ny
    jx, jy = (J_n * nx - J_t * ny) * slowing, (J_n * ny + J_t * nx) * slowing
    persons.vx[i] += jx * persons.inv_mass[i]
    persons.vy[i] += jy * persons.inv_mass[i]
    if rotating:
        persons.spin[i] -= persons.radius[i] * J_t * persons.inv_inertia[i]
    if c.wall < 0:
        persons.vx[j] -= jx * persons.inv_mass[j]
        persons.vy[j] -= jy * persons.inv_mass[j]
        if rotating:
            persons.spin[j] -= persons.radius[j] * J_t * persons.inv_inertia[j]


@inlined_function
def inverse_masses(persons, c, rotating, slowing):
    """Change of the parting and of the slip velocity of a contact by a unit impulse, 1/kg."""
    linear = slowing / c.mass
    tangential = linear
    if rotating:
        tangential += persons.radius[c.i] ** 2 * persons.inv_inertia[c.i]
        if c.wall < 0:
            tangential += persons.radius[c.j] ** 2 * persons.inv_inertia[c.j]
    return linear, tangential
