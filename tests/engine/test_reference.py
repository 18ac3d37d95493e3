"""The compiled kernel, with its lists and blocks, against plain numpy over all pairs."""

import numpy as np
import pytest

from engine import Crowd, Options, Scenario, models, simulate
from engine.rooms import square_room
from tests.engine.reference import Reference


def crush(friction=None, N=24, dt=2e-4, t_end=0.5, size=6.0, **options):
    """A crowd pressed against the exit wall and into the corner, so that persons and walls touch."""
    rng = np.random.default_rng(7)
    column, row = np.divmod(np.arange(N), 4)
    x, y = size - 0.35 - 0.64 * column, size / 2 - 1.1 + 0.66 * row + 0.1 * (column % 2)
    crowd = Crowd.given(
        x=x + rng.uniform(-0.01, 0.01, N),
        y=y + rng.uniform(-0.01, 0.01, N),
        vx=rng.uniform(0, 1.5, N),
        vy=rng.uniform(-1, 1, N),
        spin=rng.uniform(-2, 2, N),
        radius=rng.uniform(0.25, 0.35, N),
        mass=rng.uniform(60, 80, N),
        v_d=3.0,
    )
    numerics = {"dt": dt, "force_tolerance": 1e-12, "integrator": "velocity_verlet"}
    run = Options(**numerics, time_limit=t_end, record_every=0.01, **options)
    return Scenario(square_room(size, 1.0), crowd, models.lin_dem(**friction or {}), run)


KEPT = {"friction": "kept", "wall_friction": "kept"}


@pytest.mark.parametrize("friction", [{}, KEPT, {"wall_friction": "reset"}], ids=["default", "kept", "reset"])
def test_the_kernel_computes_what_plain_numpy_computes(friction):
    scenario = crush(friction)
    run, reference = simulate(scenario), Reference(scenario)
    stays = np.setdiff1d(np.arange(run.N), run.exit_person)
    assert run.max_overlap > 0.01, "the crowd must be pressed for this to test anything"
    for k in range(run.samples.time.size):
        if run.N_out and run.samples.time[k] > run.exit_time[0]:
            break
        assert run.samples.x[k, stays] == pytest.approx(reference.x[stays, 0], abs=1e-9)
        assert run.samples.y[k, stays] == pytest.approx(reference.x[stays, 1], abs=1e-9)
        assert run.samples.spin[k, stays] == pytest.approx(reference.w[stays], abs=1e-6)
        for _ in range(50):
            reference.step()
    assert k > 10


@pytest.mark.parametrize("skin", [0.01, 0.4])
def test_the_skin_changes_speed_and_not_the_run(skin):
    """Lists of 0.01 m skin are rebuilt at nearly every move, those of 0.4 m hardly ever."""
    scenario, other = crush(), crush(skin=skin)
    mine, theirs = simulate(scenario), simulate(other)
    assert mine.rebuilds != theirs.rebuilds
    assert theirs.samples.x[:12] == pytest.approx(mine.samples.x[:12], abs=1e-9, nan_ok=True)


def test_more_pairs_than_a_block_holds_are_all_computed():
    """120 persons have more than two blocks of 512 pairs in reach of each other."""
    scenario = crush(KEPT, N=120, t_end=0.05, size=20.0)
    reference = Reference(scenario)
    run = simulate(scenario)
    for _ in range(round(run.samples.time[-1] / scenario.numerics.dt)):
        reference.step()
    assert run.samples.x[-1] == pytest.approx(reference.x[:, 0], abs=1e-9)
