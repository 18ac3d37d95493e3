"""Clearance times, discharge curves and exits of a rank, against hand-worked runs."""

import numpy as np
import pytest
import xarray as xr

from studies.measures import clearance, discharge, mean_over, outcome_is, time_of_exit
from tests.measures.planted import gathered

RUNS = [
    ("all_out", [1.0, 2.0, 4.0], 4.0, 3),
    ("blocked", [1.0], 121.0, 3),
    ("frozen", [1.0, 3.0], 9.0, 3),
    ("time_limit", [5.0, 900.0], 1000.0, 3),
    ("unstable", [1.0], 2.0, 3),
    ("missing", [], np.nan, 0),
    ("blocked", [], 120.0, 3),
]


@pytest.fixture
def runs() -> xr.Dataset:
    return gathered(RUNS)


def test_clearance_time_is_the_last_exit_infinite_when_blocked_and_unknown_otherwise(runs):
    expected = [4.0, np.inf, np.inf, np.nan, np.nan, np.nan, np.inf]
    np.testing.assert_array_equal(clearance(runs).clearance_time, expected)


def test_only_unfinished_runs_are_censored_and_say_since_when(runs):
    found = clearance(runs)
    assert found.censored.values.tolist() == [False, True, True, True, False, False, True]
    np.testing.assert_array_equal(found.censoring_time, [np.nan, 121.0, 9.0, 1000.0, np.nan, np.nan, 120.0])


def test_a_blocked_run_is_never_averaged_in_as_a_number(runs):
    facts = clearance(runs)
    found = mean_over(facts.clearance_time, censored=facts.censored)
    assert found.clearance_time == 4.0
    assert (found.runs, found.censored) == (1, 4)


def test_outcomes_are_read_by_their_meanings_not_by_their_numbers(runs):
    shuffled = runs.copy(deep=True)
    shuffled["outcome"] = (5 - runs.outcome).assign_attrs(
        flag_values=np.arange(6), flag_meanings="unstable time_limit frozen blocked all_out missing"
    )
    xr.testing.assert_identical(clearance(shuffled), clearance(runs))


def test_discharge_counts_exits_until_the_run_is_no_longer_watched(runs):
    found = discharge(runs, at=[0.0, 1.0, 3.5, 10.0, 500.0]).discharge.transpose("seed", "time")
    nan = np.nan
    np.testing.assert_array_equal(
        found,
        [
            [0, 1, 2, 3, 3],
            [0, 1, 1, 1, nan],
            [0, 1, 2, 2, 2],
            [0, 0, 0, 1, 1],
            [nan] * 5,
            [nan] * 5,
            [0, 0, 0, 0, nan],
        ],
    )


def test_the_exit_of_a_rank_is_infinite_once_the_door_has_shut(runs):
    found = time_of_exit(runs, 2)
    np.testing.assert_array_equal(found.time_of_exit, [2.0, np.inf, 3.0, 900.0, np.nan, np.nan, np.inf])
    assert found.censored.values.tolist() == [False, True, False, False, False, False, True]


def test_a_rank_beyond_the_crowd_has_no_time_and_is_not_awaited(runs):
    found = time_of_exit(runs, [3, 4])
    assert found.time_of_exit.sel(n=4).isnull().all()
    assert not found.censored.sel(n=4).any()
    np.testing.assert_array_equal(found.time_of_exit.sel(n=3), [4.0, np.inf, np.inf, np.nan, np.nan, np.nan, np.inf])


def test_constants_stay_as_scalar_coordinates_and_axes_may_come_in_any_order(runs):
    wide = xr.concat([runs, runs], dim="v_d").assign_coords(v_d=[1.0, 2.0], A=300.0)
    turned = wide.transpose("exit", "seed", "v_d")
    assert clearance(wide).A == 300.0
    xr.testing.assert_equal(discharge(wide, [2.0]), discharge(turned, [2.0]).transpose("v_d", "seed", "time"))


def test_every_variable_carries_units_and_a_name(runs):
    for found in (clearance(runs), discharge(runs, [1.0]), time_of_exit(runs, [1])):
        assert all({"units", "long_name"} <= set(v.attrs) for v in found.data_vars.values())


def test_bad_input_names_the_thing_and_the_remedy(runs):
    with pytest.raises(ValueError, match="no variable exit_time"):
        clearance(runs.drop_vars("exit_time"))
    with pytest.raises(ValueError, match="no flag_values"):
        clearance(runs.assign(outcome=runs.outcome.drop_attrs()))
    with pytest.raises(ValueError, match="no flag 'asleep'"):
        outcome_is(runs, "asleep")
    with pytest.raises(ValueError, match="not a rank of leaving"):
        time_of_exit(runs, 0)
    with pytest.raises(ValueError, match="finite times"):
        discharge(runs, [np.nan])
