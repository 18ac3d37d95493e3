"""The study's arithmetic on planted data, what it says of them, and one very small run; times are never judged."""

import math

import numpy as np
import pytest
import xarray as xr

from engine import OUTCOMES, rooms, simulate
from studies import accuracy
from studies.precision import bias, cells, clock, conservation, page, plans, positions, savings, settings
from studies.precision.front import pareto
from studies.precision.positions import Case
from studies.precision.settings import Setting

RNG = np.random.default_rng(7)


def dataset(times, outcome="all_out"):
    """A gathered dataset (seed, exit) of exit times (n, exits), s; outcomes one for all or one each."""
    n, exits = times.shape
    words = [outcome] * n if isinstance(outcome, str) else outcome
    flags = {"flag_values": np.arange(len(OUTCOMES)), "flag_meanings": " ".join(OUTCOMES)}
    return xr.Dataset(
        {
            "exit_time": (("seed", "exit"), times),
            "outcome": ("seed", [OUTCOMES.index(word) for word in words], flags),
            "end_time": ("seed", np.nanmax(times, axis=1) + 120.0),
            "N_out": ("seed", np.isfinite(times).sum(axis=1)),
            "persons": ("seed", np.full(n, exits)),
        },
        {"seed": np.arange(n), "exit": np.arange(1, exits + 1)},
    )


def crowds(n, factor=1.0, spread=0.05, exits=30, rng=RNG):
    """Runs whose exits are spaced evenly, with clearance times of mean 100 s times `factor`."""
    ends = 100.0 * factor * (1.0 + spread * rng.standard_normal(n))
    return ends[:, None] * np.arange(1, exits + 1) / exits


def named(found, quantity):
    return next(b for b in found if b.quantity == quantity)


# --- Front --------------------------------------------------------------------------------------------------


def test_the_front_is_what_nothing_beats_in_both():
    points = [(1.0, 9.0), (2.0, 3.0), (2.0, 4.0), (3.0, 3.0), (4.0, 5.0), (5.0, 1.0), (math.nan, 0.0), (9.0, 1.0)]
    assert pareto(points) == [0, 1, 5]


def test_what_is_cheapest_and_most_exact_is_the_front_alone():
    assert pareto([(3.0, 3.0), (1.0, 1.0), (2.0, 2.0)]) == [1]
    assert pareto([]) == []


# --- Bias ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("factor", "n", "spread", "verdict"),
    [
        (1.0, 300, 0.05, bias.SHOWN),
        (1.0, 10, 0.2, bias.NOT_SHOWN),
        (1.06, 300, 0.05, bias.VIOLATED),
        (0.9, 300, 0.05, bias.VIOLATED),
    ],
)
def test_a_planted_bias_is_covered_and_judged(factor, n, spread, verdict):
    rng = np.random.default_rng(3)
    found = bias.compare(dataset(crowds(n, factor, spread, rng=rng)), dataset(crowds(n, 1.0, spread, rng=rng)), [20])
    for quantity in ("clearance time", "time of exit 20", "mean delay"):
        b = named(found, quantity)
        assert b.low <= factor - 1.0 <= b.high
        assert b.verdict == verdict
        assert b.used == (n, n)


def test_the_interval_covers_the_planted_bias_about_as_often_as_it_says():
    rng, covered, repeats = np.random.default_rng(11), 0, 200
    for _ in range(repeats):
        a, b = (100.0 * f * (1.0 + 0.1 * rng.standard_normal(30)) for f in (1.03, 1.0))
        found = bias.ratio("", (a, np.ones(30)), (b, np.ones(30)))
        covered += found.low <= 0.03 <= found.high
    assert 0.84 <= covered / repeats <= 0.96  # of 90 %


def test_pairing_takes_out_what_the_seeds_have_in_common():
    reference = crowds(40, spread=0.3)
    together = named(bias.compare(dataset(1.01 * reference), dataset(reference)), "clearance time")
    apart = named(bias.compare(dataset(1.01 * reference[::-1]), dataset(reference)), "clearance time")
    assert together.high - together.low < 1e-9
    assert apart.high - apart.low > 0.1
    assert together.verdict == bias.SHOWN


def test_blocked_runs_are_counted_and_not_averaged_in():
    times = crowds(100)
    stuck = times.copy()
    stuck[:50, 20:] = np.nan
    ends = ["blocked"] * 50 + ["all_out"] * 50
    found = bias.compare(dataset(stuck, ends), dataset(times), [10])
    blocked, clearance = named(found, "blocked share"), named(found, "clearance time")
    assert blocked.value == 0.5
    assert blocked.verdict == bias.VIOLATED
    assert clearance.used == (50, 100)
    assert abs(clearance.value) < 0.05
    assert named(found, "time of exit 10").used == (100, 100)
    assert bias.counts(dataset(stuck, ends)) == "50 all out, 50 blocked"


def test_unstable_and_missing_runs_leave_with_their_pairs():
    times = crowds(6)
    found = bias.compare(dataset(times, ["unstable", "missing", *["all_out"] * 4]), dataset(times))
    assert {b.pairs for b in found} == {4}
    assert named(found, "clearance time").value == pytest.approx(0.0, abs=1e-12)


def test_no_blocked_run_of_few_proves_nothing_and_of_many_does():
    few, many = (bias.difference("", np.zeros(n, bool), np.zeros(n, bool)) for n in (20, 300))
    assert few.verdict == bias.NOT_SHOWN
    assert many.verdict == bias.SHOWN


