"""Energy: what springs give back, and that friction and damping only take."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Crowd, Options, Scenario, Scene, laws, models, simulate
from engine.kernel.laws.friction import tangential_stiffness
from tests.engine.scenes import PAPERS, UNDRIVEN, energy, passive, stiffening
from tests.oracle import cases

CROWD = cases.crowd_case()
LEAST, MOST = 1e-5, 0.1
overlaps = st.floats(LEAST, MOST)
speeds = st.floats(-5.0, 5.0)


@pytest.mark.parametrize("friction", ["kept", "reset"])
@pytest.mark.parametrize("damping", [0.0, 200.0])
def test_a_passive_crowd_never_gains_energy(friction, damping):
    """Springs counted, and the work that Mindlin's spring takes up when pressing stiffens it (Eq. 4's alpha)."""
    case = CROWD | {"g_n": damping, "g_t": damping, "t_end": 0.15}
    run = simulate(passive(case, dt=1e-5, every=2e-5, contacts=True, friction=friction))
    total = energy(run) - stiffening(run)
    assert total[-1] < 0.95 * total[0], "friction must be at work for this to test anything"
    rises = total - np.minimum.accumulate(total)
    assert rises.max() < 1e-5 * total[0]


def test_without_friction_and_damping_energy_is_conserved():
    """The step's own error: below 4e-5 of the energy at 1e-4 s, and 100 times less at 1e-5 s."""
    drifts = []
    for dt in (1e-4, 1e-5):
        case = CROWD | {"g_n": 0.0, "g_t": 0.0, "mu": 0.0, "t_end": 0.3}
        run = simulate(passive(case, dt=dt, every=1e-3, contacts=True))
        total = energy(run)
        drifts.append(np.abs(total - total[0]).max() / total[0])
    assert drifts[0] < 4e-5
    assert drifts[1] < drifts[0] / 50


@pytest.mark.parametrize("fraction", [0.1, 0.5, 0.9])
def test_a_compressed_pair_trades_energy_as_verlet_does_in_closed_form(fraction):
    """On a spring of frequency w, K + (1 - (w dt/2)^2) V is constant; the limit is 2/(sqrt(3) w)."""
    k_n, m, r, overlap = 1.2e5, 70.0, 0.3, 0.1
    w = np.sqrt(2.0 * k_n / m)
    dt = fraction * 2.0 / (np.sqrt(3.0) * w)
    model = models.parisi_dorso(**UNDRIVEN, k_n=k_n, kappa=0.0, g=0.0)
    crowd = Crowd.given([0.0, 2 * r - overlap], [0.0, 0.0], 0.0, 0.0, 0.0, r, m, 0.0)
    scenario = Scenario(Scene(), crowd, model, Options(**PAPERS, dt=dt, time_limit=8 * dt, record_every=dt))
    samples = simulate(scenario).samples
    stored = 0.5 * k_n * np.maximum(2 * r - np.abs(samples.x[:, 1] - samples.x[:, 0]), 0.0) ** 2
    moving = 0.5 * m * (samples.vx**2).sum(axis=1)
    touching = stored > 0.0
    constant = (moving + (1.0 - (0.5 * w * dt) ** 2) * stored)[touching]
    assert touching.sum() >= 2
    np.testing.assert_allclose(constant, constant[0], rtol=1e-12)
    assert (moving + stored)[touching].min() < (1.0 - 0.01 * fraction**2) * stored[0]


@settings(deadline=None)
@given(overlaps, speeds, st.sampled_from([laws.Hertz(3.5e6, 500.0), laws.Hooke(1.2e5, 100.0)]))
def test_damping_never_does_positive_work(overlap, v_n, law):
    damping = laws.normal(law, overlap, 0.15, 35.0, v_n) - laws.normal(law, overlap, 0.15, 35.0, 0.0)
    assert damping * v_n <= 0.0


@settings(deadline=None)
@given(speeds, st.floats(-5e3, 5e3), st.sampled_from([laws.Kinetic(0.5, 0.01), laws.Coulomb(0.5, 0.001)]))
def test_sliding_friction_never_does_positive_work(v_t, F_n, law):
    F_t, displacement = laws.friction(law, 0.01, 0.15, 35.0, v_t, F_n, 0.0)
    assert F_t * v_t <= 0.0
    assert abs(F_t) <= 0.5 * abs(F_n)
    assert displacement == 0.0


@settings(deadline=None)
@given(
    overlaps,
    speeds,
    st.floats(-1.0, 1.0),
    st.floats(1e-6, 1e-3),
    st.sampled_from(["Mindlin", "MindlinReset", "MindlinResetToZero"]),
)
def test_a_tangential_spring_gives_back_no_more_than_it_took(overlap, v_t, fraction, dt, kind):
    """Over one step at constant overlap: work of the force and change of the spring's energy.

    The spring that is kept at the limit is tried without its damper: a damper that alone exceeds the limit
    stretches it backwards (LAMMPS does the same), which is negligible at the paper's 0.8 1/(m s).
    """
    law = getattr(laws, kind)(4.5e6, 0.0 if kind == "Mindlin" else 300.0, 0.5)
    F_n = laws.normal(laws.Hertz(3.5e6, 0.0), overlap, 0.15, 35.0, 0.0)
    stiffness = tangential_stiffness(law, overlap, 0.15)
    before = fraction * 0.5 * F_n / stiffness
    F_t, after = laws.friction(law, overlap, 0.15, 35.0, v_t, F_n, before + v_t * dt)
    gained = 0.5 * stiffness * (after**2 - before**2) + F_t * v_t * dt
    assert gained <= 1e-9 * (1.0 + 0.5 * stiffness * before**2)
    assert abs(F_t) <= 0.5 * F_n * (1 + 1e-12)


@pytest.mark.parametrize("kappa", [2e4, 2.4e5, 1e7])  # kg/(m s)
@pytest.mark.parametrize("dt", [1e-3, 5e-3, 2e-2])
def test_solved_friction_and_damping_only_take_energy_at_any_step(kappa, dt):
    """A pressed heap without springs: steps up to 10,000 times as long as its friction takes to act."""
    rng = np.random.default_rng(5)
    column, row = np.divmod(np.arange(25), 5)
    vx, vy = 0.2 * rng.standard_normal((2, 25))
    crowd = Crowd.given(0.56 * column, 0.56 * row, vx, vy, 0.0, 0.3, 70.0, 0.0)
    model = models.parisi_dorso(**UNDRIVEN, k_n=1e-6, kappa=kappa, g=500.0)
    options = Options(dt=dt, time_limit=20 * dt, record_every=dt)
    samples = simulate(Scenario(Scene(((-9.0, -0.26, 9.0, -0.26),)), crowd, model, options)).samples
    kinetic = (samples.vx**2 + samples.vy**2).sum(axis=1)
    assert (np.diff(kinetic) <= 1e-9 * kinetic[0]).all()
    assert kinetic[-1] < 0.9 * kinetic[0]
