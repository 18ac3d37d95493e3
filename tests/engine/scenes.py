"""Scenes without walls to leave by: what two bodies, or a box of them, do to each other."""

import numpy as np

from engine import Crowd, Model, Numerics, Record, Scenario, Scene, Stopping, laws


def passive(case, dt=None, every=None, contacts=False, sliding=laws.Mindlin, **changes):
    """The scenario of a case of tests/oracle/cases.py: contacts only, nobody drives."""
    dt = case["dt"] if dt is None else dt
    normal = laws.Hertz(case["k_n"], case["g_n"])
    tangential = sliding(case["k_t"], case["g_t"], case["mu"])
    model = Model(
        normal=normal,
        sliding=tangential,
        wall_normal=normal,
        wall_sliding=tangential,
        rotation=laws.Turning(0.4),
    )
    crowd = Crowd.given(**{k: np.array(case[k]) for k in ("x", "y", "vx", "vy", "spin", "radius", "mass")}, v_d=0.0)
    return Scenario(
        scene=box(case["box"]) if case["box"] else Scene(),
        crowd=crowd,
        model=model._replace(**changes),
        numerics=Numerics(dt=dt),
        stopping=Stopping(time_limit=case["t_end"]),
        record=Record(every=dt if every is None else every, contacts=contacts),
    )


def box(sides):
    """A closed box x0, x1, y0, y1."""
    x0, x1, y0, y1 = sides
    return Scene(((x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)))


def energy(run):
    """Kinetic energy and that of the springs at every sample, J (M,)."""
    samples, start, model = run.samples, run.start, run.scenario.model
    inertia = model.rotation.shape * start.mass * start.radius**2
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
            stored[k] += 0.5 * model.sliding.k_t * alpha * samples.contact_slip[c] ** 2
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
    """Work that pressing does on tangential springs up to every sample, J (M,): d(alpha) k_t slip^2 / 2.

    Mindlin's spring k_t sqrt(R overlap) stiffens while it is held, and takes up energy that no force pays for;
    it gives it back when the two part.
    """
    k_t, walls = run.scenario.model.sliding.k_t, run.scenario.scene.walls
    work, before, first = np.zeros(run.samples.time.size), {}, 0
    for k, size in enumerate(run.samples.row_size):
        now = {}
        for c in range(first, first + size):
            i, j = run.samples.contact_i[c], run.samples.contact_j[c]
            overlap, radius = _touch(run, k, i, j, walls)
            now[i, j] = np.sqrt(radius * overlap), run.samples.contact_slip[c] ** 2
        for pair in now.keys() & before.keys():
            (alpha, slip), (alpha_0, slip_0) = now[pair], before[pair]
            work[k] += 0.25 * k_t * (alpha - alpha_0) * (slip + slip_0)
        before, first = now, first + size
    return np.cumsum(work)
