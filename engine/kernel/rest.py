"""Whether a crowd is at rest for good, so that waiting for somebody to get out is idle."""

from engine.kernel.compiled import entry_point, step_function
from engine.kernel.contacts import relative_velocity
from engine.kernel.laws import friction, has_history, is_present, normal
from engine.kernel.laws.friction import friction_limit

CREEP = 1e-3  # m; whoever may still move farther is not at rest
SAFETY = 2.0  # on what may still change


@entry_point
def at_rest(model, exits, persons, pairs, wall_pairs, contacts, states, wait):
    """Whether nothing but creep can happen within `wait` (s), if nobody moves faster than now.

    Nobody is as close to an exit's line as they may creep, and no contact is as close to the limit of its friction as
    its forces may change while its two surfaces creep at their present velocities. What is left is a body of springs
    and dampers that comes to rest, or goes on creeping where friction has no limit. Who touches nobody may
    spin.
    """
    state = states[0]
    creep = SAFETY * wait * state.speed
    if not creep < CREEP:
        return False
    for k in range(exits.size):
        line = exits[k]
        for i in range(state.n):
            ahead = (line.x0 - persons.x[i]) * line.nx + (line.y0 - persons.y[i]) * line.ny
            if persons.exited[i] > 0 or abs(ahead) < creep:
                return False
    between, every = state.contacts, state.contacts + state.wall_contacts
    rotating, wait = is_present(model.rotation), SAFETY * wait
    springs, wall_springs = pairs.history, wall_pairs.history
    slips = _some_may_slip(model.friction, model.normal, persons, contacts, 0, between, springs, rotating, wait)
    return not slips and not _some_may_slip(
        model.wall_friction, model.wall_normal, persons, contacts, between, every, wall_springs, rotating, wait
    )


@step_function
def _some_may_slip(friction_law, normal_law, persons, contacts, first, last, springs, rotating, wait):
    """Whether a contact may reach the limit of its friction, or end, within `wait`."""
    for k in range(first, last):
        c = contacts[k]
        spring = springs[c.entry] if has_history(friction_law) else 0.0
        v_n, v_t = relative_velocity(persons, c, rotating)
        later = c.overlap - v_n * wait
        if later <= 0.0 or abs(v_t) * wait > CREEP:
            return True
        F_n = normal(normal_law, c.overlap, c.radius, c.mass, v_n)
        F_n_later = normal(normal_law, later, c.radius, c.mass, 0.0)
        F_t, _ = friction(friction_law, c.overlap, c.radius, c.mass, v_t, F_n, spring)
        F_t_later, _ = friction(friction_law, later, c.radius, c.mass, v_t, F_n_later, spring + v_t * wait)
        limit = friction_limit(friction_law, c.overlap, c.radius, c.mass, F_n)
        limit_later = friction_limit(friction_law, later, c.radius, c.mass, F_n_later)
        if abs(F_t) >= limit or abs(F_t_later) >= limit_later or 2.0 * abs(F_t_later - F_t) > limit_later - abs(F_t):
            return True
    return False
