"""Friction of a contact that is dragged: the law's own, whatever the time step."""

import numpy as np
import pytest

from engine import Crowd, Options, Scenario, Scene, laws, models, simulate
from tests.engine.scenes import UNDRIVEN

K_N, K_T, RADIUS, MASS, MU = 3.6e6, 4.6e6, 0.15, 35.0, 0.5
STEPS = (5e-3, 2e-3, 1e-3, 1e-4)  # s
LAWS = [  # and the mean friction over mu F_n of each while it slips at v_t
    (laws.Mindlin(K_T, 0.8, MU), lambda v_t: 1.0),
    (laws.MindlinReset(K_T, 0.8, MU), lambda v_t: 0.5),
    (laws.Kinetic(MU, 0.01), lambda v_t: np.tanh(v_t / 0.01)),
    (laws.Coulomb(MU, 0.001), lambda v_t: 1.0),
]


def mobilised(law, overlap, v_t, dt):
    """Mean friction over mu F_n of a contact whose surfaces slip by 40 times what its spring stands, or more."""
    F_n = laws.normal(laws.Hertz(K_N, 0.0), overlap, RADIUS, MASS, 0.0)
    steps = max(int(40 * MU * K_N / K_T * overlap / (v_t * dt)), 10_000)
    forces, displacement = np.empty(steps), 0.0
    for k in range(steps):
        forces[k], displacement = laws.friction(law, overlap, RADIUS, MASS, v_t, F_n, displacement + v_t * dt)
    return -forces[steps // 20 :].mean() / (MU * F_n)


@pytest.mark.parametrize(("law", "mean"), LAWS, ids=[type(law).__name__ for law, _ in LAWS])
@pytest.mark.parametrize("overlap", [0.005, 0.02])
@pytest.mark.parametrize("v_t", [0.05, 0.2, 1.0])
def test_mean_friction_of_a_dragged_contact_does_not_depend_on_the_step(law, mean, overlap, v_t):
    assert [mobilised(law, overlap, v_t, dt) for dt in STEPS] == pytest.approx([mean(v_t)] * 4, rel=0.01)


def test_a_spring_that_is_reset_to_zero_is_too_strong_by_one_step_in_a_tooth():
    """(1 + 1/k)/2, k being the steps of a tooth: what `friction="reset_to_zero"` is named for."""
    law, overlap, v_t, dt = laws.MindlinResetToZero(K_T, 0.0, MU), 0.005, 0.2, 1e-3
    steps = np.ceil(MU * K_N / K_T * overlap / (v_t * dt))
    assert mobilised(law, overlap, v_t, dt) == pytest.approx(0.5 * (1.0 + 1.0 / steps), abs=0.03)
    assert mobilised(law, overlap, v_t, 1e-5) == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize("wall_friction", ["reset", "kinetic"])
def test_a_heavy_disc_that_slides_along_a_wall_loses_the_laws_mean_friction_at_every_step(wall_friction):
    """Through the whole engine: momentum lost, of a disc too heavy for its speed or overlap to change."""
    overlap, mass, v_t = 0.01, 1e9, 0.2
    law = models.lin_dem(**UNDRIVEN, g_n=0.0, g_t=0.0, wall_friction=wall_friction, inertia="none")
    F_n = laws.normal(law.wall_normal, overlap, 0.3, mass, 0.0)
    tooth = MU * law.wall_normal.k_n / models.lin_dem().friction.k_t * overlap
    lost = []
    for dt in STEPS:
        crowd = Crowd.given([0.0], [0.3 - overlap], v_t, 0.0, 0.0, 0.3, mass, 0.0)
        options = Options(dt=dt, time_limit=100 * tooth / v_t, record_every=100 * tooth / v_t)
        run = simulate(Scenario(Scene(((-9.0, 0.0, 9.0, 0.0),)), crowd, law, options))
        vx, time = run.samples.vx[:, 0], run.samples.time
        lost.append(mass * (vx[0] - vx[-1]) / (time[-1] - time[0]) / (MU * F_n))
    assert lost == pytest.approx([0.5 if wall_friction == "reset" else 1.0] * 4, rel=0.03)


def test_viscous_friction_stops_one_contact_exactly_at_any_step():
    """v = exp(-kappa overlap t/m), also where a step is ten times as long as that takes: the fitted theta."""
    kappa, overlap, mass = 2.4e5, 0.01, 60.0
    law = models.parisi_dorso(**UNDRIVEN, k_n=1e-9, kappa=kappa, g=0.0)
    crowd = Crowd.given([0.0], [0.3 - overlap], 1.0, 0.0, 0.0, 0.3, mass, 0.0)
    for dt in (1e-4, 5e-3, 0.02, 0.25):
        options = Options(dt=dt, solver_tolerance=1e-12, time_limit=2 * dt, record_every=2 * dt)
        run = simulate(Scenario(Scene(((-9.0, 0.0, 9.0, 0.0),)), crowd, law, options))
        assert run.samples.vx[-1, 0] == pytest.approx(np.exp(-kappa * overlap / mass * 1.5 * dt), rel=1e-9)
