"""Planted laws of decay are told apart; noise and bad input are not taken for laws."""

import numpy as np
import pytest
import xarray as xr

from studies import measures

L = np.array([1.2, 1.8, 2.4, 3.0, 3.6, 4.2])


def times(law, noise=0.03, seeds=14):
    rng = np.random.default_rng(5)
    t = law(L)[:, None] * np.exp(noise * rng.standard_normal((L.size, seeds)))
    return xr.Dataset({"t": (("L", "seed"), t, {"units": "s"})}, coords={"L": L})


def test_a_power_is_found_and_so_is_its_exponent():
    found = measures.decay(times(lambda x: 90.0 * x**-1.1), "t")
    assert found.better == "power"
    assert found.slope_low.sel(law="power") < -1.1 < found.slope_high.sel(law="power")
    assert found.runs == 84


def test_an_exponential_is_found_and_so_is_its_rate():
    found = measures.decay(times(lambda x: 150.0 * np.exp(-0.6 * x)), "t")
    assert found.better == "exponential"
    assert found.slope_low.sel(law="exponential") < -0.6 < found.slope_high.sel(law="exponential")


def test_noise_is_no_law():
    assert measures.decay(times(lambda x: 0.0 * x + 50.0, noise=0.5), "t").better == "undecided"


def test_runs_that_did_not_finish_are_left_out():
    ds = times(lambda x: 90.0 / x)
    ds.t[0, :3] = np.inf
    ds.t[1, 0] = np.nan
    assert measures.decay(ds, "t").runs == 80


def test_two_widths_are_too_few():
    with pytest.raises(ValueError, match="three values"):
        measures.decay(times(lambda x: 90.0 / x).isel(L=[0, 1]), "t")
