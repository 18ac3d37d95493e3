"""What must hold in any small scene, and what must not matter to it.

All scenes have the types of the default variant, in two integrators, so that their numbers vary and no kernel more
is compiled. `make stress` runs ten thousand larger ones of all models.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from engine import BadInput, Crowd, Exit, Options, Scenario, Scene, models, simulate
from engine.scenario import step_limit
from studies.stress import energy, kinds
from studies.stress.checks import check
from tests.engine.scenes import NO_WALLS, PAPERS

LIN = models.lin_dem()
SIZE = 4.0  # m
any_scene = settings(
    deadline=None, derandomize=True, max_examples=60, suppress_health_check=list(HealthCheck), database=None
)
seeds = st.integers(0, 2**32)
integrators = st.sampled_from(["velocity_verlet", "predictor"])
doors = st.lists(st.sampled_from(["east", "north", "west"]), min_size=1, max_size=3, unique=True)
inner_walls = st.lists(
    st.tuples(st.floats(0.4, 3.6), st.floats(0.4, 3.6), st.floats(0.1, 0.5), st.floats(0.0, math.pi)), max_size=3
)


@st.composite
def lin_models(draw):
    """The default variant with other stiffness, damping, friction and social force."""
    model = kinds.scaled(LIN, kinds.STIFFNESSES, 10.0 ** draw(st.floats(-0.5, 1.0)))
    model = kinds.scaled(model, kinds.DAMPINGS, 10.0 ** draw(st.floats(-1.0, 3.0)))
    return kinds.with_values(model, {"A": draw(st.floats(0.0, 500.0)), "mu": draw(st.floats(0.0, 1.5))})


@st.composite
def crowds(draw, most=7):
    """A cluster of persons of mixed sizes in the middle of the room, who set off in all directions and collide."""
    N = draw(st.integers(2, most))
    radius = draw(st.floats(0.15, 0.3))
    mass = draw(st.floats(30.0, 80.0))
    sizes = (radius, radius * draw(st.floats(1.0, 1.3))), (mass, mass * draw(st.floats(1.0, 3.0)))
    side = 1.3 * sizes[0][1] * math.sqrt(math.pi * N / 0.4)
    area = (SIZE / 2 - side / 2, SIZE / 2 + side / 2) * 2
    return Crowd.uniform(N, area, *sizes, (0.5, 2.0), (0.5, draw(st.floats(0.5, 2.0))))


def room(open_sides=(), inside=(), width=1.0):
    """A square room with exits in the middle of its open sides, and walls (x, y, half length, angle) inside."""
    low, high = (SIZE - width) / 2, (SIZE + width) / 2
    sides = {
        "south": ((0.0, 0.0), (SIZE, 0.0), (0.0, -1.0)),
        "east": ((SIZE, 0.0), (SIZE, SIZE), (1.0, 0.0)),
        "north": ((SIZE, SIZE), (0.0, SIZE), (0.0, 1.0)),
        "west": ((0.0, SIZE), (0.0, 0.0), (-1.0, 0.0)),
    }
    walls = [
        (x - a * math.cos(b), y - a * math.sin(b), x + a * math.cos(b), y + a * math.sin(b)) for x, y, a, b in inside
    ]
    exits = []
    for name, (start, end, outward) in sides.items():
        if name not in open_sides:
            walls.append((*start, *end))
            continue
        along = np.subtract(end, start) / SIZE
        a, b = (tuple(np.add(start, s * along).tolist()) for s in (low, high))
        walls += [(*start, *a), (*b, *end)]
        exits.append(Exit(a, b, outward))
    return Scene(tuple(walls), tuple(exits))


def scenario(scene, crowd, model, integrator, fraction=0.5, steps=300, every=1, seed=0, dt=None):
    """A scenario at a fraction of the longest step; contacts are sampled where every step is."""
    options = Options(**PAPERS | {"integrator": integrator}, dt=1e-7, time_limit=1.0)
    first = Scenario(scene, crowd, model, options, seed)
    dt = dt or fraction * step_limit(first)[0]
    return first.with_options(dt=dt, time_limit=steps * dt, record_every=every * dt, contacts=every == 1)


def run_of(tried):
    """Run it, unless the crowd finds no place among the walls."""
    try:
        return simulate(tried)
    except BadInput:
        assume(False)


@any_scene
@given(doors, inner_walls, crowds(), lin_models(), integrators, st.floats(0.1, 0.9), seeds)
def test_nobody_goes_through_walls_or_others_and_everything_is_finite(
    open_sides, inside, crowd, model, integrator, fraction, seed
):
    run = run_of(scenario(room(open_sides, inside), crowd, model, integrator, fraction, 1500, 5, seed))
    assert run.outcome in ("all_out", "time_limit")
    assert check(run, step_limit(run.scenario)[0]).violations == []


@any_scene
@given(
    st.floats(5.0, 150.0),
    st.floats(-0.5, 0.5),
    st.sampled_from(["wall", "wall's end", "person", "person at a wall"]),
    lin_models(),
    integrators,
    st.floats(0.02, 0.5),
)
def test_who_is_thrown_is_stopped_or_ends_the_run_as_unstable(speed, beside, target, model, integrator, fraction):
    walls = {"wall": ((2.0, -9.0, 2.0, 9.0),), "wall's end": ((2.0, 1.0, 2.0, -9.0),), "person": ()}
    scene = Scene(walls.get(target, ((2.3, -9.0, 2.3, 9.0),)))
    others = ([2.0], [1.0 + beside]) if "person" in target else ([], [])
    crowd = Crowd.given(
        [1.0, *others[0]], [1.0, *others[1]], [speed, *[0.0] * len(others[0])], 0.0, 0.0, 0.3, 70.0, 0.0
    )
    run = simulate(scenario(scene, crowd, kinds.passive(model), integrator, fraction, 400))
    assert check(run, step_limit(run.scenario)[0]).violations == []


@any_scene
@given(st.booleans(), crowds(), lin_models(), integrators, st.floats(0.1, 0.9), seeds)
def test_undriven_crowds_gain_no_energy(walled, crowd, model, integrator, fraction, seed):
    """In a closed room or in the open, with friction and damping; springs counted."""
    scene = room() if walled else Scene()
    run = run_of(scenario(scene, crowd, kinds.passive(model), integrator, fraction, seed=seed))
    assert check(run, step_limit(run.scenario)[0]).violations == []


@any_scene
@given(st.booleans(), crowds(), lin_models(), integrators, seeds)
def test_what_is_lost_without_friction_falls_with_the_square_of_the_step(walled, crowd, model, integrator, seed):
    scene = room() if walled else Scene()
    errors = []
    for fraction, steps in ((0.2, 200), (0.05, 800)):
        run = run_of(scenario(scene, crowd, kinds.lossless(model), integrator, fraction, steps, seed=seed))
        total = energy.ledger(run).total
        assume(total[0] > 1.0)
        errors.append(np.abs(total - total[0]).max() / total[0])
    assert errors[0] < 0.3 * 0.2**2
    assert errors[1] < 0.3 * 0.05**2


@any_scene
@given(crowds(), lin_models(), integrators, seeds)
def test_momentum_stays_where_pushes_are_mutual_and_there_are_no_walls(crowd, model, integrator, seed):
    run = run_of(scenario(Scene(), crowd, kinds.passive(model), integrator, seed=seed))
    now, weight = energy.momentum(run), float((np.hypot(run.samples.vx, run.samples.vy) @ run.start.mass).max())
    assert np.abs(now - now[:, :1]).max() <= 1e-12 * max(weight, 1.0)


def given_crowd(start, *more):
    """The persons of a start, and more of them, each as (x, y, vx, vy, spin, radius, mass, v_d)."""
    columns = [np.concatenate([values, [person[k] for person in more]]) for k, values in enumerate(start)]
    return Crowd.given(*columns)


@any_scene
@given(doors, crowds(), lin_models(), integrators, seeds)
def test_a_person_far_away_changes_nothing(open_sides, crowd, model, integrator, seed):
    """Up to rounding: the order of pairs may be another."""
    start = crowd.draw(seed, NO_WALLS)
    alone = scenario(room(open_sides), given_crowd(start), model, integrator, 0.1, 400, 5)
    far = (SIZE / 2, -80.0, 0.0, 0.0, 0.0, crowd.radius[0], crowd.mass[1], 0.0)
    run = run_of(alone)
    other = run_of(replace(alone, crowd=given_crowd(start, far)))
    assert other.samples.x[: run.samples.time.size, :-1] == pytest.approx(run.samples.x, abs=1e-7, nan_ok=True)
    assert other.exit_time == pytest.approx(run.exit_time, abs=1e-7)


@any_scene
@given(doors, crowds(), lin_models(), integrators, seeds)
def test_a_wall_far_away_changes_not_one_bit(open_sides, crowd, model, integrator, seed):
    scene = room(open_sides)
    plain = scenario(scene, crowd, model, integrator, 0.5, 300, 5, seed)
    run = run_of(plain)
    other = run_of(replace(plain, scene=Scene((*scene.walls, (-30.0, -50.0, 40.0, -60.0)), scene.exits)))
    assert np.array_equal(run.samples.x, other.samples.x, equal_nan=True)
    assert np.array_equal(run.samples.spin, other.samples.spin, equal_nan=True)


@any_scene
@given(doors, inner_walls, crowds(), lin_models(), integrators, st.floats(1.0, 50.0), seeds)
def test_sampling_changes_not_one_bit(open_sides, inside, crowd, model, integrator, stride, seed):
    """Not even at intervals that are no multiple of the step, where samples stand at the nearest steps."""
    finest = scenario(room(open_sides, inside), crowd, model, integrator, 0.5, 300, 1, seed)
    dt = finest.numerics.dt
    coarse, none = (finest.with_options(record_every=every, contacts=False) for every in (stride * dt, 0.0))
    runs = [run_of(tried) for tried in (finest, coarse, none)]
    for run in runs[1:]:
        assert run.exit_time.tobytes() == runs[0].exit_time.tobytes()
        assert (run.end_time, run.max_overlap, run.max_speed) == (
            runs[0].end_time,
            runs[0].max_overlap,
            runs[0].max_speed,
        )
    fine, few = runs[0].samples, runs[1].samples
    step = np.round(few.time / dt).astype(int)
    assert np.abs(step - stride * np.arange(step.size)).max() <= 0.5 + 1e-9
    for name in ("time", "x", "vy"):
        assert np.array_equal(getattr(fine, name)[step], getattr(few, name), equal_nan=True)
    assert runs[2].samples is None


@any_scene
@given(doors, crowds(), integrators, st.integers(20, 180), seeds)
def test_a_run_begun_later_from_where_it_was_goes_on_as_it_did(open_sides, crowd, integrator, begun, seed):
    """Time itself acts on nobody. Begun at a time without contacts, since a given crowd has no springs."""
    steps = 200
    run = run_of(scenario(room(open_sides), crowd, LIN, integrator, steps=steps, seed=seed, dt=5e-4))
    s, start = run.samples, run.start
    begun = next((k for k in range(begun, steps) if s.row_size[k] == 0), steps)
    assume(run.N_out == 0 and begun < steps - 5)
    state = start._replace(x=s.x[begun], y=s.y[begun], vx=s.vx[begun], vy=s.vy[begun], spin=s.spin[begun])
    later = scenario(room(open_sides), given_crowd(state), LIN, integrator, steps=steps - begun, dt=5e-4)
    again = run_of(later)
    assert again.samples.x[-1] == pytest.approx(s.x[-1], abs=1e-6)
    assert again.samples.vy[-1] == pytest.approx(s.vy[-1], abs=1e-4)
