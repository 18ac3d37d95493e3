"""Rules for seeds where they are needed: what is wanted of which cell, and intervals that stopping does not spoil."""

import numpy as np
import pytest
import xarray as xr

from studies import measures
from studies.until import everything, planted
from studies.until.rules import Boundaries, HalfWidths, may_be_smooth, until_of
from sweep import Grid, Until, sweep
from tests.measures.planted import PAPER_BLOCKING, PAPER_V_D, column, rising_to, with_blocked
from tests.sweep.tiny import TINY


def paper_like(seeds=20, **more) -> xr.Dataset:
    """A column over v_d: smooth to 1.0 m/s, blocking from 1.6 m/s on."""
    return column(rising_to(1.0), PAPER_BLOCKING, seeds=seeds, **more).isel(copy=0, drop=True)


def given(ds: xr.Dataset, seeds: list[int]) -> xr.Dataset:
    """Only the first seeds of each v_d, as a sweep of unequal seeds leaves it."""
    number = xr.DataArray(seeds, {"v_d": ds.v_d}, ["v_d"])
    return planted.only(ds, xr.DataArray(np.arange(ds.sizes["seed"]), dims="seed") < number)


UNEQUAL = [5, 8, 20, 12, 6, 20, 9, 7]


@pytest.mark.parametrize(
    "measure",
    [
        measures.blocked_share,
        measures.hazard_of_blocking,
        lambda ds: measures.mean_over(measures.clearance(ds).clearance_time),
        lambda ds: measures.mean_over(measures.mean_flow(ds).mean_flow),
        lambda ds: measures.flow_in_bins(ds, 1.0).exits.sum(["seed", "time"]),
        lambda ds: measures.clearance(ds).censored.sum("seed"),
    ],
)
def test_measures_take_missing_runs_of_a_cell_as_not_run(measure):
    ds = paper_like()
    unequal = measure(given(ds, UNEQUAL))
    for k, seeds in enumerate(UNEQUAL):
        alone = measure(ds.isel(v_d=[k], seed=slice(0, seeds)))
        xr.testing.assert_allclose(unequal.isel(v_d=[k]), alone)


def test_states_take_a_cell_without_runs_as_if_it_were_not_in_the_grid():
    ds = paper_like()
    holed = measures.states(given(ds, [20, 20, 20, 0, 20, 20, 20, 20]))
    without = measures.states(ds.isel(v_d=[0, 1, 2, 4, 5, 6, 7]))
    assert holed.state.sel(v_d=1.2) == holed.state.attrs["flag_meanings"].split().index("undecided")
    for name in ("transition_from", "transition_from_low", "phase_separation_from", "phase_separation_from_high"):
        xr.testing.assert_allclose(holed[name], without[name])


def test_the_least_certain_goal_of_a_cell_counts():
    ds = paper_like()
    shares, both = HalfWidths(clearance_time=None)(ds), HalfWidths()(ds)
    found = measures.blocked_share(ds)
    np.testing.assert_allclose(shares, (found.blocked_share_high - found.blocked_share_low) / 0.2)
    assert (both >= shares).all()
    scattered = HalfWidths()(paper_like(noise=0.3))
    assert (scattered.sel(v_d=[0.6, 0.8]) > shares.sel(v_d=[0.6, 0.8])).all()


def test_clearance_time_is_wanted_where_the_state_is_smooth_or_may_be():
    ds = paper_like(seeds=40)
    smooth = may_be_smooth(ds)
    assert smooth.sel(v_d=[0.6, 0.8]).all()
    assert not smooth.sel(v_d=slice(1.2, None)).any()  # the planted bend lies at 1.0 m/s
    few = may_be_smooth(paper_like(seeds=3))
    assert few.sel(v_d=[0.6, 1.0, 1.2]).all()  # nothing is decided
    assert not few.sel(v_d=2.0)  # every run blocked


def test_a_cell_without_runs_is_unknown():
    assert np.isnan(HalfWidths()(given(paper_like(), [0, *UNEQUAL[1:]])).values[0])


