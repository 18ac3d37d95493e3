"""Paired blocked shares, against Newcombe's published example and McNemar's test by hand."""

import numpy as np
import pytest
import xarray as xr

from studies.measures import paired_blocking
from studies.measures.paired import newcombe
from tests.measures.planted import gathered

OUT = ("all_out", [1.0, 2.0], 2.0, 2)
STUCK = ("blocked", [1.0], 121.0, 2)


def pairs(first, second):
    """Runs over (kind, seed)."""
    ds = xr.concat([gathered(first), gathered(second)], "kind", coords="minimal", compat="override")
    ds.outcome.attrs = gathered(first).outcome.attrs
    return ds.assign_coords(kind=["a", "b"])


def test_limits_of_a_paired_difference_are_newcombes():
    difference, low, high = newcombe(20, 12, 2, 16, 0.95)  # his table of 50 pairs, method 10
    assert difference == pytest.approx(0.2)
    assert (low, high) == pytest.approx((0.0562, 0.3292), abs=1e-4)


def test_pairs_are_counted_by_which_of_them_blocked():
    found = paired_blocking(pairs([STUCK] * 8 + [OUT] * 2, [STUCK] * 2 + [OUT] * 7 + [STUCK]), "kind", "a", "b")
    assert [int(found[name]) for name in ("both", "only_first", "only_second", "neither")] == [2, 6, 1, 1]
    assert found.difference == pytest.approx(0.5)
    assert found.p_value == pytest.approx(2 * (1 + 7) / 2**7)  # binomial tail of 1 or fewer of 7, both sides
    assert found.difference_low < 0.5 < found.difference_high


def test_a_pair_without_one_of_its_runs_is_none():
    found = paired_blocking(pairs([STUCK, STUCK, OUT], [OUT, ("missing", [], np.nan, 0), OUT]), "kind", "a", "b")
    assert found.pairs == 2
    assert (found.only_first, found.neither) == (1, 1)


def test_equal_kinds_differ_by_nothing():
    found = paired_blocking(pairs([OUT] * 10, [OUT] * 10), "kind", "a", "b")
    assert found.difference == 0
    assert found.p_value == 1
    assert found.difference_low < -0.2


def test_the_interval_holds_a_planted_difference():
    rng, held = np.random.default_rng(0), []
    for _ in range(400):
        common = rng.random(30) < 0.2
        a, b = common | (rng.random(30) < 0.5), common | (rng.random(30) < 0.1)
        _, low, high = newcombe(
            int((a & b).sum()), int((a & ~b).sum()), int((~a & b).sum()), int((~a & ~b).sum()), 0.95
        )
        held.append(low <= 0.8 * 0.4 <= high)
    assert np.mean(held) >= 0.93


def test_bad_requests_are_refused():
    ds = pairs([OUT], [OUT])
    with pytest.raises(ValueError, match=r"kind has no value 'c' \(it has a, b\)"):
        paired_blocking(ds, "kind", "a", "c")
    with pytest.raises(ValueError, match="holds along='seed'"):
        paired_blocking(ds, "seed", 0, 0)
