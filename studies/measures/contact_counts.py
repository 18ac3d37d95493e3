"""What each run's contacts come to, small enough to put runs side by side, and shares pooled over runs."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from studies.measures.arches import arch_log, breaks
from studies.measures.clogging import arch_clogging
from studies.measures.clusters import LARGE, cluster_sizes
from studies.measures.contacts import SLACK, doorway, history
from studies.measures.delays import PARISI_BINS
from studies.measures.facts import KNOWN, UNFINISHED, Over, count, described, dims_over, outcome_is
from studies.measures.paths import paths
from studies.measures.uncertainty import check_resampling, share_and_interval, wilson

KINDS = ("any", "clean")  # of arches
SIZES = np.arange(1, 31)  # persons of an arch, the last for as many or more; the same for crowds of any size


def contact_counts(
    run: xr.Dataset, edges: Sequence[float] = PARISI_BINS, more_than: int = LARGE, door: int = 0
) -> xr.Dataset:
    """All that the pooled measures need of one run's contacts: numbers of samples, delays and arches.

    The results of runs, put side by side with `xr.concat(found, "seed")`, or given coordinates by
    `expand_dims(v_d=[4.0], seed=[0])` and put together with `xr.combine_by_coords(found, data_vars="all")`, are
    the dataset of `cluster_probability`, `blocking_probability` and `arch_clogging_correlation`.

    Parameters
    ----------
    run : one run, as for `blocking_clusters`
    edges : sequence of float, s
        Bins of delays, as in `delay_counts`.
    more_than : int
        A cluster of more persons is large.
    door : int
        Number of the door.

    Returns
    -------
    Dataset with `samples`, from the start to the last exit (through any door), and those of them with a large
    cluster, `large_cluster_samples`, and with a blocking cluster, `blocked_samples` (kind); `delay_count`
    (delay) and `clogged_count` (kind, delay) as in `arch_clogging`; `arch_count` (kind, arch_size), arches by
    the number of their persons, and `longest_lifetime` (kind, arch_size) s of those that broke, NaN without
    any, where arches of 30 persons or more count as 30; `interval` s, between samples; `censored` bool: the run
    did not finish. `kind` is "any" or "clean". An unstable run counts no samples, delays and arches.

    Raises
    ------
    ValueError
        As `granular_clusters` and `arch_clogging`.
    """
    h, way = history(run), doorway(run, door)
    known, left = outcome_is(run, *KNOWN).item(), run.exit_time.values
    counted = known & (h.time <= np.max(left, initial=-np.inf, where=np.isfinite(left)) + SLACK)
    large = np.zeros(h.time.size, dtype=bool)
    sample, size = cluster_sizes(h)
    large[sample[size > more_than]] = True
    found = paths(h, way)
    until = breaks(h, way, found)
    logs = [arch_log(h, found, until, clean=kind == "clean") for kind in KINDS]
    clogged = [arch_clogging(run, edges=edges, door=door, log=log) for log in logs]
    kind = xr.DataArray(list(KINDS), dims="kind", name="kind", attrs={"long_name": "arches that count"})
    hits = [counted[found.sample].sum(), counted[found.sample[found.clean]].sum()]
    sizes = [by_size(log, known) for log in logs]
    return xr.Dataset(
        {
            "samples": described(xr.DataArray(counted.sum()), "1", "samples from the start to the last exit"),
            "large_cluster_samples": described(
                xr.DataArray((large & counted).sum()),
                "1",
                f"samples with a granular cluster of more than {more_than} persons",
            ),
            "blocked_samples": described(xr.DataArray(hits, dims="kind"), "1", "samples with a blocking cluster"),
            "delay_count": clogged[0].delay_count,
            "clogged_count": xr.concat([of.clogged_count for of in clogged], dim=kind),
            "interval": described(xr.DataArray(h.interval), "s", "sampling interval"),
            "censored": described(outcome_is(run, *UNFINISHED), "1", "run did not finish"),
        }
    ).merge(xr.concat(sizes, dim=kind))


def by_size(log: xr.Dataset, known: bool) -> xr.Dataset:
    """Number and longest lifetime of the arches of each size, none in a run that does not count."""
    size, lifetime = log.arch_size.values.clip(max=SIZES[-1]), log.lifetime.values
    of_size = [known & (size == n) for n in SIZES]
    longest = [lifetime[of & np.isfinite(lifetime)].max(initial=-np.inf) for of in of_size]
    lasts = xr.DataArray(longest, dims="arch_size")
    found = xr.Dataset(
        {
            "arch_count": described(xr.DataArray([of.sum() for of in of_size], dims="arch_size"), "1", "arches"),
            "longest_lifetime": described(lasts.where(lasts > 0), "s", "longest lifetime of an arch that broke"),
        },
        coords={"arch_size": SIZES},
    )
    found["arch_size"].attrs = {"units": "1", "long_name": "persons in the arch, the last for as many or more"}
    return found


def pooled(
    ds: xr.Dataset,
    hits: str,
    trials: str,
    share: tuple[str, str],
    number: tuple[str, str],
    over: Over,
    confidence: float,
    resamples: int,
    seed: int,
) -> xr.Dataset:
    """Share of hits among the trials of all runs, with a bootstrap interval over whole runs and what is behind it.

    Raises
    ------
    ValueError
        As `cluster_probability`.
    """
    absent = [name for name in (hits, trials, "censored") if name not in ds]
    if absent:
        raise ValueError(
            f"dataset has no variable {', '.join(absent)} (it holds {', '.join(map(str, ds.data_vars)) or 'none'}):"
            " put results of contact_counts side by side"
        )
    dims = dims_over(ds.censored, over)
    check_resampling(confidence, resamples)
    made, of = (ds[name].fillna(0) for name in (hits, trials))
    found = share_and_interval(made.expand_dims("place"), of, dims, "place", confidence, resamples, seed)
    at, low, high = (limit.isel(place=0) for limit in found)
    runs = count(of > 0, dims, "runs behind the share")
    low, high = where_all_agree(at, low, high, runs, confidence)
    name, text = share
    number_name, number_text = number
    variables = {
        name: described(at, "1", text),
        f"{name}_low": described(low, "1", f"{text}: lower limit", confidence=confidence),
        f"{name}_high": described(high, "1", f"{text}: upper limit", confidence=confidence),
        number_name: described(of.sum(dims).astype(np.int64), "1", number_text),
        "runs": runs,
        "censored": count(ds.censored.fillna(0) > 0, dims, "runs that did not finish"),
    }
    return xr.Dataset(variables)


def where_all_agree(
    share: xr.DataArray, low: xr.DataArray, high: xr.DataArray, runs: xr.DataArray, confidence: float
) -> tuple[xr.DataArray, xr.DataArray]:
    """Limits of a share, with Wilson's for so many runs in place of those of resamples that are all 0 or all 1.

    Runs that all agree on none, or on all, say nothing by resampling. A run with at least one hit is no rarer
    than a hit among its trials, so that the upper limit of the share of such runs holds for hits too.
    """

    def limit(hit: bool) -> xr.DataArray:
        found: xr.DataArray = xr.apply_ufunc(
            lambda n: wilson(int(n) if hit else 0, int(n), confidence)[0 if hit else 1],
            runs.where(runs > 1, 0),
            vectorize=True,
            output_dtypes=[np.float64],
        )
        return found

    return low.where(share != 1, limit(True)), high.where(share != 0, limit(False))


def cluster_probability(
    ds: xr.Dataset, over: Over = "seed", confidence: float = 0.95, resamples: int = 2000, seed: int = 0
) -> xr.Dataset:
    """Probability of a large granular cluster (Parisi & Dorso 2005, Fig. 5: of more than 10 persons).

    Parameters
    ----------
    ds : results of `contact_counts`, side by side
    over : str or sequence of str
        Dimensions pooled.
    confidence, resamples, seed
        Of the bootstrap. It draws whole runs, for the samples of one run are not independent.

    Returns
    -------
    Dataset with `cluster_probability`, `_low`, `_high` (axes...), share of the samples of all runs from the
    start to each run's last exit; `samples`; `runs`, those with any; `censored`, runs that did not finish, which
    count up to their last exit. The limits are NaN for fewer than two runs; where all samples, or none, of all
    runs have a cluster, the limit on the other side is Wilson's for as many runs.

    Raises
    ------
    ValueError
        If `over` is not a dimension, `confidence` not within (0, 1), `resamples` below 1, or a variable is
        missing.
    """
    share = ("cluster_probability", "probability of a large granular cluster")
    number = ("samples", "samples from the start to the last exit")
    return pooled(ds, "large_cluster_samples", "samples", share, number, over, confidence, resamples, seed)


def blocking_probability(
    ds: xr.Dataset, over: Over = "seed", confidence: float = 0.95, resamples: int = 2000, seed: int = 0
) -> xr.Dataset:
    """Probability of a blocking cluster (Parisi & Dorso 2005, Figs. 9 and 10), any and clean.

    Parameters
    ----------
    ds, over, confidence, resamples, seed
        As in `cluster_probability`.

    Returns
    -------
    Dataset with `blocking_probability`, `_low`, `_high` (axes..., kind), share of the samples of all runs from
    the start to each run's last exit; `samples`, `runs` and `censored` as in `cluster_probability`.

    Raises
    ------
    ValueError
        As `cluster_probability`.
    """
    share = ("blocking_probability", "probability of a blocking cluster")
    number = ("samples", "samples from the start to the last exit")
    return pooled(ds, "blocked_samples", "samples", share, number, over, confidence, resamples, seed)


def arch_clogging_correlation(
    ds: xr.Dataset, over: Over = "seed", confidence: float = 0.95, resamples: int = 2000, seed: int = 0
) -> xr.Dataset:
    """Arch-clogging correlation c_ac, mean of f in bins of delay (Parisi & Dorso 2005, Eq. 6, Fig. 8).

    The delays of all runs are pooled; the mean of each run's own coefficient would have no value for the runs
    without a delay in the bin.

    Parameters
    ----------
    ds, over, confidence, resamples, seed
        As in `cluster_probability`.

    Returns
    -------
    Dataset with `c_ac`, `c_ac_low`, `c_ac_high` (axes..., kind, delay), NaN without delays in the bin;
    `delays`, their number, and `runs`, those with any, (axes..., delay); `censored` (axes...), runs that did
    not finish, whose last wait is no delay. The limits are NaN for fewer than two runs with a delay in the bin;
    where all f are 0, or 1, the limit on the other side is Wilson's for as many runs.

    Raises
    ------
    ValueError
        As `cluster_probability`.
    """
    share = ("c_ac", "arch-clogging correlation")
    number = ("delays", "delays pooled")
    return pooled(ds, "clogged_count", "delay_count", share, number, over, confidence, resamples, seed)