def test_cells_are_added_inside_the_interval_of_a_boundary_and_nowhere_else():
    ds = with_blocked(paper_like(seeds=40, root=3), {1.6: 20, 1.8: 40, 2.0: 40})
    found = measures.states(ds)
    low, high = float(found.transition_from_low), float(found.transition_from_high)
    points = [point["v_d"] for point in Boundaries(0.1)(ds)]
    assert 1.5 in points  # blocking begins between 1.4 and 1.6 m/s
    assert all(low - 0.1 < v_d < high + 0.1 or v_d == 1.5 for v_d in points)
    assert Boundaries(0.2)(ds) == []


def test_gaps_of_a_column_are_those_between_its_own_cells():
    ds = with_blocked(paper_like(seeds=40, root=3), {1.6: 20, 1.8: 40, 2.0: 40})
    holed = given(ds, [40, 40, 40, 40, 0, 40, 40, 40])  # 1.4 m/s is another column's
    assert 1.4 in [point["v_d"] for point in Boundaries(0.2)(holed)]


def test_refinement_ends_when_the_gaps_are_as_narrow_as_wanted():
    v_d = PAPER_V_D
    for _ in range(6):
        rng_free = {float(v): (0.0 if v < 1.55 else 1.0) for v in v_d}
        ds = column(rising_to(1.0), rng_free, seeds=30, v_d=v_d).isel(copy=0, drop=True)
        new = [point["v_d"] for point in Boundaries(0.05)(ds)]
        if not new:
            break
        v_d = np.unique([*v_d, *new])
    assert not new
    found = measures.states(ds)
    assert float(found.phase_separation_from_high - found.phase_separation_from_low) <= 0.1 + 1e-9


def test_a_table_makes_the_rule_that_it_says():
    rule = until_of({"clearance_time": 0.05, "blocked_share": 0.1, "budget": 900, "resolution": 0.1})
    assert rule == Until(HalfWidths(0.05, 0.1), budget=900, refine=Boundaries(0.1))
    assert until_of({"blocked_share": 0.2}).excess == HalfWidths(None, 0.2)


@pytest.fixture(scope="module")
def covered() -> list[planted.Covered]:
    return planted.coverage(everything.RULE, copies=150)


def test_intervals_that_end_a_sweep_hold_the_planted_value_as_often_as_promised(covered):
    """At least 90 % for nominally 95 %; 150 cells tell it up to their own interval."""
    assert {c.what for c in covered} == {"blocked share", "clearance time"}
    for cell in covered:
        assert cell.high >= everything.LEAST_COVERAGE, cell
    assert np.mean([cell.share for cell in covered]) > 0.93


def test_stopping_at_the_first_look_after_two_runs_spoils_the_intervals(covered):
    """What the least number of seeds and the batches are for."""
    rule = Until(everything.RULE.excess, least=2, batch=1)
    (hasty,) = planted.coverage(rule, copies=150, supply=40, shares=(), scatters=(0.08,))
    assert hasty.high < min(c.share for c in covered if c.what == hasty.what)


def test_more_uncertain_cells_get_more_seeds(covered):
    of_mean = [c.seeds for c in covered if c.what == "clearance time"]
    assert of_mean == sorted(of_mean)
    assert of_mean[-1] > 5 * of_mean[0]


def test_planted_cells_are_settled_as_sweeps_of_runs_are(tmp_path):
    """The simulation of coverage decides on planted cells what `sweep(..., until=...)` decides on runs."""

    def excess(ds: xr.Dataset) -> xr.DataArray:
        runs = (ds.outcome > 0).sum("seed")
        return ds.max_speed.std("seed", ddof=1) / np.sqrt(runs) / 0.01

    until, grid = Until(excess, least=3, batch=3), Grid("lin_room", v_d=[0.8, 1.4], seed=range(15), **TINY)
    settled = planted.settled(sweep(grid, tmp_path / "all", jobs=1, progress=False), until)
    ds = sweep(grid, tmp_path / "all", 1, progress=False, until=until)
    assert settled.tolist() == ds.seeds_given.values.tolist()
    assert len(set(settled.tolist())) == 2


def test_a_planted_column_needs_less_than_a_uniform_grid():
    text = everything.planted_share(20)
    assert 0 < float(text.partition(" runs, ")[2].partition("%")[0]) <= 100 * everything.LARGEST_SHARE
