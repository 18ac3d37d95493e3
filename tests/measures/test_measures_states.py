"""States over v_d: planted boundaries are found with honest intervals, and few facts leave them undecided."""

import numpy as np
import pytest
import xarray as xr

from studies.measures import Rules, states
from studies.measures.boundaries import phase_separation, resampled_means
from tests.measures.planted import PAPER_BLOCKING, PAPER_V_D, column, rising_to, with_blocked

QUICK = Rules(resamples=600)
FAST = Rules(resamples=50)  # where no interval of the transition is looked at
FREE: dict[float, float] = {}


def words(flag: xr.DataArray) -> list[str]:
    meanings = flag.attrs["flag_meanings"].split()
    return [meanings[value] for value in flag.values.ravel()]


def covered(found: xr.Dataset, name: str, low: float, high: float | None = None) -> float:
    """Share of columns whose interval of the boundary holds a value, or a whole gap."""
    high = low if high is None else high
    return float(((found[f"{name}_low"] <= low) & (found[f"{name}_high"] >= high)).mean())


def one(found: xr.Dataset, name: str) -> tuple[float, float, float]:
    return tuple(float(found[f"{name}{end}"].squeeze()) for end in ("_low", "", "_high"))


GRADUAL = {1.4: 0.03, 1.6: 0.2, 1.8: 0.5}  # no cell of which is the first that blocks
LATE = {1.6: 0.1, 1.8: 0.5, 2.0: 0.95}
EARLY = {1.2: 0.02, 1.4: 0.1, 1.6: 0.29, 1.8: 0.6, 2.0: 0.9}


@pytest.mark.parametrize("noise", [0.06])
def test_planted_boundaries_are_inside_the_interval_in_nine_of_ten_of_200_columns(noise):
    found = states(column(rising_to(1.0), PAPER_BLOCKING, noise=noise, copies=200), rules=QUICK._replace(resamples=300))
    assert (found.transition_from_decision == 0).mean() >= 0.9
    assert covered(found, "transition_from", 1.0) >= 0.9
    assert covered(found, "phase_separation_from", 1.4, 1.6) >= 0.9
    assert abs(float(found.transition_from.median()) - 1.0) < 0.05
    assert float(found.phase_separation_from.median()) == pytest.approx(1.5)


@pytest.mark.parametrize("blocking", [GRADUAL, LATE, EARLY], ids=["gradual", "late", "early"])
@pytest.mark.parametrize("runs", [5, 10, 20])
def test_blocking_that_sets_in_gradually_is_established_inside_the_interval(blocking, runs):
    share = np.array([blocking.get(float(v), 0.0) for v in PAPER_V_D])
    first = int((share >= Rules().established).argmax())
    rng, of_each = np.random.default_rng(runs), np.full(PAPER_V_D.size, runs)
    columns = [phase_separation(PAPER_V_D, of_each, rng.binomial(runs, share), Rules()) for _ in range(200)]
    held = [b.low <= PAPER_V_D[first - 1] and b.high >= PAPER_V_D[first] for b in columns]
    assert np.mean(held) >= 0.9


@pytest.mark.parametrize(
    "flow",
    [rising_to(1.2), rising_to(1.2, power=1.5), rising_to(1.2, fall=0.15)],
    ids=["line", "bent", "fall"],
)
def test_a_later_a_bent_and_a_falling_transition_are_inside_the_interval(flow):
    found = states(column(flow, PAPER_BLOCKING, copies=60), rules=QUICK)
    assert covered(found, "transition_from", 1.2) >= 0.9
    assert (found.transition_from_decision == 0).mean() >= 0.75


def test_a_flow_that_falls_after_its_greatest_value_does_not_pull_the_transition_down():
    found = states(column(rising_to(1.0, fall=0.15), PAPER_BLOCKING, copies=60), rules=QUICK)
    assert covered(found, "transition_from", 1.0) >= 0.9
    assert abs(float(found.transition_from.median()) - 1.0) < 0.02


