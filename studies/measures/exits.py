"""Exit times read as clearance times, discharge curves and times of the n-th exit."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from studies.measures.facts import BLOCKED, FINISHED, KNOWN, UNFINISHED, described, needs, outcome_is

Floats = NDArray[np.float64]


def censoring(ds: xr.Dataset) -> xr.Dataset:
    """Which runs did not finish, and how long they were watched.

    Returns
    -------
    Dataset with `censored` (axes...) bool: blocked, frozen or at the time limit; `censoring_time` (axes...)
    s: the end time of such a run, NaN for the others. Missing and unstable runs are not censored, they are no
    result.
    """
    needs(ds, "end_time")
    censored = outcome_is(ds, *UNFINISHED)
    until = ds.end_time.where(censored)
    return xr.Dataset(
        {
            "censored": described(censored, "1", "run did not finish"),
            "censoring_time": described(until, "s", "time until which an unfinished run was watched"),
        }
    )


def last_exit(ds: xr.Dataset) -> xr.DataArray:
    """Time of the last exit of each run, finished or not: (axes...) s, NaN where nobody got out."""
    needs(ds, "exit_time")
    last = ds.exit_time.fillna(-np.inf).max("exit")
    when: xr.DataArray = last.where(last > -np.inf)
    return when


def clearance(ds: xr.Dataset) -> xr.Dataset:
    """Clearance time t_N: the time at which the last person gets out.

    Parameters
    ----------
    ds : gathered dataset with `exit_time` (axes..., exit) s, `outcome` and `end_time` (axes...)

    Returns
    -------
    Dataset with `clearance_time` (axes...) s: t_N where all got out, inf where blocked or frozen (as in Lin,
    Ma & Lo 2016, Fig. 7), NaN where the time limit came first, the run was unstable or is missing;
    and `censored`, `censoring_time`.

    Raises
    ------
    ValueError
        If a variable or the outcome's flag attributes are missing.
    """
    out = last_exit(ds).where(outcome_is(ds, *FINISHED))
    out = out.where(~outcome_is(ds, *BLOCKED), np.inf)
    return censoring(ds).assign(clearance_time=described(out, "s", "clearance time"))


def instants(at: ArrayLike) -> Floats:
    """Times as a one-dimensional float array, checked to be finite."""
    times = np.atleast_1d(np.asarray(at, dtype=np.float64))
    if times.ndim != 1 or not np.isfinite(times).all():
        raise ValueError(f"at={at!r} is not a list of finite times: give times in s, such as range(0, 300, 10)")
    return times


def exits_until(ds: xr.Dataset, times: Floats, dim: str) -> xr.DataArray:
    """Number of exits at or before each time: (axes..., dim); NaN of the padding sorts behind every time."""
    needs(ds, "exit_time")
    made: xr.DataArray = xr.apply_ufunc(
        lambda t: np.searchsorted(t, times, side="right"),
        ds.exit_time,
        input_core_dims=[["exit"]],
        output_core_dims=[[dim]],
        vectorize=True,
        output_dtypes=[np.int64],
    )
    counted: xr.DataArray = made.assign_coords({dim: times})
    return counted


def discharge(ds: xr.Dataset, at: ArrayLike) -> xr.Dataset:
    """Discharge curve n(t): persons out at or before t.

    Parameters
    ----------
    ds : gathered dataset
    at : (times,) float, s

    Returns
    -------
    Dataset with `discharge` (axes..., time), persons. It stays at its last value after everybody is out and
    in a frozen run, which is proven at rest; after the end of any other unfinished run it is NaN, for nobody
    watched. NaN throughout where the run is missing or unstable.

    Raises
    ------
    ValueError
        If a variable is missing or a time is not finite.
    """
    needs(ds, "end_time")
    made = exits_until(ds, instants(at), "time")
    made["time"].attrs = {"units": "s", "long_name": "time"}
    stays = outcome_is(ds, "all_out", "frozen")
    watched = outcome_is(ds, *KNOWN) & (stays | (made["time"] <= ds.end_time))
    return xr.Dataset({"discharge": described(made.where(watched), "1", "persons out")})


def time_of_exit(ds: xr.Dataset, n: int | Sequence[int]) -> xr.Dataset:
    """Time t_n at which the n-th person gets out (t_e of Parisi & Dorso 2005, Fig. 1: n = 160, 180, 200).

    Parameters
    ----------
    ds : gathered dataset
    n : int or sequence of int
        Ranks of leaving, from 1. A sequence gives a dimension `n`.

    Returns
    -------
    Dataset with `time_of_exit` (axes..., n) s: inf where the exit blocked before, NaN where the time limit
    came before, the crowd is smaller than n, or the run is missing or unstable; `censored` (axes..., n) bool:
    the run did not finish and its n-th person was inside at its end; `censoring_time` s.

    Raises
    ------
    ValueError
        If a rank is below 1 or a variable is missing.
    """
    needs(ds, "exit_time", "persons")
    ranks = np.atleast_1d(np.asarray(n))
    if ranks.min(initial=1) < 1 or ranks.dtype.kind not in "iu":
        raise ValueError(f"n={n!r} is not a rank of leaving: give whole numbers from 1")
    t_n = ds.exit_time.reindex(exit=ranks).rename(exit="n")
    t_n["n"].attrs = {"units": "1", "long_name": "rank of leaving"}
    awaited = t_n.isnull() & (t_n["n"] <= ds.persons)
    t_n = t_n.where(outcome_is(ds, *KNOWN)).where(~(awaited & outcome_is(ds, *BLOCKED)), np.inf)
    facts = censoring(ds)
    open_end = described(facts.censored & awaited, "1", "run ended before this exit")
    until = described(facts.censoring_time.where(open_end), "s", facts.censoring_time.attrs["long_name"])
    found = xr.Dataset(
        {
            "time_of_exit": described(t_n, "s", "time of the n-th exit"),
            "censored": open_end,
            "censoring_time": until,
        }
    )
    return found.squeeze("n") if np.ndim(n) == 0 else found
