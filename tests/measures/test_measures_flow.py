"""Flow in bins, mean flow and flow before blocking, against hand-worked runs."""

import numpy as np
import pytest

from studies.measures import flow_before_blocking, flow_in_bins, mean_flow
from tests.measures.planted import gathered

NAN = np.nan
RUNS = [
    ("all_out", [1.0, 9.0, 10.0, 12.0, 25.0], 25.0, 5),
    ("time_limit", [2.0], 30.0, 5),
    ("blocked", [4.0, 6.0, 7.0], 19.0, 5),
    ("unstable", [4.0], 20.0, 5),
    ("missing", [], NAN, 0),
]


def test_flow_in_bins_is_exits_per_second_up_to_the_end_of_each_run():
    found = flow_in_bins(gathered(RUNS), width=10.0)
    np.testing.assert_allclose(found.flow[0], [0.3, 0.1, NAN])
    np.testing.assert_allclose(found.flow[1], [0.1, 0.0, 0.0])
    np.testing.assert_allclose(found.flow[2], [0.3, NAN, NAN])
    assert found.flow[3:].isnull().all()


def test_the_partly_watched_bin_has_no_flow_but_keeps_its_exits():
    found = flow_in_bins(gathered(RUNS), width=10.0)
    np.testing.assert_array_equal(found.watched[0], [10.0, 10.0, 5.0])
    np.testing.assert_array_equal(found.exits[0], [3, 1, 1])
    assert found.exits[:3].sum() == 5 + 1 + 3


def test_an_exit_on_the_edge_belongs_to_the_bin_it_ends():
    found = flow_in_bins(gathered([("all_out", [0.0, 5.0, 10.0], 10.0, 3)]), width=5.0)
    np.testing.assert_allclose(found.flow[0], [0.4, 0.2])


def test_bins_of_a_sweep_without_any_run_are_empty():
    assert flow_in_bins(gathered([("missing", [], NAN, 0)])).flow.isnull().all()


def test_mean_flow_is_persons_over_clearance_time_zero_when_blocked_unknown_otherwise():
    found = mean_flow(gathered(RUNS))
    np.testing.assert_allclose(found.mean_flow, [0.2, NAN, 0.0, NAN, NAN])
    assert found.censored.values.tolist() == [False, True, True, False, False]


def test_flow_before_blocking_counts_the_intervals_of_blocked_runs_only():
    runs = [*RUNS, ("frozen", [3.0], 8.0, 5), ("frozen", [3.0, 3.0], 8.0, 5), ("blocked", [], 120.0, 5)]
    found = flow_before_blocking(gathered(runs)).flow_before_blocking
    np.testing.assert_allclose(found, [NAN, NAN, 2 / 3, NAN, NAN, NAN, NAN, NAN])


@pytest.mark.parametrize("width", [-1.0, 0.0, np.inf, NAN])
def test_a_bin_width_that_is_no_time_is_refused(width):
    with pytest.raises(ValueError, match=f"width {width} s is not a positive time"):
        flow_in_bins(gathered(RUNS), width=width)
