"""Blocking as a hazard per exit that may grow with the number of persons who are still inside.

Every exit is a chance to block. With n persons inside, a chance is passed with probability exp(-lambda (n/100)^g),
so that a crowd of N blocks with probability 1 - exp(-lambda S(N)), S(N) = sum over n = 1..N of (n/100)^g. With g = 0
the hazard per exit, 1 - exp(-lambda), is the same for everybody. A run has N chances: before the first exit, and after
each but the last. One that blocks after k exits passed k and failed the next, one that ends at the time limit after k
passed k, and one that completes passed all.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import stats
from scipy.optimize import minimize_scalar
from scipy.special import logsumexp

from studies.measures.boundaries import Ints
from studies.measures.facts import BLOCKED, KNOWN, Over, described, dims_over, needs, outcome_is
from studies.measures.uncertainty import Floats, check_resampling

CROWD = 100.0  # persons, at which lambda is the hazard
POWERS = tuple(np.round(np.arange(-1.0, 5.01, 0.05), 2).tolist())  # g that are tried
CONSTANT = (0.0,)
RATES = np.exp(np.linspace(np.log(1e-8), np.log(10.0), 400))  # lambda of the posterior's grid, 5 % apart


class Law(NamedTuple):
    """The hazards of all v_d with one power of the crowd: estimates, and draws from the posterior."""

    power: float  # g, maximum of the likelihood
    power_low: float  # ends of the interval of the likelihood ratio, NaN where g was given
    power_high: float
    rate: Floats  # (cells,) lambda, maximum of the likelihood
    rate_low: Floats  # (cells,) percentiles of the posterior
    rate_high: Floats
    powers: Floats  # (draws,) of g
    rates: Floats  # (draws, cells) of lambda
    log_likelihood: float  # at its maximum


def chances(ds: xr.Dataset, over: Over = "seed", along: str = "v_d") -> xr.Dataset:
    """How often a chance to block was passed and failed, by the number of persons inside.

    Parameters
    ----------
    ds : gathered dataset
    over : str or sequence of str
        Dimensions of repeated runs; name "N" among them to pool crowds of several sizes.
    along : str
        The axis of v_d.

    Returns
    -------
    Dataset with `passed` and `failed` (axes..., inside), numbers of chances, over `inside` = 1, 2, ... up to the
    largest crowd; missing and unstable runs have none.

    Raises
    ------
    ValueError
        If `over` or `along` is not a dimension, or a variable is missing.
    """
    needs(ds, "N_out", "persons")
    dims, _ = dims_over(ds, over), dims_over(ds, along)
    known, stuck = outcome_is(ds, *KNOWN), outcome_is(ds, *BLOCKED)
    inside = np.arange(1, max(int(ds.persons.max()), 1) + 1)
    n = xr.DataArray(inside, dims="inside", coords={"inside": inside})
    left = ds.persons - ds.N_out
    passed = known & (n <= ds.persons) & (n > left)
    failed = stuck & (n == left)

    def counted(truth: xr.DataArray, text: str) -> xr.DataArray:
        return described(truth.sum(dims).astype("int64").transpose(..., "inside"), "1", text)

    found = xr.Dataset(
        {"passed": counted(passed, "exits made"), "failed": counted(failed, "exits that never came")},
    )
    found["inside"].attrs = {"units": "1", "long_name": "persons inside"}
    return found


def log_likelihood(rate: Floats | float, power: float, inside: Floats, passed: Floats, failed: Floats) -> Floats:
    """Of hazards `rate` (rates,) in one cell, from counts (inside,): (rates,)."""
    rates = np.atleast_1d(np.asarray(rate, dtype=np.float64))
    weight = (inside / CROWD) ** power
    events = failed > 0
    lost = -np.expm1(-np.outer(rates, weight[events]))
    found = -rates * float(passed @ weight) + np.log(lost) @ failed[events]
    return np.asarray(found)


def best_rate(power: float, inside: Floats, passed: Floats, failed: Floats) -> tuple[float, float]:
    """Lambda of greatest likelihood for a given g, and its log likelihood; 0 where nothing failed."""
    if not failed.any():
        return 0.0, 0.0
    found = minimize_scalar(
        lambda q: -float(log_likelihood(np.exp(q), power, inside, passed, failed)[0]),
        bounds=(np.log(RATES[0]), np.log(RATES[-1])),
        method="bounded",
        options={"xatol": 1e-6},
    )
    return float(np.exp(found.x)), -float(found.fun)


def fit(
    counts: xr.Dataset,
    powers: Sequence[float] = POWERS,
    along: str = "v_d",
    confidence: float = 0.95,
    draws: int = 4000,
    seed: int = 0,
) -> Law:
    """Fit one power g to all cells along v_d, and a hazard lambda to each: maximum likelihood, and posterior.

    The interval of g is that of the likelihood ratio; those of lambda are percentiles of the posterior, which
    predictions are drawn from, with flat priors of g among `powers` and of sqrt(lambda) (Jeffreys's for a rate),
    so that a cell in which nothing failed keeps an upper limit.

    Parameters
    ----------
    counts : Dataset of `chances` with the one axis `along`
    powers : the g that are tried; CONSTANT for the hazard that is the same for everybody
    confidence, draws, seed : of the intervals, and of the draws from the posterior

    Raises
    ------
    ValueError
        If `confidence` is not within (0, 1), or there is an axis besides.
    """
    check_resampling(confidence, draws)
    extra = [str(dim) for dim in counts.passed.dims if dim not in (along, "inside")]
    if extra:
        raise ValueError(f"counts have the axis {extra[0]!r} besides {along!r}: select a value, or count over it")
    inside = counts.inside.values.astype(np.float64)
    cells = [
        (p.astype(np.float64), f.astype(np.float64))
        for p, f in zip(*(counts[name].transpose(along, "inside").values for name in ("passed", "failed")), strict=True)
    ]
    tried = np.asarray(powers, dtype=np.float64)
    profile = np.array([sum(best_rate(g, inside, *cell)[1] for cell in cells) for g in tried])
    best = int(profile.argmax())
    near = tried[profile >= profile[best] - stats.chi2.ppf(confidence, 1) / 2.0]
    ends = (float(near[0]), float(near[-1])) if tried.size > 1 else (np.nan, np.nan)
    rate = np.array([best_rate(tried[best], inside, *cell)[0] for cell in cells])
    drawn_powers, drawn_rates = _posterior(tried, inside, cells, draws, seed)
    beyond = (1.0 - confidence) / 2.0
    low, high = np.quantile(drawn_rates, [beyond, 1.0 - beyond], axis=0)
    return Law(float(tried[best]), *ends, rate, low, high, drawn_powers, drawn_rates, float(profile[best]))


def _posterior(
    tried: Floats, inside: Floats, cells: list[tuple[Floats, Floats]], draws: int, seed: int
) -> tuple[Floats, Floats]:
    """Draws of g (draws,) and lambda (draws, cells), from weights on the grid of POWERS and RATES."""
    rng = np.random.default_rng(seed)
    prior = 0.5 * np.log(RATES)  # sqrt(lambda) flat, on a grid of log(lambda)
    weights = np.array([[log_likelihood(RATES, g, inside, *cell) + prior for cell in cells] for g in tried])
    of_power = logsumexp(weights, axis=2).sum(axis=1)
    which = rng.choice(tried.size, draws, p=np.exp(of_power - logsumexp(of_power)))
    shares = np.exp(weights - logsumexp(weights, axis=2, keepdims=True)).cumsum(axis=2)
    below = rng.random((draws, len(cells)))[:, :, None] > shares[which]
    spread = np.log(RATES[1] / RATES[0]) * (rng.random((draws, len(cells))) - 0.5)
    return tried[which], RATES[np.minimum(below.sum(axis=2), RATES.size - 1)] * np.exp(spread)


def share_of(rate: Floats, power: Floats | float, N: int) -> Floats:
    """Probability that a crowd of N blocks: rate (..., cells), power (...) -> (..., cells)."""
    n = np.arange(1, N + 1) / CROWD
    chances_of_all = (n[:, None] ** np.atleast_1d(power)).sum(axis=0)
    return np.asarray(-np.expm1(-rate * (chances_of_all[:, None] if rate.ndim > 1 else chances_of_all)))


def predicted(law: Law, N: int, blocked: Ints, runs: Ints, confidence: float = 0.95, seed: int = 1) -> xr.Dataset:
    """Blocked shares that a law gives for crowds of N, against runs that it was not fitted to.

    Parameters
    ----------
    law : what `fit` gave, for the same cells
    N : persons
    blocked, runs : (cells,) int, what was found
    confidence, seed : of the intervals; of the drawn numbers of blocked runs

    Returns
    -------
    Dataset with `likeliest_share` (v_d), of the maximum of the likelihood; `predicted_share` and `_low`, `_high` (v_d):
    mean and percentiles over the posterior; `predicted_runs_low`, `_high` (v_d): interval of the number of blocked runs
    among `runs`; `total`, `total_low`, `total_high`: of blocked runs in all cells; and `p_value`: the share of drawn
    sets of runs that are as unlikely under the prediction as those found, or more so. A small one rules the law out.
    """
    check_resampling(confidence)
    rng, ends = np.random.default_rng(seed), [(1.0 - confidence) / 2.0, (1.0 + confidence) / 2.0]
    share = share_of(law.rates, law.powers, N)
    made = rng.binomial(runs, share)
    mean = share.mean(axis=0).clip(1e-12, 1.0 - 1e-12)
    surprise = -stats.binom.logpmf(made, runs, mean).sum(axis=1)
    found = -stats.binom.logpmf(blocked, runs, mean).sum()
    (low, high), (few, many) = np.quantile(share, ends, axis=0), np.quantile(made, ends, axis=0)
    least, most = np.quantile(made.sum(axis=1), ends)
    return xr.Dataset(
        {
            "likeliest_share": ("v_d", share_of(law.rate, law.power, N)),
            "predicted_share": ("v_d", mean),
            "predicted_share_low": ("v_d", low),
            "predicted_share_high": ("v_d", high),
            "predicted_runs_low": ("v_d", few),
            "predicted_runs_high": ("v_d", many),
            "total": float(made.sum(axis=1).mean()),
            "total_low": float(least),
            "total_high": float(most),
            "p_value": float((surprise >= found - 1e-9).mean()),
        }
    )
