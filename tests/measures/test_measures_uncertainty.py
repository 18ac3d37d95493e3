"""Means with intervals: what few, equal and infinite values give, and how often the truth is inside."""

import numpy as np
import pytest
import xarray as xr

from studies.measures import mean_over


def sample(values) -> xr.DataArray:
    values = np.asarray(values, dtype=float)
    dims = ("cell", "seed")[-values.ndim :]
    return xr.DataArray(values, dims=dims, name="time", attrs={"units": "s", "long_name": "some time"})


def test_the_mean_is_over_finite_values_and_says_how_many():
    found = mean_over(sample([[1.0, 2.0, 6.0, np.inf], [np.nan, 5.0, 7.0, np.inf]]))
    assert found.time.values.tolist() == [3.0, 6.0]
    assert found.runs.values.tolist() == [3, 2]
    assert (found.time.attrs["units"], found.time_low.attrs["units"]) == ("s", "s")


def test_no_value_has_no_mean_and_one_value_has_no_interval():
    found = mean_over(sample([[np.nan, np.inf], [4.0, np.nan]]))
    np.testing.assert_array_equal(found.time, [np.nan, 4.0])
    assert found.time_low.isnull().all()
    assert found.time_high.isnull().all()


def test_two_values_say_little_of_their_mean():
    found = mean_over(sample([1.0, 3.0]))
    arm = 12.7062 / 1.95996 * np.sqrt(2.0)  # Student's t with one degree of freedom, half-range 1
    np.testing.assert_allclose([found.time_low, found.time, found.time_high], [2 - arm, 2, 2 + arm], rtol=1e-4)


def test_equal_values_have_an_interval_of_no_width():
    found = mean_over(sample([0.1] * 7))
    assert found.time_low == found.time_high == pytest.approx(0.1, abs=1e-15)


@pytest.mark.parametrize("n", [3, 5, 10, 20])
def test_the_interval_holds_the_true_mean_about_as_often_as_it_says(n):
    values = np.random.default_rng(n).normal(220.0, 20.0, (500, n))
    found = mean_over(sample(values), resamples=1000)
    inside = ((found.time_low <= 220.0) & (found.time_high >= 220.0)).mean()
    assert 0.91 <= inside <= 0.985


def test_a_wider_confidence_gives_a_wider_interval():
    da = sample(np.random.default_rng(1).normal(size=12))
    narrow, wide = mean_over(da, confidence=0.8), mean_over(da, confidence=0.95)
    assert wide.time_low < narrow.time_low < narrow.time_high < wide.time_high


def test_the_interval_of_a_cell_does_not_depend_on_the_other_cells():
    values = np.random.default_rng(2).normal(size=(4, 9))
    xr.testing.assert_equal(mean_over(sample(values)).isel(cell=2), mean_over(sample(values[2])))


def test_a_mean_may_run_over_several_axes():
    da = sample(np.arange(12.0).reshape(3, 4))
    found = mean_over(da, over=["cell", "seed"])
    assert found.time == 5.5
    assert found.runs == 12


def test_bad_requests_are_refused():
    with pytest.raises(ValueError, match="over='v_d'"):
        mean_over(sample([1.0, 2.0]), over="v_d")
    with pytest.raises(ValueError, match="resamples 0"):
        mean_over(sample([1.0, 2.0]), resamples=0)
    with pytest.raises(ValueError, match=r"confidence 1\.0"):
        mean_over(sample([1.0, 2.0]), confidence=1.0)