def test_cells_are_resampled_independently_of_each_other():
    flow = np.tile(np.linspace(0.7, 0.9, 10), (2, 1))
    first, second = resampled_means(flow, QUICK).T
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.15


def test_states_are_named_in_the_order_of_the_paper():
    found = states(with_blocked(column(rising_to(1.1), FREE, noise=0.02), {1.6: 3, 1.8: 8, 2.0: 10}), rules=QUICK)
    assert words(found.state) == ["smooth"] * 3 + ["transition"] * 2 + ["phase_separation"] * 3
    assert words(found.transition_from_decision) == words(found.phase_separation_from_decision) == ["decided"]
    assert found.n_resamples == QUICK.resamples


def test_the_order_of_the_cells_does_not_matter():
    ds = column(rising_to(1.0), PAPER_BLOCKING)
    turned = ds.isel(v_d=slice(None, None, -1)).transpose("exit", "seed", "v_d", "copy")
    xr.testing.assert_identical(states(turned, rules=QUICK), states(ds, rules=QUICK))


def test_three_seeds_are_undecided():
    found = states(column(rising_to(1.0), PAPER_BLOCKING, seeds=3, noise=0.01), rules=QUICK)
    assert set(words(found.state)) == {"undecided"}
    assert words(found.transition_from_decision) == ["too_few_runs"]
    assert np.isnan(one(found, "transition_from") + one(found, "phase_separation_from")).all()
    assert found.n_resamples == 0


def test_the_interval_of_phase_separation_is_made_of_whole_grid_gaps():
    found = states(column(rising_to(1.0), PAPER_BLOCKING, copies=40), rules=FAST)
    for end in ("_low", "_high"):
        assert np.isin(found[f"phase_separation_from{end}"], PAPER_V_D).all()
    assert (found.phase_separation_from_high - found.phase_separation_from_low > 0.199).all()


def test_one_stray_blocked_run_far_below_does_not_begin_phase_separation():
    ds = with_blocked(column(rising_to(1.0), FREE), {1.2: 1, 1.8: 8, 2.0: 10})
    low, at, high = one(states(ds, rules=FAST), "phase_separation_from")
    assert 1.6 < at < 1.8
    assert low >= 1.4
    assert high == 1.8


def test_a_mixed_cell_that_all_faster_cells_confirm_begins_phase_separation():
    ds = with_blocked(column(rising_to(1.0), FREE), {1.6: 1, 1.8: 8, 2.0: 10})
    found = states(ds, rules=FAST)
    _, at, high = one(found, "phase_separation_from")
    assert 1.4 < at < 1.6
    assert high == 1.8
    assert not found.state_certain.sel(v_d=1.6)


def test_without_blocking_phase_separation_lies_above_the_range():
    found = states(column(rising_to(1.0), FREE), rules=QUICK)
    low, at, high = one(found, "phase_separation_from")
    assert at == high == np.inf
    assert low >= 1.8
    assert words(found.phase_separation_from_decision) == ["above_range"]
    assert words(found.state.isel(v_d=[0, -1])) == ["smooth", "transition"]


def test_where_all_block_phase_separation_lies_below_the_range_and_no_rise_is_guessed():
    found = states(column(rising_to(1.0), {float(v): 1.0 for v in PAPER_V_D}), rules=FAST)
    assert one(found, "phase_separation_from") == (-np.inf, -np.inf, 0.6)
    assert set(words(found.state)) == {"phase_separation"}
    assert words(found.transition_from_decision) == ["too_few_cells"]


@pytest.mark.parametrize(
    ("flow", "why"),
    [
        (rising_to(2.0), "no_plateau"),
        (lambda v: 0.8 + 0 * v, "no_rise"),
        (lambda v: 1.0 - 0.2 * v, "no_rise"),
    ],
    ids=["still rising", "flat", "falling"],
)
def test_without_rise_or_plateau_the_transition_is_undecided(flow, why):
    found = states(column(flow, FREE, copies=30), rules=QUICK)
    assert words(found.transition_from_decision).count(why) >= 27
    silent = found.transition_from.isnull()
    assert words(found.state.where(silent, drop=True).astype(int)) == ["undecided"] * 8 * int(silent.sum())


