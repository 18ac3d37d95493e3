"""Blocked shares of two kinds of runs with the same seeds, which start from the same places and bodies."""

import numpy as np
import xarray as xr
from scipy import stats

from studies.measures.facts import BLOCKED, KNOWN, Over, count, described, dims_over, outcome_is
from studies.measures.uncertainty import check_resampling, wilson


def newcombe(both: int, first: int, second: int, neither: int, confidence: float) -> tuple[float, float, float]:
    """Difference of two paired shares and its limits: method 10 of Newcombe (1998), Stat. Med. 17, 2635.

    Wilson's limits of the two shares, joined with the correlation of the pairs; `first` and `second` are the numbers of
    pairs in which only the first, or only the second, is a hit.
    """
    n = both + first + second + neither
    if n == 0:
        return np.nan, np.nan, np.nan
    p, q = (both + first) / n, (both + second) / n
    (p_low, p_high), (q_low, q_high) = wilson(both + first, n, confidence), wilson(both + second, n, confidence)
    margins = float((both + first) * (second + neither) * (both + second) * (first + neither))
    product = both * neither - first * second
    phi = (max(product - n / 2, 0.0) if product > 0 else float(product)) / np.sqrt(margins) if margins > 0 else 0.0

    def arm(of_p: float, of_q: float) -> float:
        return float(np.sqrt(max(of_p**2 - 2.0 * phi * of_p * of_q + of_q**2, 0.0)))

    return p - q, p - q - arm(p - p_low, q_high - q), p - q + arm(p_high - p, q - q_low)


def paired_blocking(
    ds: xr.Dataset, along: str, first: object, second: object, over: Over = "seed", confidence: float = 0.95
) -> xr.Dataset:
    """Difference of the blocked shares of `first` and `second`, values of the axis `along`, over the same seeds.

    Parameters
    ----------
    ds : gathered dataset
    along : str
        The axis whose two values are compared.
    first, second : values of that axis
    over : str or sequence of str
        Dimensions of the pairs.
    confidence : float

    Returns
    -------
    Dataset with `difference`, `difference_low`, `difference_high` (axes...): share of the first less that of the
    second, with Newcombe's limits; `p_value` of the exact McNemar test that both are the same; `pairs`, those of
    which neither run is missing or unstable; `only_first`, `only_second`: pairs in which only that one blocked.

    Raises
    ------
    ValueError
        If `over` or `along` is not a dimension, one holds the other, a value is not on the axis, or `confidence` not
        within (0, 1).
    """
    dims, _ = dims_over(ds, over), dims_over(ds, along)
    check_resampling(confidence)
    if along in dims:
        raise ValueError(f"over={over!r} holds along={along!r}: name the dimension of the pairs, such as seed")
    for value in (first, second):
        if value not in ds[along].values:
            known = ", ".join(map(str, ds[along].values))
            raise ValueError(f"{along} has no value {value!r} (it has {known}): name one of these")
    stuck, known_runs = outcome_is(ds, *BLOCKED), outcome_is(ds, *KNOWN)
    a, b = (stuck.sel({along: value}, drop=True) for value in (first, second))
    pair = known_runs.sel({along: first}, drop=True) & known_runs.sel({along: second}, drop=True)
    tables = {
        "both": (pair & a & b, "pairs of which both blocked"),
        "only_first": (pair & a & ~b, f"pairs of which only {along} = {first} blocked"),
        "only_second": (pair & ~a & b, f"pairs of which only {along} = {second} blocked"),
        "neither": (pair & ~a & ~b, "pairs of which none blocked"),
    }
    counts = xr.Dataset({name: count(truth, dims, text) for name, (truth, text) in tables.items()})
    limits = xr.apply_ufunc(
        lambda *cell: _limits(cell, confidence),
        *(counts[name] for name in ("both", "only_first", "only_second", "neither")),
        output_core_dims=[[]] * 3,
        vectorize=True,
        output_dtypes=[np.float64] * 3,
    )
    p = xr.apply_ufunc(_mcnemar, counts.only_first, counts.only_second, vectorize=True, output_dtypes=[np.float64])
    names = ("difference", "difference_low", "difference_high")
    text = f"blocked share of {along} = {first} less that of {second}"
    return counts.assign(
        {name: described(values, "1", text) for name, values in zip(names, limits, strict=True)}
    ).assign(
        p_value=described(p, "1", "exact McNemar test of equal shares"),
        pairs=count(pair, dims, "pairs of runs"),
    )


def _limits(cell: tuple[int, ...], confidence: float) -> tuple[float, float, float]:
    both, first, second, neither = map(int, cell)
    return newcombe(both, first, second, neither, confidence)


def _mcnemar(first: int, second: int) -> float:
    return float(stats.binomtest(int(first), int(first + second)).pvalue) if first + second else 1.0
