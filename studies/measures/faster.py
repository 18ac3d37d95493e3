"""Faster is slower: the desired speed at which a crowd gets out soonest (Parisi & Dorso 2005, Fig. 1)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from studies.measures.boundaries import Rules
from studies.measures.exits import time_of_exit
from studies.measures.facts import Over, count, described, dims_over
from studies.measures.states import DEFAULT, check_rules, flag
from studies.measures.uncertainty import Floats, resampling_weights

DECISIONS = {
    "decided": "the least mean time lies inside the scanned range",
    "at_edge": "the least mean time is at the lowest or the highest v_d: scan beyond it",
    "censored": "a v_d with unfinished runs may have the least mean time: raise the time limit",
    "too_few_runs": "fewer than three v_d have Rules.least_runs runs that all finished: add seeds or v_d",
}
REASONS = tuple(DECISIONS)
Found = tuple[float, float, float, int]  # v_dt, low, high, place in REASONS


def undecided(reason: str) -> Found:
    """No minimum, for the reason given."""
    return np.nan, np.nan, np.nan, REASONS.index(reason)


def resampled_means(t: Floats, rules: Rules, seed: int) -> Floats:
    """Bootstrapped means of the times t (runs,), spread by sqrt(n/(n - 1)) about their mean: (resamples,)."""
    n = t.size
    spread = resampling_weights(n, rules.resamples, seed) @ (t - t.mean()) / n
    return np.asarray(t.mean() + spread * np.sqrt(n / (n - 1)))


def least(v_d: Floats, t: Floats, until: Floats, rules: Rules) -> Found:
    """The v_d of least mean time, and its limits.

    Parameters
    ----------
    v_d : (cells,) float, m/s, ascending
    t : (cells, runs) float, s, NaN where a run has no such time
    until : (cells, runs) float, s, how long a run was watched that did not reach it; else NaN
    """
    open_end = np.isfinite(until).any(axis=1)
    competes = ~open_end & (np.isfinite(t).sum(axis=1) >= rules.least_runs)
    cells = np.flatnonzero(competes)
    if cells.size < 3:
        return undecided("too_few_runs")
    times = [t[cell][np.isfinite(t[cell])] for cell in cells]
    mean = np.array([of.mean() for of in times])
    at_least = [
        np.nanmean(np.where(np.isfinite(until[cell]), until[cell], t[cell])) for cell in np.flatnonzero(open_end)
    ]
    if min(at_least, default=np.inf) <= mean.min():
        return undecided("censored")
    best = cells[mean.argmin()]
    if best in (0, v_d.size - 1):
        return undecided("at_edge")
    means = [resampled_means(of, rules, rules.seed + int(cell)) for cell, of in zip(cells, times, strict=True)]
    drawn = cells[np.argmin(means, axis=0)]
    first, last = np.quantile(drawn, [rules.beyond, 1.0 - rules.beyond], method="inverted_cdf")
    edges = np.concatenate([[-np.inf], v_d, [np.inf]])  # v_d[k] lies between edges[k] and edges[k + 2]
    return float(v_d[best]), float(edges[first]), float(edges[last + 2]), REASONS.index("decided")


def faster_is_slower(
    ds: xr.Dataset, n: int | Sequence[int], over: Over = "seed", rules: Rules = DEFAULT, along: str = "v_d"
) -> xr.Dataset:
    """Threshold v_dt: the v_d at which the mean time t_e(n) of the n-th exit is least; above it, faster is slower.

    A run that did not reach its n-th exit has no t_e(n), only a time up to which it was watched. A v_d with
    such a run is no candidate. It is known to be none if its mean is above the least one even with these
    times in place of the missing ones; otherwise the threshold stays undecided.

    Parameters
    ----------
    ds : gathered dataset
    n : int or sequence of int
        Ranks of leaving. A sequence gives a dimension `n`.
    over : str or sequence of str
        Dimensions of repeated runs.
    rules : Rules
        `least_runs` of a v_d that takes part, `confidence`, `resamples` and `seed` of the bootstrap.
    along : str
        The axis of v_d.

    Returns
    -------
    Dataset with `v_dt` (axes...) m/s, a v_d of the grid, and `v_dt_low`, `v_dt_high`: runs are resampled in each
    v_d on its own, and the grid tells of a minimum no more than the gaps beside it, so the limits are the
    neighbours, in the grid, of the least and largest v_d that the resamples give; -inf or inf beyond the
    scanned range. NaN when undecided, also where the minimum is at an edge of the grid. `v_dt_decision`, a CF
    flag whose `comment` says what each word means; `runs` and `censored` (axes..., v_d): runs with a t_e(n)
    and runs that did not reach it.

    Raises
    ------
    ValueError
        If `over` or `along` is not a dimension, a rank is below 1, a rule has no sense or a variable is
        missing.
    """
    dims, _ = dims_over(ds, over), dims_over(ds, along)
    if along in dims:
        raise ValueError(f"over={over!r} holds along={along!r}: the axis of v_d cannot be averaged over, name another")
    check_rules(rules)
    facts = time_of_exit(ds.sortby(along), n)
    t = facts.time_of_exit.where(np.isfinite(facts.time_of_exit))

    def cell_by_cell(v: Floats, times: Floats, until: Floats) -> Found:
        return least(v, times.reshape(v.size, -1), until.reshape(v.size, -1), rules)

    at, low, high, why = xr.apply_ufunc(
        cell_by_cell,
        facts[along].astype(np.float64),
        t,
        facts.censoring_time,
        input_core_dims=[[along], [along, *dims], [along, *dims]],
        output_core_dims=[[]] * 4,
        vectorize=True,
    )
    sentences = "; ".join(f"{word}: {sentence}" for word, sentence in DECISIONS.items())
    return xr.Dataset(
        {
            "v_dt": described(at, "m s-1", "v_d of the least mean time of the n-th exit"),
            "v_dt_low": described(low, "m s-1", "v_dt: lower limit", confidence=rules.confidence),
            "v_dt_high": described(high, "m s-1", "v_dt: upper limit", confidence=rules.confidence),
            "v_dt_decision": flag(why, REASONS, "v_dt: what was decided, and why", comment=sentences),
            "runs": count(t.notnull(), dims, "runs with an n-th exit"),
            "censored": count(facts.censored, dims, "runs that did not reach the n-th exit"),
        }
    )
