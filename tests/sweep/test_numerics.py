"""`jamsweep check-numerics`: whether the friction of a jam depends on the time step."""

import numpy as np
import pytest
from click.testing import CliRunner

from engine import BadInput, Crowd, Options, Scenario, Scene, laws, models, rooms, simulate
from sweep.cli import cli
from sweep.numerics import BETWEEN, QUANTITIES, Comparison, compare_steps

JAM = {"N": 40, "size": 6.0, "v_d": 2.0, "time_limit": 20.0}


def between_persons(**keywords):
    """Friction weighted by slip speed, at the default step and at a quarter of it."""
    scenarios = [rooms.lin_room(seed=seed, **JAM | keywords) for seed in range(12)]
    found = {(c.between, c.quantity): c for c in compare_steps(scenarios, jobs=1)}
    return found[BETWEEN[0], QUANTITIES[1]]


def test_a_reset_to_zero_depends_on_the_step_and_a_kept_spring_does_not():
    literal, kept = between_persons(friction="reset_to_zero", mu=0.5), between_persons()
    assert literal.difference > 0.1
    assert literal.verdict(0.02) == "NO"
    assert abs(kept.difference) < 0.04
    assert kept.verdict(0.02) != "NO"


def test_contact_sums_of_a_disc_that_slides_along_a_wall_are_what_it_loses():
    model = models.lin_dem(A=0.0, tau=1e30, wall_mu=0.4)._replace(rotation=laws.Rotation(1e30))
    crowd = Crowd.given([0.0, 0.0], [0.29, 5.0], 1.0, 0.0, 0.0, 0.3, 70.0, 0.0)
    options = Options(time_limit=0.02, record_every=0.02)
    run = simulate(Scenario(Scene(((-9.0, 0.0, 9.0, 0.0),)), crowd, model, options))
    between_persons, (friction, normal, friction_work, _) = run.contact_sums
    assert not between_persons.any()
    assert friction == pytest.approx(0.4 * normal)  # tanh(v_t/v_0) = 1
    vx = run.samples.vx[:, 0]
    assert friction == pytest.approx(70.0 * (vx[0] - vx[-1]), rel=1e-9)
    assert friction_work == pytest.approx(35.0 * (vx[0] ** 2 - vx[-1] ** 2), rel=0.02)


@pytest.mark.parametrize(
    ("low", "high", "word"), [(-0.01, 0.01, "yes"), (0.03, 0.05, "NO"), (-0.05, -0.03, "NO"), (0.01, 0.03, "open")]
)
def test_the_verdict_rests_on_the_whole_interval(low, high, word):
    assert Comparison(*BETWEEN[:1], QUANTITIES[0], 0.2, 0.2, 0.5 * (low + high), low, high).verdict(0.02) == word


def test_without_contacts_there_is_no_verdict():
    assert Comparison(BETWEEN[0], QUANTITIES[0], *[np.nan] * 5).verdict(0.02) == "no contacts"


def test_one_scenario_is_refused():
    with pytest.raises(BadInput, match="seeds 1 leave no interval"):
        compare_steps([rooms.lin_room(N=5)])


def test_the_command_says_it_for_any_room():
    small = ["--N", "20", "--size", "5", "--v-d", "2", "--seeds", "3", "--jobs", "1", "--duration", "5"]
    told = CliRunner().invoke(cli, ["check-numerics", "lin_room", *small])
    assert told.exit_code in (0, 1)
    assert told.output.count("between persons") == 4
    assert "3 runs of 5 s at 0.004 s and at 0.001 s" in told.output


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--seeds", "1"], "seeds 1 leave no interval"),
        (["--duration", "0"], "time_limit 0.0 is not finite and positive"),
        (["--jobs", "0"], "jobs 0 is not a whole number above 0"),
        (["--dt", "1"], "dt 1 s is beyond"),
    ],
)
def test_options_of_the_command_are_checked(options, complaint):
    result = CliRunner().invoke(cli, ["check-numerics", "lin_room", *options])
    assert isinstance(result.exception, BadInput)
    assert complaint in str(result.exception)
