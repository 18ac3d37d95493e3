"""Bias of statistics between two settings of the numerics that ran the same seeds, with intervals and a verdict."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from studies import measures
from studies.measures.facts import BLOCKED, KNOWN
from studies.measures.uncertainty import resampling_weights, stretched_interval, wilson

CONFIDENCE, RESAMPLES = 0.9, 4000  # two one-sided tests of 5 %
MARGIN = 0.02  # of a ratio; of a share of runs, absolute
LONG_DELAYS = {1.0: MARGIN, 2.0: 0.1}  # s -> margin
FIRST_DELAY, LAST_DELAY = 10, 0.8  # rank of leaving, and share of the crowd: the delays that are counted
SHOWN, NOT_SHOWN, VIOLATED = "shown", "not shown", "violated"
Floats = NDArray[np.float64]


class Bias(NamedTuple):
    """One statistic of a setting against that of the reference."""

    quantity: str
    value: float  # relative bias, or difference of two shares
    low: float
    high: float
    pairs: int  # seeds that both ran
    used: tuple[int, int]  # runs that the statistic rests on: setting, reference
    margin: float = MARGIN  # within which the two count as the same

    @property
    def verdict(self) -> str:
        """Whether a bias within the margin is shown, not shown with so many seeds, or violated."""
        if self.low > self.margin or self.high < -self.margin:
            return VIOLATED
        return SHOWN if self.low >= -self.margin and self.high <= self.margin else NOT_SHOWN


def ratio(
    quantity: str, tested: tuple[Floats, Floats], reference: tuple[Floats, Floats], margin: float = MARGIN
) -> Bias:
    """Relative bias of a mean that is pooled over runs: sum/number, over the same of the reference.

    Seeds are drawn with replacement, both runs of a seed together; arms stretched for few seeds.

    Parameters
    ----------
    tested, reference : sums and numbers of each seed's run (n,); a run that has nothing to average has number 0
    """
    n = tested[0].size
    used = int((tested[1] > 0).sum()), int((reference[1] > 0).sum())
    with np.errstate(invalid="ignore", divide="ignore"):
        value = _mean(np.ones(n), *tested) / _mean(np.ones(n), *reference) - 1.0
        low = high = np.nan
        if min(used) > 1:
            weights = resampling_weights(n, RESAMPLES, 0)
            drawn = _mean(weights, *tested) / _mean(weights, *reference) - 1.0
            if np.isfinite(drawn).all():  # else some draws have nothing to divide by: no interval
                low, high = stretched_interval(float(value), drawn, min(used), CONFIDENCE)
    return Bias(quantity, float(value), low, high, n, used, margin)


def difference(
    quantity: str, tested: NDArray[np.bool_], reference: NDArray[np.bool_], confidence: float = CONFIDENCE
) -> Bias:
    """Difference of two shares over the same seeds, with the interval of Newcombe (1998), Stat. Med. 17, 2635.

    It is made of the shares' Wilson intervals and their correlation, and has a width also where no run or every run
    blocked.
    """
    n = tested.size
    if n == 0:
        return Bias(quantity, np.nan, np.nan, np.nan, 0, (0, 0))
    p, q = float(tested.mean()), float(reference.mean())
    (p_low, p_high), (q_low, q_high) = (wilson(int(hits.sum()), n, confidence) for hits in (tested, reference))
    r = _correlation(tested, reference)
    below = (p - p_low) ** 2 - 2 * r * (p - p_low) * (q_high - q) + (q_high - q) ** 2
    above = (p_high - p) ** 2 - 2 * r * (p_high - p) * (q - q_low) + (q - q_low) ** 2
    return Bias(quantity, p - q, p - q - max(below, 0.0) ** 0.5, p - q + max(above, 0.0) ** 0.5, n, (n, n))


def compare(tested: xr.Dataset, reference: xr.Dataset, ranks: Iterable[int] = ()) -> list[Bias]:
    """All statistics of two gathered datasets (seed, exit), over the seeds that both ran.

    Parameters
    ----------
    ranks : of leaving, whose times are compared beside the clearance time
    """
    tested, reference = _paired(tested, reference)
    found = [ratio("clearance time", _times(tested), _times(reference))]
    found += [ratio(f"time of exit {n}", _times(tested, n), _times(reference, n)) for n in ranks]
    blocked = [measures.outcome_is(ds, *BLOCKED).values for ds in (tested, reference)]
    found.append(difference("blocked share", blocked[0], blocked[1]))
    of, of_reference = _delays(tested), _delays(reference)
    for name, margin in {"mean delay": MARGIN, **{_long(d): m for d, m in LONG_DELAYS.items()}}.items():
        found.append(ratio(name, (of[name], of["number"]), (of_reference[name], of_reference["number"]), margin))
    return found


def _long(delay: float) -> str:
    return f"share of delays above {delay:g} s"


def counts(ds: xr.Dataset) -> str:
    """How the runs of a dataset ended."""
    words = ds.outcome.attrs["flag_meanings"].split()
    numbers = {word: int(measures.outcome_is(ds, word).sum()) for word in words}
    return ", ".join(f"{number} {word.replace('_', ' ')}" for word, number in numbers.items() if number)


def _paired(tested: xr.Dataset, reference: xr.Dataset) -> tuple[xr.Dataset, xr.Dataset]:
    """The same seeds of both, of which neither run is missing or unstable."""
    common = np.intersect1d(tested.seed, reference.seed)
    tested, reference = tested.sel(seed=common), reference.sel(seed=common)
    both = (measures.outcome_is(tested, *KNOWN) & measures.outcome_is(reference, *KNOWN)).values
    return tested.isel(seed=both), reference.isel(seed=both)


def _times(ds: xr.Dataset, rank: int | None = None) -> tuple[Floats, Floats]:
    """Clearance time of each run, or time of a rank, and 1; 0 and 0 where there is none."""
    found = measures.clearance(ds).clearance_time if rank is None else measures.time_of_exit(ds, rank).time_of_exit
    times = found.values.reshape(ds.seed.size)
    known = np.isfinite(times)
    return np.where(known, times, 0.0), known.astype(float)


def _delays(ds: xr.Dataset) -> dict[str, Floats]:
    """Sum of the delays of each run, numbers of long ones, number; open waits are in none."""
    last = int(LAST_DELAY * int(ds.persons.max())) if ds.seed.size else FIRST_DELAY + 1
    d = measures.delays(ds, FIRST_DELAY, max(last, FIRST_DELAY + 1)).delay
    sums = {"mean delay": d.sum("exit"), "number": d.notnull().sum("exit")}
    sums |= {_long(delay): (d > delay).sum("exit") for delay in LONG_DELAYS}
    return {name: values.values.astype(float) for name, values in sums.items()}


def _mean(weights: Floats, sums: Floats, numbers: Floats) -> Floats:
    mean: Floats = (weights @ sums) / (weights @ numbers)
    return mean


def _correlation(tested: NDArray[np.bool_], reference: NDArray[np.bool_]) -> float:
    """Correlation of two outcomes over the same seeds, towards 0 by half a run; 0 where one is constant."""
    n, a, b = tested.size, int(tested.sum()), int(reference.sum())
    scale = (a * (n - a) * b * (n - b)) ** 0.5
    excess = int((tested & reference).sum()) * int((~tested & ~reference).sum())
    excess -= int((tested & ~reference).sum()) * int((~tested & reference).sum())
    return (max(excess - n / 2, 0.0) if excess > 0 else excess) / scale if scale else 0.0
