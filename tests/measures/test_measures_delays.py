"""Delays between exits, against hand-worked runs."""

import numpy as np
import pytest

from studies.measures import delay_counts, delay_survival, delays
from tests.measures.planted import gathered

RUNS = [
    ("all_out", [1.0, 1.2, 1.7, 4.7], 4.7, 4),  # delays 0.2, 0.5, 3.0
    ("blocked", [2.0, 3.5], 123.5, 4),  # delay 1.5, then a wait that nobody ended
    ("missing", [], np.nan, 0),
]


def test_delays_are_the_differences_of_exit_times_by_the_rank_they_follow():
    found = delays(gathered(RUNS)).delay
    assert found.exit.values.tolist() == [1, 2, 3]
    nan = np.nan
    np.testing.assert_allclose(found, [[0.2, 0.5, 3.0], [1.5, nan, nan], [nan] * 3])


def test_a_window_of_ranks_holds_the_delays_between_its_exits():
    found = delays(gathered(RUNS), first=2, last=3).delay
    np.testing.assert_allclose(found.squeeze("exit"), [0.5, np.nan, np.nan])


def test_unstable_runs_have_no_delays():
    assert delays(gathered([("unstable", [1.0, 2.0], 3.0, 4)])).delay.isnull().all()


def test_delays_are_counted_in_half_open_bins_and_missing_runs_count_nothing():
    found = delay_counts(gathered(RUNS))
    np.testing.assert_array_equal(found.delay_count, [[1, 1, 0, 1], [0, 0, 1, 0], [np.nan] * 4])
    assert found.delay_end.values.tolist() == [0.3, 1.0, 2.3, np.inf]
    on_edges = gathered([("all_out", [0.0, 0.5, 1.5], 1.5, 3)])
    assert delay_counts(on_edges, edges=(0.25, 0.5, 1.0)).delay_count.values.tolist() == [[0, 1]]


def test_the_wait_before_a_block_is_no_delay_and_is_reported():
    assert delay_counts(gathered(RUNS)).open_wait.values.tolist() == [False, True, False]
    assert delay_survival(gathered(RUNS), at=[0.0], first=1, last=None).censored == 1


def test_survival_is_the_share_of_pooled_delays_that_are_longer():
    found = delay_survival(gathered(RUNS), at=[0.0, 0.5, 1.0, 2.0, 5.0], first=1, last=None)
    np.testing.assert_allclose(found.delay_survival, [1.0, 0.5, 0.5, 0.25, 0.0])
    assert (found.delays, found.runs) == (4, 2)


def test_survival_of_planted_exponential_delays_lies_within_its_limits():
    rng = np.random.default_rng(3)
    runs = [("all_out", np.cumsum(rng.exponential(1.0, 200)), 999.0, 200) for _ in range(12)]
    times = np.array([0.5, 1.0, 2.0])
    found = delay_survival(gathered(runs), at=times)
    assert found.delays == 12 * 150
    truth = np.exp(-times)
    assert (found.delay_survival_low < truth).all()
    assert (truth < found.delay_survival_high).all()
    assert (found.delay_survival_high - found.delay_survival_low < 0.12).all()


def test_one_run_has_a_survival_function_but_no_limits():
    found = delay_survival(gathered(RUNS[:1]), at=[0.3], first=1, last=None)
    assert found.delay_survival == pytest.approx(2 / 3)
    assert np.isnan(found.delay_survival_low)
    assert np.isnan(found.delay_survival_high)


def test_bad_windows_and_edges_are_refused():
    with pytest.raises(ValueError, match="no window of ranks"):
        delays(gathered(RUNS), first=3, last=3)
    with pytest.raises(ValueError, match="do not ascend"):
        delay_counts(gathered(RUNS), edges=(1.0, 0.3))
    with pytest.raises(ValueError, match="over='root' is not an axis"):
        delay_survival(gathered(RUNS), at=[1.0], over="root")
