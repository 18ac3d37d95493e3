"""Faster is slower: planted minima are found with honest intervals, and unclear ones left undecided."""

import numpy as np
import pytest
import xarray as xr

from studies.measures import Rules, faster_is_slower
from tests.measures.planted import flagged

V_D = np.array([1.0, 1.5, 2.0, 3.0, 4.0])
LEAST_AT_2 = (110.0, 80.0, 70.0, 74.0, 80.0)
QUICK = Rules(resamples=400)


def crowd(means=LEAST_AT_2, noise: float = 1.0, seeds: int = 14, copies: int = 1, root: int = 1) -> xr.Dataset:
    """Runs of two persons whose last exit has these mean times: axes (copy, v_d, seed)."""
    rng = np.random.default_rng(root)
    shape = (copies, V_D.size, seeds)
    last = np.array(means)[:, None] + noise * rng.standard_normal(shape)
    dims = ("copy", "v_d", "seed")
    return xr.Dataset(
        {
            "exit_time": ((*dims, "exit"), np.stack([last / 2, last], axis=-1), {"units": "s"}),
            "outcome": flagged(np.ones(shape), dims),
            "end_time": (dims, last.copy(), {"units": "s"}),
            "N_out": (dims, np.full(shape, 2)),
            "persons": (dims, np.full(shape, 2)),
        },
        coords={"copy": np.arange(copies), "v_d": V_D, "seed": np.arange(seeds), "exit": [1, 2]},
    )


def cut_short(ds: xr.Dataset, v_d: float, at: float, outcome: int = 4) -> xr.Dataset:
    """The same runs, of which the first of this v_d was only watched up to a time and has one exit."""
    ds = ds.copy(deep=True)
    cell = {"v_d": v_d, "seed": 0}
    ds.exit_time.loc[cell | {"exit": 2}] = np.nan
    ds.end_time.loc[cell], ds.outcome.loc[cell] = at, outcome
    return ds


def decision(found: xr.Dataset) -> str:
    return found.v_dt_decision.attrs["flag_meanings"].split()[found.v_dt_decision.item()]


def test_the_planted_minimum_is_found_between_its_neighbours():
    found = faster_is_slower(crowd(), 2, rules=QUICK).squeeze()
    assert (found.v_dt_low, found.v_dt, found.v_dt_high) == (1.5, 2.0, 3.0)
    assert decision(found) == "decided"
    assert found.runs.values.tolist() == [14] * 5


def test_equal_means_widen_the_interval_to_both_and_beyond():
    found = faster_is_slower(crowd((110, 80, 70, 70.1, 80), noise=4.0), 2, rules=QUICK).squeeze()
    assert found.v_dt in (2.0, 3.0)
    assert (found.v_dt_low, found.v_dt_high) == (1.5, 4.0)


def test_a_minimum_that_may_lie_at_the_last_v_d_has_no_upper_limit():
    found = faster_is_slower(crowd((110, 80, 72, 70.0, 70.2), noise=4.0, root=4), 2, rules=QUICK).squeeze()
    assert found.v_dt == 3.0
    assert found.v_dt_high == np.inf


@pytest.mark.parametrize("means", [(110, 90, 80, 75, 70), (60, 70, 80, 90, 100)])
def test_a_minimum_at_an_edge_is_left_undecided(means):
    found = faster_is_slower(crowd(means), 2, rules=QUICK).squeeze()
    assert decision(found) == "at_edge"
    assert all(np.isnan(found[name]) for name in ("v_dt", "v_dt_low", "v_dt_high"))


def test_each_rank_has_a_threshold_of_its_own_and_v_d_may_come_in_any_order():
    ds = crowd()
    ds["exit_time"] = ds.exit_time.where(ds.exit != 1, ds.exit_time.sel(v_d=[1.5, 2.0, 3.0, 4.0, 1.0]).values / 2)
    found = faster_is_slower(ds.isel(v_d=[3, 0, 4, 1, 2]), [1, 2], rules=QUICK).squeeze()
    assert found.v_dt.sel(n=[2, 1]).values.tolist() == [2.0, 1.5]


def test_runs_that_did_not_finish_are_no_numbers_but_bounds():
    late = faster_is_slower(cut_short(crowd(), 3.0, 300.0), 2, rules=QUICK).squeeze()
    assert (late.v_dt, decision(late)) == (2.0, "decided")
    assert late.censored.values.tolist() == [0, 0, 0, 1, 0]
    blocked = faster_is_slower(cut_short(crowd(), 4.0, 200.0, outcome=2), 2, rules=QUICK).squeeze()
    assert (blocked.v_dt, decision(blocked)) == (2.0, "decided")
    best = faster_is_slower(cut_short(crowd(), 2.0, 300.0), 2, rules=QUICK).squeeze()  # at least 86 s in the mean
    assert (best.v_dt, decision(best)) == (3.0, "decided")
    early = faster_is_slower(cut_short(crowd(), 3.0, 1.0), 2, rules=QUICK).squeeze()  # at least 68.8 s in the mean
    assert decision(early) == "censored"
    assert np.isnan(early.v_dt)


def test_few_runs_or_few_v_d_are_left_undecided():
    assert decision(faster_is_slower(crowd(seeds=4), 2, rules=QUICK).squeeze()) == "too_few_runs"
    assert decision(faster_is_slower(crowd().isel(v_d=[1, 2]), 2, rules=QUICK).squeeze()) == "too_few_runs"
    assert decision(faster_is_slower(crowd(), 3, rules=QUICK).squeeze()) == "too_few_runs"


def test_the_interval_holds_the_planted_minimum_about_as_often_as_it_says():
    found = faster_is_slower(crowd((110, 80, 70, 70.8, 80), noise=3.0, copies=150), 2, rules=QUICK)
    inside = (found.v_dt_low <= 2.0) & (found.v_dt_high >= 2.0)
    assert inside.mean() >= 0.93


def test_bad_requests_are_refused():
    with pytest.raises(ValueError, match="holds along='v_d'"):
        faster_is_slower(crowd(), 2, over=["seed", "v_d"])
    with pytest.raises(ValueError, match="over='root'"):
        faster_is_slower(crowd(), 2, over="root")
    with pytest.raises(ValueError, match="not a rank of leaving"):
        faster_is_slower(crowd(), 0)
    with pytest.raises(ValueError, match="no variable exit_time"):
        faster_is_slower(crowd().drop_vars("exit_time"), 2)
