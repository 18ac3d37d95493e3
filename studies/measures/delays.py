"""Delays between consecutive exits: their survival function and their numbers in bins."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from studies.measures.exits import instants
from studies.measures.facts import KNOWN, UNFINISHED, Over, count, described, dims_over, needs, outcome_is
from studies.measures.uncertainty import check_resampling, share_and_interval

PARISI_BINS = (0.1, 0.3, 1.0, 2.3, np.inf)  # s; Parisi & Dorso (2005), Figs. 7 and 8


def delays(ds: xr.Dataset, first: int = 1, last: int | None = None) -> xr.Dataset:
    """Delays d_k = t_{k+1} - t_k between the exits number `first` and `last`.

    Parameters
    ----------
    ds : gathered dataset
    first, last : int
        Ranks of leaving that bound the window: k runs from `first` to `last` - 1. None: to the last exit.

    Returns
    -------
    Dataset with `delay` (axes..., exit) s, where `exit` is the rank k of the person after whom one waits. NaN
    beyond a run's last exit and where the run is missing or unstable. The wait after the last exit of an
    unfinished run is no delay: `delay_survival` and `delay_counts` count such open waits.

    Raises
    ------
    ValueError
        If `first` is below 1, `last` is not above it, or a variable is missing.
    """
    needs(ds, "exit_time")
    if first < 1 or (last is not None and last <= first):
        raise ValueError(f"first={first}, last={last} is no window of ranks: 1 <= first < last is required")
    t = ds.exit_time.where(outcome_is(ds, *KNOWN)).sel(exit=slice(first, last))
    d = t.diff("exit", label="lower")
    d["exit"].attrs = {"units": "1", "long_name": "rank of leaving of the person after whom the delay begins"}
    return xr.Dataset({"delay": described(d, "s", "delay between consecutive exits")})


def open_waits(ds: xr.Dataset, first: int, last: int | None) -> xr.DataArray:
    """Whether an unfinished run's last wait began inside the window of ranks: (axes...) bool."""
    needs(ds, "N_out")
    inside = (ds.N_out >= first) & (ds.N_out < (np.inf if last is None else last))
    waits: xr.DataArray = inside & outcome_is(ds, *UNFINISHED)
    return waits


def delay_survival(
    ds: xr.Dataset,
    at: ArrayLike,
    over: Over = "seed",
    first: int = 10,
    last: int | None = 160,
    confidence: float = 0.95,
    resamples: int = 1000,
    seed: int = 0,
) -> xr.Dataset:
    """Survival function P(d > t) of the delays, pooled over runs (Parisi & Dorso 2005, Fig. 3: ranks 10-160).

    Parameters
    ----------
    ds : gathered dataset
    at : (times,) float, s
    over : str or sequence of str
        Dimensions pooled.
    first, last : int
        Window of ranks, as in `delays`.
    confidence, resamples, seed
        Of the bootstrap. It draws whole runs, for the delays of one run are not independent.

    Returns
    -------
    Dataset with `delay_survival`, `_low`, `_high` (axes..., time), share of the delays that ended; `delays`,
    their number; `runs` that have any; `censored`, the runs with a wait that nobody ended inside the window.
    These waits, longer than the blocking time, are not among the delays: where `censored` is not 0 the tail
    is a lower bound. The limits are NaN for fewer than two runs.

    Raises
    ------
    ValueError
        If `over` is not a dimension, the window is empty, a time is not finite or a variable is missing.
    """
    times, dims = instants(at), dims_over(ds, over)
    check_resampling(confidence, resamples)
    d = delays(ds, first, last).delay
    ended = d.notnull().sum("exit")
    longer = xr.concat([(d > t).sum("exit") for t in times], dim="time").assign_coords(time=times)
    longer["time"].attrs = {"units": "s", "long_name": "time"}
    found = share_and_interval(longer, ended, dims, "time", confidence, resamples, seed)
    texts = ("share of delays longer than the time", "survival: lower limit", "survival: upper limit")
    names = ("delay_survival", "delay_survival_low", "delay_survival_high")
    variables = {name: described(v, "1", text) for name, v, text in zip(names, found, texts, strict=True)}
    return xr.Dataset(
        variables
        | {
            "delays": count(ended, dims, "delays pooled"),
            "runs": count(ended > 0, dims, "runs with a delay in the window"),
            "censored": count(open_waits(ds, first, last), dims, "runs with an unended wait in the window"),
        }
    )


def in_bins(d: xr.DataArray, edges: Sequence[float]) -> xr.DataArray:
    """Number of delays d (axes..., exit) in the bins [edge, next edge): (axes..., delay).

    Raises
    ------
    ValueError
        If the edges do not ascend.
    """
    bounds = np.asarray(edges, dtype=np.float64)
    if bounds.size < 2 or not (np.diff(bounds) > 0).all():
        raise ValueError(f"edges={tuple(edges)} do not ascend: give at least two edges in s, each above the last")
    inside = [((d >= a) & (d < b)).sum("exit") for a, b in pairwise(bounds)]
    counts = xr.concat(inside, dim="delay").transpose(..., "delay")
    counts = counts.assign_coords(delay=bounds[:-1], delay_end=("delay", bounds[1:]))
    counts["delay"].attrs = {"units": "s", "long_name": "least delay of the bin"}
    counts["delay_end"].attrs = {"units": "s", "long_name": "delay below which the bin ends"}
    return counts


def delay_counts(
    ds: xr.Dataset, edges: Sequence[float] = PARISI_BINS, first: int = 1, last: int | None = None
) -> xr.Dataset:
    """Number of delays of each run in the bins [edge, next edge).

    Parameters
    ----------
    ds : gathered dataset
    edges : sequence of float, s
        Ascending; the last may be inf. The default leaves out the delays below 0.1 s, as the paper's figures
        do.
    first, last : int
        Window of ranks, as in `delays`.

    Returns
    -------
    Dataset with `delay_count` (axes..., delay) float, NaN where the run is missing or unstable; coordinates
    `delay` and `delay_end` (delay), the bins' edges, s; `open_wait` (axes...) bool: an unfinished run's last
    wait, in no bin.

    Raises
    ------
    ValueError
        If the edges do not ascend, the window is empty or a variable is missing.
    """
    counts = in_bins(delays(ds, first, last).delay, edges).where(outcome_is(ds, *KNOWN))
    return xr.Dataset(
        {
            "delay_count": described(counts, "1", "delays in the bin"),
            "open_wait": described(open_waits(ds, first, last), "1", "last wait was not ended by an exit"),
        }
    )
