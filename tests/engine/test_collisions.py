"""Two bodies, and a body and a wall, against closed forms."""

import numpy as np
import pytest

from engine import Crowd, Options, Scenario, Scene, models, simulate
from tests.engine.scenes import PAPERS, SMOOTH, UNDRIVEN, passive

HERTZ = {"k_n": 1e6, "k_t": 1e6, "g_n": 0.0, "g_t": 0.0, "mu": 0.0, "dt": 1e-5, "t_end": 0.1, "box": None}
HEAD_ON = HERTZ | {"x": [0, 0.6], "y": [0, 0], "vx": [1, -1], "vy": [0, 0], "spin": 0.0, "radius": 0.3, "mass": 80.0}


def test_hertz_pair_reaches_the_overlap_force_and_contact_time_of_the_closed_form():
    """F = k_n sqrt(R) delta^1.5: delta_max 0.04843884 m, F_max 4128.918 N, contact time 0.071284 s."""
    run = simulate(passive(HEAD_ON))
    gap = np.diff(run.samples.x, axis=1)[:, 0] - 0.6
    assert run.max_overlap == pytest.approx(0.04843884, rel=1e-6)
    force = 80.0 * np.abs(np.diff(run.samples.vx[:, 0])).max() / 1e-5
    assert force == pytest.approx(4128.918, rel=1e-5)
    assert (gap < 0).sum() * 1e-5 == pytest.approx(0.071284, abs=2e-5)


def test_two_equal_persons_exchange_their_velocities():
    run = simulate(passive(HEAD_ON))
    assert run.samples.vx[-1] == pytest.approx([-1.0, 1.0], abs=1e-7)
    assert np.abs(run.samples.vx.sum(axis=1)).max() < 1e-14


@pytest.mark.parametrize(("dt", "error"), [(1e-4, 1e-6), (1e-3, 3e-4), (2e-3, 2e-3)])
def test_restitution_error_is_small_at_practical_steps(dt, error):
    run = simulate(passive(HEAD_ON, dt=dt, every=0.1))
    assert np.abs(np.abs(run.samples.vx[-1]) - 1.0).max() < error


@pytest.mark.parametrize(("inertia", "kept"), [("sphere", 5 / 7), ("disc", 2 / 3)])
@pytest.mark.parametrize("friction", ["kinetic", "coulomb"])
def test_a_body_that_slides_along_a_wall_ends_up_rolling(inertia, kept, friction):
    """Friction without a spring turns sliding into rolling, at 5/7 of the speed for a sphere, 2/3 for a disc."""
    model = models.lin_dem(**UNDRIVEN | SMOOTH, wall_friction=friction, wall_mu=1.0, inertia=inertia)
    crowd = Crowd.given(x=[0.0], y=[0.31], vx=1.0, vy=-1.0, spin=0.0, radius=0.3, mass=70.0, v_d=0.0)
    floor = Scene(((-5.0, 0.0, 5.0, 0.0),))
    run = simulate(Scenario(floor, crowd, model, Options(**PAPERS, dt=1e-5, time_limit=0.2, record_every=0.2)))
    assert run.samples.vx[-1, 0] == pytest.approx(kept, rel=1e-3)
    assert -0.3 * run.samples.spin[-1, 0] == pytest.approx(kept, rel=1e-3)


@pytest.mark.parametrize("friction", ["kept", "reset"])
@pytest.mark.parametrize("wall", [False, True])
def test_no_collision_ends_with_more_energy_than_it_began(friction, wall):
    """From head on to grazing, spinning or not, at the paper's friction; 1e-4 allows for the step's own error."""
    rng = np.random.default_rng(4)
    for angle in np.linspace(0.0, 0.49 * np.pi, 40):
        spin = rng.uniform(-5, 5, 2) if angle > 0.5 else np.zeros(2)
        pair = {"x": [0.0, 0.61], "y": [0.0, 0.0], "vx": [np.cos(angle), 0], "vy": [np.sin(angle), 0], "spin": spin}
        case = HERTZ | {"k_n": 3.5556e6, "k_t": 4.5714e6, "mu": 0.5, "radius": [0.3] * 2, "mass": [70.0] * 2} | pair
        if wall:
            one = {name: case[name][:1] for name in ("x", "y", "vx", "vy", "spin", "radius", "mass")}
            case |= one | {"box": [-50.0, 0.31, -50.0, 50.0]}
        before, after = kinetic(simulate(passive(case | {"t_end": 0.4}, dt=5e-5, every=0.4, friction=friction)))
        assert after <= before * (1 + 1e-4), f"{np.degrees(angle):.0f} degrees"


def kinetic(run):
    s, start = run.samples, run.start
    inertia = 0.4 * start.mass * start.radius**2
    return 0.5 * (start.mass * (s.vx**2 + s.vy**2) + inertia * s.spin**2).sum(axis=1)
