"""Blocked shares and hazards, against closed forms."""

import numpy as np
import pytest

from studies.measures import blocked_share, hazard_of_blocking
from tests.measures.planted import gathered

OUT = ("all_out", [1.0, 2.0], 2.0, 2)
STUCK = ("blocked", [1.0], 121.0, 2)
FROZEN = ("frozen", [1.0], 5.0, 2)
LATE = ("time_limit", [1.0], 1000.0, 2)
LOST = [("unstable", [1.0], 2.0, 2), ("missing", [], np.nan, 0)]


def test_unstable_and_missing_runs_are_no_runs_and_the_time_limit_is_no_block():
    found = blocked_share(gathered([OUT, STUCK, FROZEN, LATE, *LOST]))
    assert (found.runs, found.blocked, found.censored) == (4, 2, 1)
    assert found.blocked_share == 0.5


def test_limits_of_the_share_are_wilsons():
    found = blocked_share(gathered([STUCK] * 3 + [OUT] * 7))
    z, n, p = 1.959964, 10, 0.3
    centre = (p + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
    np.testing.assert_allclose(found.blocked_share_low, centre - half, rtol=1e-6)
    np.testing.assert_allclose(found.blocked_share_high, centre + half, rtol=1e-6)


def test_no_blocked_run_of_ten_leaves_a_share_of_up_to_28_percent():
    found = blocked_share(gathered([OUT] * 10))
    assert found.blocked_share_low == pytest.approx(0.0, abs=1e-12)
    assert found.blocked_share_high == pytest.approx(0.2775, abs=1e-3)


def test_a_cell_without_runs_has_no_share():
    found = blocked_share(gathered(LOST))
    assert found.runs == 0
    assert all(np.isnan(found[name]) for name in ("blocked_share", "blocked_share_low", "blocked_share_high"))


def test_hazard_is_blocked_runs_over_exits_made_with_poisson_limits():
    found = hazard_of_blocking(gathered([STUCK, STUCK, STUCK, OUT, *LOST]))
    assert (found.exits, found.blocked) == (5, 3)
    assert found.hazard_of_blocking == pytest.approx(0.6)
    np.testing.assert_allclose(found.hazard_of_blocking_low * 5, 0.6187, atol=1e-4)  # Garwood's table, 3 events
    np.testing.assert_allclose(found.hazard_of_blocking_high * 5, 8.7673, atol=1e-4)


def test_a_hazard_never_seen_is_zero_with_an_upper_limit():
    found = hazard_of_blocking(gathered([OUT] * 50))
    assert found.hazard_of_blocking == 0
    assert found.hazard_of_blocking_low == 0
    np.testing.assert_allclose(found.hazard_of_blocking_high * 100, -np.log(0.025), rtol=1e-9)


def test_without_exits_there_is_no_hazard():
    assert np.isnan(hazard_of_blocking(gathered([("blocked", [], 120.0, 2)])).hazard_of_blocking)


def test_an_unknown_axis_is_refused_by_name():
    with pytest.raises(ValueError, match=r"over='root' is not an axis of the dataset \(seed\)"):
        blocked_share(gathered([OUT]), over="root")
    with pytest.raises(ValueError, match="over='exit'"):
        hazard_of_blocking(gathered([OUT]), over="exit")
    with pytest.raises(ValueError, match="confidence 95"):
        blocked_share(gathered([OUT]), confidence=95)
