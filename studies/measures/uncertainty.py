"""Means, shares and rates over runs with intervals: bootstrap over runs, Wilson, exact Poisson."""

from functools import lru_cache

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy import stats

from studies.measures.facts import Over, count, described, dims_over

Floats = NDArray[np.float64]
Interval = tuple[float, float]


@lru_cache(maxsize=16)  # one a cell of a column
def resampling_weights(n: int, resamples: int, seed: int) -> Floats:
    """How often each of n runs is drawn in each resample: (resamples, n), rows sum to n."""
    drawn = np.random.default_rng(seed).multinomial(n, np.full(n, 1.0 / n), size=resamples)
    return drawn.astype(np.float64)


def tail(n: int, confidence: float) -> float:
    """Tail of the expanded percentile interval for n values.

    The plain percentile interval of a mean is too narrow by sqrt((n - 1)/n) and by the ratio of the normal to
    the Student quantile. Hesterberg (2015), Am. Stat. 69, 371, sec. 3.3, moves the percentiles outwards by
    both.
    """
    student = stats.t.ppf((1.0 - confidence) / 2.0, n - 1)
    return float(stats.norm.cdf(student * np.sqrt(n / (n - 1))))


def bootstrap_interval(estimates: Floats, n: int, confidence: float) -> Floats:
    """Expanded percentile interval of bootstrap estimates (resamples, ...) from n runs: (2, ...)."""
    low = tail(n, confidence)
    return np.quantile(estimates, [low, 1.0 - low], axis=0)


def stretched_interval(mean: float, means: Floats, n: int, confidence: float) -> Interval:
    """Percentile interval of bootstrapped means (resamples,) arms stretched by (t/z) sqrt(n/(n - 1)).

    The same correction as in `tail`, made in length: percentiles cannot leave the range of the values, which
    misses the true mean of five normal values in 1 of 16 samples.
    """
    low = (1.0 - confidence) / 2.0
    stretch = stats.t.ppf(low, n - 1) / stats.norm.ppf(low) * np.sqrt(n / (n - 1))
    below, above = mean + stretch * (np.quantile(means, [low, 1.0 - low]) - mean)
    return float(below), float(above)


def _mean_and_interval(values: Floats, confidence: float, resamples: int, seed: int) -> tuple[float, float, float]:
    """Mean of the finite values with its interval; NaN for what the number of values does not allow."""
    finite = values[np.isfinite(values)]
    n = finite.size
    if n < 2:
        return (float(finite[0]) if n else np.nan), np.nan, np.nan
    mean = float(finite.mean())
    # Resampling the deviations keeps a constant sample's interval at its value, without rounding.
    means = mean + resampling_weights(n, resamples, seed) @ (finite - mean) / n
    return mean, *stretched_interval(mean, means, n, confidence)


def mean_over(
    da: xr.DataArray,
    over: Over = "seed",
    censored: xr.DataArray | None = None,
    confidence: float = 0.95,
    resamples: int = 2000,
    seed: int = 0,
) -> xr.Dataset:
    """Mean of the finite values over runs, with a bootstrap interval and the number of runs behind it.

    Infinite values (a blocked run's clearance time) and NaN are never averaged in: `runs` says how many
    values were, and `censored` how many runs did not finish.

    Parameters
    ----------
    da : (axes..., over) float
        One value a run.
    over : str or sequence of str
        Dimensions the mean is taken over.
    censored : (axes..., over) bool, optional
        Runs that did not finish, as `clearance(ds).censored`.
    confidence : float
        Of the percentile interval, its arms stretched for small samples. NaN for fewer than two values.
    resamples, seed : int
        Number of bootstrap resamples and the seed of their draw.

    Returns
    -------
    Dataset with the variable's own name, `<name>_low`, `<name>_high` (its units), `runs` and `censored` (1).

    Raises
    ------
    ValueError
        If `over` is not a dimension, `confidence` not within (0, 1), or `resamples` below 1.
    """
    dims = dims_over(da, over)
    check_resampling(confidence, resamples)
    found = xr.apply_ufunc(
        lambda cell: _mean_and_interval(cell.ravel(), confidence, resamples, seed),
        da.astype(np.float64),
        input_core_dims=[dims],
        output_core_dims=[[], [], []],
        vectorize=True,
    )
    not_finished = xr.zeros_like(da, dtype=bool) if censored is None else censored
    return with_counts(da, found, confidence, xr.apply_ufunc(np.isfinite, da), not_finished, dims)


