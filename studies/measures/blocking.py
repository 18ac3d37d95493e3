"""How often the exit blocks: the share of blocked runs and the hazard of blocking per exit."""

import numpy as np
import xarray as xr

from studies.measures.facts import BLOCKED, KNOWN, Over, count, described, dims_over, needs, outcome_is
from studies.measures.uncertainty import check_resampling, poisson, wilson


def run_counts(ds: xr.Dataset, over: Over) -> xr.Dataset:
    """Numbers of runs, of blocked ones and of those at the time limit, over the dimensions `over`: (axes...).

    A run counts unless it is missing or unstable. Blocked means blocked or frozen.
    """
    dims = dims_over(ds, over)
    return xr.Dataset(
        {
            "runs": count(outcome_is(ds, *KNOWN), dims, "runs, neither missing nor unstable"),
            "blocked": count(outcome_is(ds, *BLOCKED), dims, "blocked runs"),
            "censored": count(outcome_is(ds, "time_limit"), dims, "runs at the time limit, that might block later"),
        }
    )


def blocked_share(ds: xr.Dataset, over: Over = "seed", confidence: float = 0.95) -> xr.Dataset:
    """Share of runs that blocked, with its Wilson interval.

    Parameters
    ----------
    ds : gathered dataset
    over : str or sequence of str
        Dimensions over which runs are counted.
    confidence : float

    Returns
    -------
    Dataset with `blocked_share`, `blocked_share_low`, `blocked_share_high` (axes...), NaN without runs;
    `runs` (missing and unstable ones are none), `blocked` and `censored`, the runs at the time limit, which
    are runs that did not block.

    Raises
    ------
    ValueError
        If `over` is not a dimension, `confidence` not within (0, 1), or a variable is missing.
    """
    check_resampling(confidence)
    counts = run_counts(ds, over)
    low, high = xr.apply_ufunc(
        lambda k, n: wilson(int(k), int(n), confidence),
        counts.blocked,
        counts.runs,
        output_core_dims=[[], []],
        vectorize=True,
        output_dtypes=[np.float64, np.float64],
    )
    share = counts.blocked / counts.runs.where(counts.runs > 0)
    return counts.assign(
        blocked_share=described(share, "1", "share of blocked runs"),
        blocked_share_low=described(low, "1", "blocked share: lower limit", confidence=confidence),
        blocked_share_high=described(high, "1", "blocked share: upper limit", confidence=confidence),
    )


def hazard_of_blocking(ds: xr.Dataset, over: Over = "seed", confidence: float = 0.95) -> xr.Dataset:
    """Hazard of blocking per exit: blocked runs / exits made, with its exact Poisson interval (Garwood 1936).

    Parameters
    ----------
    ds : gathered dataset
    over : str or sequence of str
        Dimensions over which runs and exits are counted.
    confidence : float

    Returns
    -------
    Dataset with `hazard_of_blocking`, `_low`, `_high` (axes...) per exit, NaN where nobody got out; `exits`,
    the exits made by all runs, `runs`, `blocked` and `censored` as in `blocked_share`. An unfinished run's
    exits count: that is how a hazard takes in censored runs.

    Raises
    ------
    ValueError
        If `over` is not a dimension, `confidence` not within (0, 1), or a variable is missing.
    """
    needs(ds, "N_out")
    check_resampling(confidence)
    counts = run_counts(ds, over)
    exits = count(ds.N_out.where(outcome_is(ds, *KNOWN), 0), over, "exits made")
    low, high = xr.apply_ufunc(
        lambda k, n: poisson(int(k), float(n), confidence),
        counts.blocked,
        exits,
        output_core_dims=[[], []],
        vectorize=True,
        output_dtypes=[np.float64, np.float64],
    )
    return counts.assign(
        exits=exits,
        hazard_of_blocking=described(counts.blocked / exits.where(exits > 0), "1", "hazard of blocking per exit"),
        hazard_of_blocking_low=described(low, "1", "hazard of blocking: lower limit", confidence=confidence),
        hazard_of_blocking_high=described(high, "1", "hazard of blocking: upper limit", confidence=confidence),
    )