def test_the_interval_of_a_paired_difference_is_the_one_worked_by_hand():
    tested = np.array([1] * 48 + [0] * 2, bool)  # 36, 12, 2 and 0 of 50 pairs: phi = -24/209.2
    reference = np.array([1] * 36 + [0] * 12 + [1] * 2, bool)
    found = bias.difference("", tested, reference, confidence=0.95)
    assert (found.value, found.low, found.high) == pytest.approx((0.2, 0.0569, 0.3404), abs=6e-5)


def test_nothing_to_divide_by_is_undefined_and_not_shown():
    none = (np.zeros(5), np.zeros(5))
    found = bias.ratio("clearance time", (np.ones(5), np.ones(5)), none)
    assert found.verdict == bias.NOT_SHOWN
    assert page._percent(found) == ("undefined", "none")


# --- Parts --------------------------------------------------------------------------------------------------


def test_errors_fall_with_the_step_and_the_skin_changes_nothing():
    case = Case("lin_room", 1.0, 0.2, Setting("theta", 5e-4, 1e-6), (), N=20)
    coarse, fine = Setting("theta", 4e-3, 1e-6), Setting("theta", 1e-3, 1e-6)
    errors = positions.errors_of(
        case, 0, [coarse, fine, coarse._replace(skin=0.06), coarse._replace(force_tolerance=3.0)]
    )
    assert 0.0 < errors[fine] < errors[coarse]
    assert errors[coarse._replace(skin=0.06)] == pytest.approx(errors[coarse], rel=1e-6)
    assert errors[coarse._replace(force_tolerance=3.0)] > 2.0 * errors[coarse]


def test_a_crowd_begun_anew_stands_where_it_was_without_those_who_are_out():
    room = rooms.lin_room(v_d=1.0, N=30, seed=1)
    later = clock.at(room, 20.0)
    out = int((simulate(room).exit_time <= 20.0).sum())
    assert 0 < out < 30
    assert 30 - out == later.crowd.N
    assert max(later.crowd.x) <= 15.0


@pytest.mark.parametrize("gas", conservation.GASES)
def test_a_lossless_crowd_keeps_its_energy_better_with_shorter_steps(gas):
    long, short = (conservation.drift_of(gas, Setting("theta", dt, 1e-3), 2.0) for dt in (5e-3, 1e-3))
    assert 0.0 < short.swing < 0.2 * long.swing < 0.01


def test_far_walls_are_out_of_reach_and_change_nothing():
    room = rooms.lin_room(v_d=1.0, N=10, seed=1)
    far = savings.with_far_walls(room.scene)
    assert len(far.walls) == len(room.scene.walls) + savings.FAR
    assert min(min(wall[0::2]) for wall in far.walls[-savings.FAR :]) - 15.0 > savings.reach(room)


def test_more_seeds_are_more_in_every_trial():
    cell, grown = plans.FULL.cells[0], plans.times_more(plans.FULL, 3).cells[0]
    assert grown.reference.seeds == 3 * cell.reference.seeds
    assert [t.seeds for t in grown.trials] == [3 * t.seeds for t in cell.trials]


def test_the_chosen_settings_are_those_of_the_rooms():
    for name, room in rooms.ROOMS.items():
        chosen = settings.chosen(name)
        assert chosen["2%"] == settings.setting_of(room())
        assert chosen["paper"].integrator == "velocity_verlet"


def test_no_trial_has_more_seeds_than_its_reference():
    for plan in (plans.FULL, plans.QUICK):
        assert all(t.seeds <= cell.reference.seeds for cell in plan.cells for t in cell.trials)


# --- The whole ----------------------------------------------------------------------------------------------

EXACT = Setting("theta", 5e-4, 1e-6)
TINY = plans.QUICK._replace(
    cases=(Case("lin_room", 1.0, 0.2, EXACT, (EXACT._replace(dt=1e-3),), 20),),
    integrators=("theta",),
    steps=(2e-3, 1e-2),
    tolerances=(0.3,),
    stretch=0.1,
    gas_time=0.5,
    cells=(
        cells.Cell(
            "lin_room",
            1.0,
            15,
            cells.explicit("theta", 2e-3, 1e-3, 3),
            (cells.Trial("default", (), 3), cells.explicit("theta", 1e-2, 0.3, 2)),
            (12,),
        ),
    ),
    speed_ups=(("lin_room", 1.0, 10, 1),),
    repeats=1,
)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return accuracy.measure(TINY, tmp_path_factory.mktemp("store"), 1)


def test_a_small_study_tells_all_its_parts(results, tmp_path):
    text = page.tables(results)
    for part in (
        "Levels",
        "Friction at a step",
        "Error of the positions",
        "Energy",
        "Bias of the statistics",
        "What skipping saves",
    ):
        assert f"## {part}" in text
    assert "Refused, beyond the longest step: theta at 0.01 s" in text
    assert "refused: dt 0.01 s is beyond" in text
    assert "3 all out" in text
    assert not results.broken()
    accuracy.draw(results, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(page.FIGURES)


def test_failed_runs_break_the_study(results):
    judged = [j._replace(missing=2) for j in results.judged[:1]]
    assert "2 runs of lin_room" in results._replace(judged=judged).broken()[0]


def test_every_chosen_level_is_measured_and_what_it_promises_is_judged(results):
    assert [level.name for level in results.levels] == ["2%", "1mm", "0.1mm", "paper"]
    exact = results.levels[1]
    assert exact.promise == "kept"
    case, _, floor = exact.errors[0]
    assert exact._replace(errors=[(case, 2e-3, floor)]).promise == "NOT kept in 1 of 1 cases"