def test_a_flow_that_rises_ever_slower_has_no_plateau():
    found = states(column(lambda v: 0.6 * np.sqrt(v / 0.6), FREE, noise=0.03, copies=30), rules=QUICK)
    assert words(found.transition_from_decision).count("no_plateau") >= 27


def test_a_cell_with_few_runs_is_undecided_and_leaves_a_wider_gap():
    ds = with_blocked(column(rising_to(1.0), FREE), {1.6: 7, 1.8: 8, 2.0: 10})
    ds.outcome.loc[{"v_d": [1.4, 2.0], "seed": slice(3, None)}] = 0
    found = states(ds, rules=FAST)
    assert words(found.state.sel(v_d=[1.4, 1.6, 2.0])) == ["undecided", "phase_separation", "undecided"]
    low, at, high = one(found, "phase_separation_from")
    assert low <= 1.2
    assert at == pytest.approx(1.4)
    assert high == 1.6
    assert found.runs.sel(v_d=1.4) == 3


def test_an_interval_too_wide_for_the_range_decides_nothing():
    ds = column(rising_to(1.0), PAPER_BLOCKING)
    found = states(ds, rules=QUICK._replace(widest=0.1))
    assert words(found.phase_separation_from_decision) == ["interval_too_wide"]
    assert set(words(found.state)) == {"undecided"}
    assert np.isfinite(found.phase_separation_from_low)
    assert np.isnan(found.phase_separation_from)


def test_runs_at_the_time_limit_are_counted_and_give_no_flow():
    ds = column(rising_to(1.0), FREE)
    ds.outcome.loc[{"v_d": 1.0, "seed": slice(0, 1)}] = 4
    found = states(ds, rules=FAST)
    assert found.censored.sel(v_d=1.0) == 2
    assert found.flows.sel(v_d=1.0) == 8
    assert found.runs.sel(v_d=1.0) == 10
    assert found.blocked.sum() == 0


def test_equal_runs_are_classified_without_a_division_by_zero():
    found = states(column(rising_to(1.0), FREE, noise=0.0), rules=FAST)
    low, at, high = one(found, "transition_from")
    assert low <= 1.0 <= high
    assert at == pytest.approx(1.0, abs=0.02)


def test_the_same_seed_gives_the_same_intervals():
    ds = column(rising_to(1.0), PAPER_BLOCKING)
    xr.testing.assert_identical(states(ds, rules=QUICK), states(ds, rules=QUICK))


def test_every_estimate_is_described_and_every_reason_has_its_sentence():
    found = states(column(rising_to(1.0), PAPER_BLOCKING), rules=FAST)
    assert all({"units", "long_name"} <= set(v.attrs) for v in found.data_vars.values())
    decision = found.transition_from_decision.attrs
    assert all(f"{word}: " in decision["comment"] for word in decision["flag_meanings"].split())


def test_bad_requests_are_refused():
    ds = column(rising_to(1.0), PAPER_BLOCKING)
    with pytest.raises(ValueError, match="over='root'"):
        states(ds, over="root")
    with pytest.raises(ValueError, match="'speed' is not an axis"):
        states(ds, along="speed")
    with pytest.raises(ValueError, match="cannot be averaged over"):
        states(ds, over=["seed", "v_d"])
    with pytest.raises(ValueError, match=r"stray=0\.4"):
        states(ds, rules=Rules(stray=0.4))
    with pytest.raises(ValueError, match="least_runs=1"):
        states(ds, rules=Rules(least_runs=1))
    with pytest.raises(ValueError, match="no variable persons"):
        states(ds.drop_vars("persons"))
