"""Planted cells whose true mean and blocked share are known: how often the intervals hold them when a sweep stops."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy import stats

from engine import OUTCOMES
from studies import measures
from studies.until.rules import HalfWidths
from sweep.schema import GATHERED
from sweep.until import Until

MEAN = 220.0  # s, of a planted clearance time
SHARES = (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 0.9)  # planted blocked shares
SCATTER = (0.02, 0.05, 0.08, 0.12, 0.16, 0.2, 0.3)  # planted standard deviation of clearance times over their mean
CONFIDENCE = 0.95  # of the coverage's own interval


class Covered(NamedTuple):
    """How often the interval of a stopped cell held the planted value."""

    what: str  # "blocked share" or "clearance time"
    planted: float  # the share, or the scatter
    seeds: float  # mean number of seeds when stopped
    share: float  # of the cells whose interval held it
    low: float  # its interval (Wilson)
    high: float


def cells(rng: np.random.Generator, copies: int, supply: int, blocked: float, scatter: float) -> xr.Dataset:
    """Runs of one person with planted clearance times (lognormal, so askew) and blocked share: (copy, seed)."""
    sigma = np.sqrt(np.log1p(scatter**2))
    time = MEAN * np.exp(sigma * rng.standard_normal((copies, supply)) - sigma**2 / 2.0)
    stuck = rng.random((copies, supply)) < blocked
    dims = ("copy", "seed")
    code = {word: k for k, word in enumerate(OUTCOMES)}
    flags = {"flag_values": np.arange(len(OUTCOMES), dtype=np.int8), "flag_meanings": " ".join(OUTCOMES)}
    outcome = np.where(stuck, code["blocked"], code["all_out"]).astype(np.int8)
    return xr.Dataset(
        {
            "outcome": (dims, outcome, flags),
            "exit_time": ((*dims, "exit"), np.where(stuck, np.nan, time)[..., None], {"units": "s"}),
            "end_time": (dims, time, {"units": "s"}),
            "N_out": (dims, (~stuck).astype(np.int32)),
            "persons": (dims, np.ones_like(stuck, dtype=np.int32)),
        },
        coords={"copy": np.arange(copies), "seed": np.arange(supply), "exit": [1]},
    )


def only(ds: xr.Dataset, given: xr.DataArray) -> xr.Dataset:
    """The dataset as if the store held only the runs that are `given` (axes...) bool."""
    pads = {v.name: np.dtype(v.dtype).type(v.pad) for v in GATHERED if v.name in ds}
    return ds.assign({name: ds[name].where(given, pad).transpose(*ds[name].dims) for name, pad in pads.items()})


def settled(ds: xr.Dataset, until: Until) -> NDArray[np.int64]:
    """Seeds (copies,) that a sweep gives each cell of planted data, with no budget."""
    place, supply = xr.DataArray(np.arange(ds.sizes["seed"]), dims="seed"), ds.sizes["seed"]
    given = xr.zeros_like(ds.outcome.isel(seed=0, drop=True), dtype=np.int64) + until.least
    while True:
        excess = until.excess(only(ds, place < given))
        wanting = (excess.fillna(np.inf) > 1.0) & (given < supply)
        if not bool(wanting.any()):
            return np.asarray(given.values)
        given = given + xr.where(wanting, np.minimum(until.batch, supply - given), 0)


def coverage(
    until: Until,
    copies: int = 400,
    supply: int = 200,
    seed: int = 0,
    shares: Sequence[float] = SHARES,
    scatters: Sequence[float] = SCATTER,
) -> list[Covered]:
    """Coverage of the 95 % intervals of stopped cells, for planted blocked shares and scatters of clearance times.

    Parameters
    ----------
    until : its `excess` is replaced by one goal at a time, with the half-widths of `HalfWidths`
    copies : planted cells of each kind
    supply : most seeds of a cell
    seed : of what is planted
    shares, scatters : what is planted
    """
    rng = np.random.default_rng(seed)
    return [_of_share(rng, until, copies, supply, share) for share in shares] + [
        _of_mean(rng, until, copies, supply, scatter) for scatter in scatters
    ]


def _of_share(rng: np.random.Generator, until: Until, copies: int, supply: int, share: float) -> Covered:
    goal = replace(until, excess=HalfWidths(clearance_time=None))
    ds, seeds = _stopped(cells(rng, copies, supply, share, 0.1), goal)
    found = measures.blocked_share(ds)
    return _covered("blocked share", share, seeds, found.blocked_share_low, found.blocked_share_high, share)


def _of_mean(rng: np.random.Generator, until: Until, copies: int, supply: int, scatter: float) -> Covered:
    goal = replace(until, excess=HalfWidths(blocked_share=None))
    ds, seeds = _stopped(cells(rng, copies, supply, 0.0, scatter), goal)
    found = measures.mean_over(measures.clearance(ds).clearance_time)
    return _covered("clearance time", scatter, seeds, found.clearance_time_low, found.clearance_time_high, MEAN)


def _stopped(ds: xr.Dataset, until: Until) -> tuple[xr.Dataset, NDArray[np.int64]]:
    """The runs of planted cells that are made until each has enough, and their numbers."""
    seeds = settled(ds, until)
    given = xr.DataArray(np.arange(ds.sizes["seed"]), dims="seed") < xr.DataArray(seeds, dims="copy")
    return only(ds, given), seeds


def _covered(
    what: str, planted: float, seeds: NDArray[np.int64], low: xr.DataArray, high: xr.DataArray, truth: float
) -> Covered:
    held = int(((low <= truth) & (truth <= high)).sum())
    interval = stats.binomtest(held, seeds.size).proportion_ci(CONFIDENCE, method="wilson")
    return Covered(what, planted, float(seeds.mean()), held / seeds.size, float(interval.low), float(interval.high))
