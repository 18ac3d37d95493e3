"""The benchmark's arithmetic, what it says of missing codes, and one short run; times are never judged."""

import math

import numpy as np
import pytest

from studies.bench import packing, table
from studies.bench.compare import Found, compare
from studies.bench.packing import Packing, jam, pairs, pairs_in_reach
from studies.bench.peers import NAMES, Peer, Timing, load
from studies.bench.worker import enough

OURS = Found(200, 1000, "jamsweep", [Timing(s, 100, 1e-3, 2) for s in (0.001, 0.002, 0.009)])
THEIRS = Found(200, 1000, "lammps", [Timing(0.008, 100, 2e-3)], "skin 0.1 m")


def never(N):
    raise AssertionError("a code that is not there was prepared")


def test_a_row_is_the_median_per_person_per_pair_and_per_cpu_second():
    row = table.row(OURS)  # median 2 ms for 100 steps: 20 us a step
    assert row.per_person == pytest.approx(20e3 / 200)
    assert row.per_pair == pytest.approx(20e3 / 1000)
    assert row.pace == pytest.approx(200 * 1e-3 / 20e-6)
    assert row.spread == pytest.approx((90 - 10) / (2 * 20))
    assert row.steps_per_list == pytest.approx(300 / 6)
    assert math.isnan(table.row(THEIRS).steps_per_list)


def test_ratios_are_to_this_engine():
    line = next(line for line in table.table([OURS, THEIRS]).splitlines() if "lammps" in line)
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[:4] == ["200", "lammps", "4", "2"]  # four times the time, but twice the step


@pytest.mark.parametrize(("seconds", "said"), [(0.002 / 0.34, "0.34 (goal <= 0.35: met)"), (0.004, "0.5 (goal")])
def test_a_goal_is_said_with_its_number_and_whether_it_is_met(seconds, said):
    rows = [table.row(OURS), table.row(THEIRS._replace(timings=[Timing(seconds, 100, 1e-3)]))]
    (line,) = table.goals(rows)
    assert said in line
    assert ("NOT met" in line) == (seconds < 0.002 / 0.35)


def test_growth_with_N_is_per_person():
    grown = OURS._replace(N=10_000, timings=[Timing(0.14, 100, 1e-3)])
    (line,) = table.goals([table.row(OURS), table.row(grown)])
    assert "1.4 (goal <= 1.5: met)" in line


def test_a_missing_code_is_said_and_how_to_get_it():
    peer = Peer("absent", "nothing", ("no-such-distribution",), never)
    found = compare([peer], [100], {100: 1}, say=lambda text: None)
    text = table.table(found)
    assert "| 100 | absent | not installed" in text
    assert "no-such-distribution" in text
    assert "pip install '.[bench]'" in text


def test_a_code_is_not_asked_for_more_than_it_can_and_that_is_said():
    peer = Peer("small", "little", ("numpy",), never, most=50, why_most="it is small")
    (found,) = compare([peer], [100], {100: 1}, say=lambda text: None)
    assert not found.timings
    assert "not run: it is small" in table.table([found])


def test_a_code_that_fails_is_said_with_its_last_words():
    broken = Peer("no_such_code", "nothing", ("numpy",), never)
    (found,) = compare([broken], [100], {100: 1}, say=lambda text: None)
    assert found.note.startswith("failed: ")
    assert "no_such_code_" in found.note


def test_short_samples_are_repeated_until_they_last():
    total = enough(lambda: Timing(0.04, 10, 1e-3, 1), least=0.1)
    assert total == pytest.approx((0.12, 30, 1e-3, 3))


@pytest.mark.parametrize("N", [100, 1000])
def test_the_packing_is_a_jam_at_its_density(N):
    crowd = jam(N)
    assert N / (crowd.depth * crowd.width) == pytest.approx(packing.DENSITY)
    assert (crowd.x > crowd.radius / 2).all()
    assert (crowd.x < crowd.depth - crowd.radius / 2).all()
    i, j = pairs(np.array([crowd.x, crowd.y]), crowd.radius, 0.0)
    overlap = crowd.radius[i] + crowd.radius[j] - np.hypot(crowd.x[i] - crowd.x[j], crowd.y[i] - crowd.y[j])
    assert 1.0 < i.size / N < 3.0  # contacts
    assert overlap.max() < 0.3 * packing.RADII[0]


def test_pairs_in_reach_are_those_of_a_plain_double_loop():
    crowd = jam(100)
    distance = np.hypot(crowd.x - crowd.x[:, None], crowd.y - crowd.y[:, None])
    gap = distance - crowd.radius - crowd.radius[:, None]
    assert pairs_in_reach(crowd) == np.count_nonzero(np.triu(gap < packing.reach(), 1))


def test_the_packing_survives_its_file(tmp_path):
    crowd = jam(100)
    crowd.save(tmp_path / "packing.npz")
    again = Packing.load(tmp_path / "packing.npz")
    assert (again.depth, again.width, again.N) == (crowd.depth, crowd.width, 100)
    assert np.array_equal(again.vy, crowd.vy)


def test_every_code_knows_its_name():
    assert [load(name).name for name in NAMES] == list(NAMES)


def test_this_engine_alone_gives_finite_positive_numbers():
    (found,) = compare([load("jamsweep")], [100], {100: 1}, say=lambda text: None)
    row = table.row(found)
    assert all(math.isfinite(value) and value > 0 for value in row[2:5]), found
    assert "| 100 | jamsweep | 1 | 1 |" in table.table([found])
