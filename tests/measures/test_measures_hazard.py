"""Hazards of blocking per exit: closed forms, planted laws, and predictions for crowds that were not fitted to."""

import numpy as np
import pytest
import xarray as xr

from studies.measures import chances
from studies.measures.blocking import run_counts
from studies.measures.hazard import CONSTANT, fit, log_likelihood, predicted, share_of
from tests.measures.planted import flagged, gathered

POWERS = tuple(np.arange(-1.0, 4.01, 0.25).tolist())


def planted(rates, power, sizes=(100, 200), seeds=10, root=0):
    """Runs that block after an exit with the hazard 1 - exp(-rate (n/100)^power): axes (N, v_d, seed)."""
    rng = np.random.default_rng(root)
    shape = (len(sizes), len(rates), seeds)
    out = np.empty(shape, dtype=int)
    for a, N in enumerate(sizes):
        inside = np.arange(N, 0, -1) / 100.0
        for b, rate in enumerate(rates):
            failed = rng.random((seeds, N)) < -np.expm1(-rate * inside**power)
            out[a, b] = np.where(failed.any(axis=1), failed.argmax(axis=1), N)
    dims = ("N", "v_d", "seed")
    persons = np.broadcast_to(np.array(sizes)[:, None, None], shape)
    return xr.Dataset(
        {
            "N_out": (dims, out),
            "persons": (dims, persons.copy()),
            "outcome": flagged(np.where(out < persons, 2, 1), dims),
        },
        coords={"N": list(sizes), "v_d": 1.0 + 0.2 * np.arange(len(rates)), "seed": np.arange(seeds)},
    )


def test_a_run_passes_its_exits_and_a_blocked_one_fails_the_next():
    runs = [("all_out", [1.0, 2.0, 3.0], 3.0, 3), ("blocked", [1.0], 121.0, 3), ("time_limit", [1.0], 1000.0, 3)]
    lost = [("unstable", [1.0], 2.0, 3), ("missing", [], np.nan, 0)]
    ds = gathered([*runs, *lost]).expand_dims(v_d=[1.0])
    found = chances(ds)
    assert found.inside.values.tolist() == [1, 2, 3]
    assert found.passed.values.tolist() == [[1, 1, 3]]  # with 3 inside all three runs saw an exit
    assert found.failed.values.tolist() == [[0, 1, 0]]


def test_a_crowd_that_blocks_before_the_first_exit_fails_its_first_chance():
    found = chances(gathered([("frozen", [], 5.0, 4), ("all_out", [1.0] * 4, 1.0, 4)]).expand_dims(v_d=[1.0]))
    assert found.failed.values.tolist() == [[0, 0, 0, 1]]
    assert found.passed.values.tolist() == [[1, 1, 1, 1]]


def test_a_constant_hazard_is_failed_over_all_chances():
    counts = chances(planted([0.004, 0.02], 0.0)).sum("N")
    law = fit(counts, CONSTANT)
    passed, failed = counts.passed.sum("inside").values, counts.failed.sum("inside").values
    np.testing.assert_allclose(-np.expm1(-law.rate), failed / (passed + failed), rtol=1e-4)
    assert np.isnan(law.power_low)


def test_the_likelihood_is_that_of_single_chances():
    inside, passed, failed = np.arange(1.0, 4.0), np.array([0.0, 2.0, 3.0]), np.array([0.0, 1.0, 0.0])
    q = 1.0 - np.exp(-0.3 * (inside / 100) ** 0.5)
    by_hand = (passed * np.log(1 - q) + failed * np.log(q)).sum()
    assert log_likelihood(0.3, 0.5, inside, passed, failed)[0] == pytest.approx(by_hand)


def test_a_share_follows_from_the_hazards_of_all_chances():
    n = np.arange(1, 151) / 100
    by_hand = 1.0 - np.prod(np.exp(-0.004 * n**1.5))
    assert share_of(np.array([0.004]), 1.5, 150)[0] == pytest.approx(by_hand)
    drawn = share_of(np.array([[0.004, 0.1], [0.002, 0.2]]), np.array([1.5, 0.0]), 150)
    assert drawn[0, 0] == pytest.approx(by_hand)
    assert drawn[1, 1] == pytest.approx(1.0 - np.exp(-0.2 * 150))


def test_planted_powers_and_shares_are_inside_their_intervals_in_nine_of_ten_runs():
    """The power by the likelihood ratio; the share of crowds of 300, fitted to none, by the posterior."""
    rates, power, held, told = [0.002, 0.006], 2.0, [], []
    truth = share_of(np.array(rates), power, 300)
    for root in range(100):
        law = fit(chances(planted(rates, power, root=root)).sum("N"), POWERS, draws=400)
        share = predicted(law, 300, np.array([5, 5]), np.array([10, 10]))
        held.append(law.power_low <= power <= law.power_high)
        told.append((share.predicted_share_low <= truth) & (share.predicted_share_high >= truth))
    assert np.mean(held) >= 0.9
    assert np.mean(told) >= 0.9


def test_a_constant_hazard_is_ruled_out_by_larger_crowds_where_the_hazard_grows_and_not_where_it_does_not():
    rates = [0.001, 0.003, 0.006]
    ruled_out = {}
    for power in (0.0, 2.5):
        p = []
        for root in range(20):
            ds = planted(rates, power, sizes=(100, 300), seeds=20, root=root)
            law = fit(chances(ds.sel(N=[100])).sum("N"), CONSTANT, draws=400)
            seen = run_counts(ds.sel(N=300), "seed")
            p.append(float(predicted(law, 300, seen.blocked.values, seen.runs.values).p_value))
        ruled_out[power] = np.mean(np.array(p) < 0.05)
    assert ruled_out[0.0] <= 0.15
    assert ruled_out[2.5] >= 0.9


def test_a_cell_in_which_nothing_blocked_keeps_an_upper_limit():
    law = fit(chances(planted([0.0], 0.0, sizes=(100,))).sum("N"), CONSTANT)
    assert law.rate[0] == 0.0
    assert 1e-4 < law.rate_high[0] < 4.0 / 1000  # ten times 100 chances passed


def test_the_same_seed_gives_the_same_law():
    counts = chances(planted([0.01], 1.0)).sum("N")
    first, second = fit(counts, POWERS, draws=50), fit(counts, POWERS, draws=50)
    np.testing.assert_array_equal(first.rates, second.rates)


def test_bad_requests_are_refused():
    counts = chances(planted([0.01], 0.0))
    with pytest.raises(ValueError, match="axis 'N' besides 'v_d'"):
        fit(counts)
    with pytest.raises(ValueError, match="confidence 2"):
        fit(counts.sum("N"), confidence=2)
    with pytest.raises(ValueError, match="'copy' is not an axis"):
        chances(planted([0.01], 0.0), over="copy")