def with_counts(
    da: xr.DataArray,
    found: tuple[xr.DataArray, ...],
    confidence: float,
    averaged: xr.DataArray,
    censored: xr.DataArray,
    dims: list[str],
) -> xr.Dataset:
    """Assemble a mean, its two limits and its two counts, named and described after `da`."""
    name, units = str(da.name or "value"), da.attrs.get("units", "1")
    what = da.attrs.get("long_name", name)
    mean = what if what.startswith("mean ") else f"mean {what}"
    texts = (mean, f"{what}: lower limit", f"{what}: upper limit")
    names = (name, f"{name}_low", f"{name}_high")
    level = [{}, {"confidence": confidence}, {"confidence": confidence}]
    variables = {n: described(f, units, text, **a) for n, f, text, a in zip(names, found, texts, level, strict=True)}
    variables["runs"] = count(averaged, dims, "runs averaged")
    variables["censored"] = count(censored, dims, "runs that did not finish")
    return xr.Dataset(variables)


def _pooled_share(
    hits: Floats, trials: Floats, confidence: float, resamples: int, seed: int
) -> tuple[Floats, Floats, Floats]:
    """Pooled share of hits (runs, places) among trials (runs,), with its interval: three times (places,)."""
    tried = trials > 0
    n, nothing = int(tried.sum()), np.full(hits.shape[1], np.nan)
    if n == 0:
        return nothing, nothing, nothing
    hits, trials = hits[tried], trials[tried]
    share = hits.sum(axis=0) / trials.sum()
    if n == 1:
        return share, nothing, nothing
    weights = resampling_weights(n, resamples, seed)
    low, high = bootstrap_interval(weights @ hits / (weights @ trials)[:, None], n, confidence)
    return share, low, high


def share_and_interval(
    hits: xr.DataArray,
    trials: xr.DataArray,
    dims: list[str],
    place: str,
    confidence: float,
    resamples: int,
    seed: int,
) -> tuple[xr.DataArray, ...]:
    """Share of `hits` (axes..., dims, place) among `trials` (axes..., dims), and limits: (axes..., place)."""
    found: tuple[xr.DataArray, ...] = xr.apply_ufunc(
        lambda h, m: _pooled_share(h.reshape(m.size, -1), m.ravel(), confidence, resamples, seed),
        hits.astype(np.float64),
        trials.astype(np.float64),
        input_core_dims=[[*dims, place], dims],
        output_core_dims=[[place]] * 3,
        vectorize=True,
    )
    return found


def check_resampling(confidence: float, resamples: int = 1) -> None:
    """Raise ValueError unless 0 < confidence < 1 and resamples >= 1."""
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence {confidence} is not between 0 and 1: give a share such as 0.95")
    if resamples < 1:
        raise ValueError(f"resamples {resamples} is below 1: give a number such as 2000")


@lru_cache(maxsize=4096)
def wilson(blocked: int, runs: int, confidence: float) -> Interval:
    """Wilson interval of a share (scipy.stats.binomtest); NaN without runs."""
    if runs == 0:
        return np.nan, np.nan
    limits = stats.binomtest(blocked, runs).proportion_ci(confidence, method="wilson")
    return float(limits.low), float(limits.high)


def poisson(events: int, exposure: float, confidence: float) -> Interval:
    """Exact (chi-squared) interval of events/exposure, after Garwood (1936); NaN without exposure."""
    if exposure == 0:
        return np.nan, np.nan
    beyond = (1.0 - confidence) / 2.0
    low = stats.chi2.ppf(beyond, 2 * events) / 2.0 if events else 0.0
    high = stats.chi2.ppf(1.0 - beyond, 2 * events + 2) / 2.0
    return float(low / exposure), float(high / exposure)
