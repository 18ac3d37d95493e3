"""Scenes without walls to leave by: what two bodies, or a box of them, do to each other."""

import numpy as np

from engine import Crowd, Options, Scenario, Scene, laws, models
from engine.kernel.scene_arrays import as_arrays
from engine.rooms import square_room

PAPERS = {"integrator": "velocity_verlet", "force_tolerance": 1e-3}  # numerics of Lin et al., at any step
# A kernel is compiled for the types of a model's laws, so what is not wanted is switched off by numbers.
UNDRIVEN = {"tau": 1e30, "A": 0.0}  # s, N
SMOOTH = {"g_n": 0.0, "g_t": 0.0, "mu": 0.0}
NO_WALLS = as_arrays(Scene()).walls


def passive(case, dt=None, every=None, contacts=False, friction="kept"):
    """The scenario of a case of tests/oracle/cases.py: contacts only, nobody drives."""
    dt = case["dt"] if dt is None else dt
    normal = laws.Hertz(case["k_n"], case["g_n"])
    model = models.lin_dem(**UNDRIVEN, friction=friction, wall_friction=friction)
    tangential = type(model.friction)(case["k_t"], case["g_t"], case["mu"])
    contact = {"normal": normal, "friction": tangential, "wall_normal": normal, "wall_friction": tangential}
    crowd = Crowd.given(**{k: np.array(case[k]) for k in ("x", "y", "vx", "vy", "spin", "radius", "mass")}, v_d=0.0)
    every = dt if every is None else every
    options = Options(**PAPERS, dt=dt, time_limit=case["t_end"], record_every=every, contacts=contacts)
    return Scenario(box(case["box"]) if case["box"] else Scene(), crowd, model._replace(**contact), options)


def box(sides):
    """A closed box x0, x1, y0, y1."""
    x0, x1, y0, y1 = sides
    return Scene(((x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)))


def energy(run):
    """Kinetic energy and that of the springs at every sample, J (M,)."""
    samples, start, model = run.samples, run.start, run.scenario.model
    inertia = model.rotation.inertia_factor * start.mass * start.radius**2
    kinetic = 0.5 * start.mass * (samples.vx**2 + samples.vy**2) + 0.5 * inertia * samples.spin**2
    return kinetic.sum(axis=1) + _springs(run)


def _springs(run):
    samples, model, walls = run.samples, run.scenario.model, run.scenario.scene.walls
    stored, first = np.zeros(samples.time.size), 0
    for k, size in enumerate(samples.row_size):
        for c in range(first, first + size):
            overlap, radius = _touch(run, k, samples.contact_i[c], samples.contact_j[c], walls)
            alpha = np.sqrt(radius * overlap)
            stored[k] += 0.4 * model.normal.k_n * alpha * overlap**2
            stored[k] += 0.5 * model.friction.k_t * alpha * samples.tangential_displacement[c] ** 2
        first += size
    return stored


def _touch(run, k, i, j, walls):
    x, y, r = run.samples.x[k], run.samples.y[k], run.start.radius
    if j >= 0:
        return r[i] + r[j] - np.hypot(x[i] - x[j], y[i] - y[j]), r[i] * r[j] / (r[i] + r[j])
    x0, y0, x1, y1 = walls[-1 - j]
    distance = abs((x1 - x0) * (y[i] - y0) - (y1 - y0) * (x[i] - x0)) / np.hypot(x1 - x0, y1 - y0)
    return r[i] - distance, r[i]


def stiffening(run):
    """Work that pressing does on tangential springs up to every sample, J (M,): d(alpha) k_t displacement^2 / 2.

    Mindlin's spring k_t sqrt(R overlap) stiffens while it is held, and takes up energy that no force pays for;
    it gives it back when the two part.
    """
    k_t, walls = run.scenario.model.friction.k_t, run.scenario.scene.walls
    work, before, first = np.zeros(run.samples.time.size), {}, 0
    for k, size in enumerate(run.samples.row_size):
        now = {}
        for c in range(first, first + size):
            i, j = run.samples.contact_i[c], run.samples.contact_j[c]
            overlap, radius = _touch(run, k, i, j, walls)
            now[i, j] = np.sqrt(radius * overlap), run.samples.tangential_displacement[c] ** 2
        for pair in now.keys() & before.keys():
            (alpha, squared), (alpha_0, squared_0) = now[pair], before[pair]
            work[k] += 0.25 * k_t * (alpha - alpha_0) * (squared + squared_0)
        before, first = now, first + size
    return np.cumsum(work)


def pressed(model, integrator):
    """A dozen persons pressed against each other, walls and the corner of two; one of them leaves and is gone."""
    rng = np.random.default_rng(7)
    column, row = np.divmod(np.arange(12), 4)
    x, y = 2.72 - 0.56 * column + rng.uniform(-0.01, 0.01, 12), 0.28 + 0.56 * row
    x[2] = 2.99
    v, spin = rng.uniform([[0.5], [-1.0]], [[1.5], [1.0]], (2, 12)), rng.uniform(-2.0, 2.0, 12)
    crowd = Crowd.given(x, y, *v, spin, rng.uniform(0.29, 0.32, 12), rng.uniform(60.0, 80.0, 12), v_d=3.0)
    room, corner = square_room(3.0, 1.0, walk_on=0.005), ((1.35, 0.0, 1.35, 1.8), (1.35, 1.8, 0.5, 1.8))
    numerics = {"dt": 7e-4, "integrator": integrator, "force_tolerance": 0.1}
    options = Options(**numerics, time_limit=0.028, record_every=0.0035, contacts=True)
    return Scenario(Scene((*room.walls, *corner), room.exits), crowd, model, options)
