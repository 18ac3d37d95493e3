"""The two boundaries of a column over v_d: step fit to blocked runs, broken-stick fit to mean flows."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.special import xlogy

from studies.measures.uncertainty import Floats, bootstrap_interval, resampling_weights

Ints = NDArray[np.int64]

DECISIONS = {
    "decided": "the boundary lies in the scanned range",
    "below_range": "the boundary lies below the lowest v_d scanned",
    "above_range": "the boundary lies above the highest v_d scanned",
    "too_few_runs": "cells have fewer runs than Rules.least_runs: add seeds",
    "too_few_cells": "fewer v_d than Rules.least_cells take part in the fit: refine or widen the grid of v_d",
    "interval_too_wide": "the interval is wider than Rules.widest of the scanned range: add seeds",
    "no_rise": "the mean flow does not rise with v_d beyond its scatter: scan lower v_d",
    "no_plateau": "the mean flow still rises, or too few cells say that it does not: add v_d or seeds",
}
LINE, EITHER = (1.0,), (1.0, 2.0)  # powers of the rise: a line, or the better of line and parabola
PARABOLA_GAIN = 2.0  # chi-squared; a parabola that fits better by less is not preferred to the line
BEND_PLACES = 101  # places tried for the bend: steps of 1 % of the range
PRIOR_FREEDOM = 4.0  # weight of the pooled variance beside a cell's own, in degrees of freedom
LEAST_VARIANCE = 1e-12  # 1/s^2: keeps the weight of runs that are all equal finite


class Rules(NamedTuple):
    """Thresholds of `states`; none is from a paper."""

    established: float = 0.3  # blocked share from phase separation on: at least this
    stray: float = 0.01  # blocked share below it: at most this
    least_runs: int = 5  # of a cell that takes part
    least_cells: int = 4  # of a fit
    widest: float = 0.5  # interval of a boundary, share of the scanned range
    confidence: float = 0.95
    resamples: int = 2000
    seed: int = 0

    @property
    def beyond(self) -> float:
        """Probability beyond each end of an interval."""
        return (1.0 - self.confidence) / 2.0


class Boundary(NamedTuple):
    """A boundary between states, its interval, and what was decided of it (a key of DECISIONS)."""

    at: float  # m/s; NaN unless decided; -inf or inf beyond the scanned range
    low: float  # m/s
    high: float  # m/s
    decision: str


def undecided(decision: str) -> Boundary:
    """No boundary, for the reason given."""
    return Boundary(np.nan, np.nan, np.nan, decision)


def judged(found: Boundary, scanned: Floats, rules: Rules) -> Boundary:
    """The boundary, unless its interval covers too much of the scanned range (cells,) m/s."""
    width = min(found.high, scanned[-1]) - max(found.low, scanned[0])
    if width > rules.widest * (scanned[-1] - scanned[0]) + 1e-9:
        return found._replace(at=np.nan, decision="interval_too_wide")
    return found


def step_weights(runs: Ints, blocked: Ints, rules: Rules) -> Floats:
    """Likelihood that phase separation begins before cell 0, 1, ... or after the last: (cells + 1,), sum 1.

    Each cell's blocked share is free, except that below the step it is at most `stray` and from the step on
    at least `established`; each takes its most likely value within that bound.
    """
    share = blocked / runs

    def log_likelihood(p: Floats) -> Floats:
        return np.asarray(xlogy(blocked, p) + xlogy(runs - blocked, 1.0 - p))

    below = log_likelihood(np.minimum(share, rules.stray)).cumsum()
    above = log_likelihood(np.maximum(share, rules.established))[::-1].cumsum()[::-1]
    fit = np.append(0.0, below) + np.append(above, 0.0)
    weights = np.exp(fit - fit.max())
    return np.asarray(weights / weights.sum())


def phase_separation(v_d: Floats, runs: Ints, blocked: Ints, rules: Rules) -> Boundary:
    """Where blocking is established: a step fit over all cells.

    A grid tells of a step no more than the two cells it lies between: the boundary is the middle of the likeliest
    gap. Its interval is made of whole gaps, that one and all which the likelihood ratio does not rule out, in a
    second fit with shares up to `established` below the step. For where blocking sets in gradually, cells have
    shares between `stray` and `established`; the first fit takes them for blocking at any number of runs, and an
    interval of its own misses the cell at which the share passes `established` more often than not. No bootstrap:
    cells without a blocked run have none in any resample, and so would claim that none of 10 runs proves a share
    of 0.

    Parameters
    ----------
    v_d : (cells,) float, m/s, ascending
    runs, blocked : (cells,) int
    """
    edges = np.concatenate([[-np.inf], v_d, [np.inf]])
    best = int(step_weights(runs, blocked, rules).argmax())
    lenient = step_weights(runs, blocked, rules._replace(stray=rules.established))
    likely = np.flatnonzero(lenient >= lenient.max() * np.exp(-stats.chi2.ppf(rules.confidence, 1) / 2.0))
    first, last = min(best, likely[0]), max(best, likely[-1])
    where = {0: "below_range", v_d.size: "above_range"}.get(best, "decided")
    middle = (edges[best] + edges[best + 1]) / 2.0
    return judged(Boundary(float(middle), float(edges[first]), float(edges[last + 1]), where), v_d, rules)


def centred(x: Floats, weight: Floats) -> Floats:
    """Rows (rows, cells) less their weighted means."""
    return np.asarray(x - (x @ weight / weight.sum())[:, None])


def bends(v_d: Floats, flow: Floats, weight: Floats, powers: tuple[float, ...]) -> tuple[Floats, Floats]:
    """Weighted least-squares bend of a broken stick: flow rises up to the bend, then stays or falls.

    flow = c - a max(b - v_d, 0)^q - s max(v_d - b, 0), with a, s >= 0 and q among `powers`. A fall is allowed
    (faster is slower), for a plateau held level through falling flows would place the bend too low.

    Parameters
    ----------
    v_d : (cells,) float, m/s, ascending
    flow : (columns, cells) float, 1/s
    weight : (cells,) float, 1/variance of the flows

    Returns
    -------
    bend b (columns,) m/s, from the second cell to the last; and the fall in chi-squared that the rise brings
    (columns,)
    """
    place = np.linspace(v_d[1], v_d[-1], BEND_PLACES)
    ahead = np.maximum(place[:, None] - v_d, 0.0)
    rise = centred(-np.concatenate([ahead**q for q in powers]), weight)
    fall = centred(-np.tile(np.maximum(v_d - place[:, None], 0.0), (len(powers), 1)), weight)
    weighted = centred(flow, weight) * weight
    yr, yf = weighted @ rise.T, weighted @ fall.T
    rr, ff, rf = rise**2 @ weight, fall**2 @ weight, (rise * fall) @ weight
    falls = ff > 1e-9 * ff.max()
    ff = np.where(falls, ff, 1.0)
    determinant = np.where(falls, rr * ff - rf**2, 1.0)
    a, s = (ff * yr - rf * yf) / determinant, (rr * yf - rf * yr) / determinant
    rise_alone, fall_alone = (
        np.maximum(yr, 0.0) ** 2 / rr,
        np.where(falls, np.maximum(yf, 0.0) ** 2 / ff, 0.0),
    )
    gain = np.where(falls & (a > 0) & (s > 0), a * yr + s * yf, rise_alone)
    best = gain.argmax(axis=1)
    row = np.arange(best.size)
    return np.tile(place, len(powers))[best], (gain - fall_alone)[row, best]


def cell_weights(flow: Floats) -> Floats:
    """1/se^2 of mean flows, (cells, runs) -> (cells,); a variance from few runs leans on the pooled one."""
    free = np.isfinite(flow).sum(axis=1) - 1
    variance = np.nanvar(flow, axis=1, ddof=1)
    pooled = (free * variance).sum() / free.sum()
    leaning = (PRIOR_FREEDOM * pooled + free * variance) / (PRIOR_FREEDOM + free)
    return np.asarray((free + 1) / np.maximum(leaning, LEAST_VARIANCE))


def resampled_means(flow: Floats, rules: Rules) -> Floats:
    """Mean flows of resampled runs, drawn within each cell: (cells, runs) -> (resamples, cells)."""
    means = []
    for cell, values in enumerate(flow):
        finite = values[np.isfinite(values)]
        weights = resampling_weights(finite.size, rules.resamples, rules.seed + cell)
        means.append(weights @ finite / finite.size)
    return np.stack(means, axis=1)


def still_rises(v_d: Floats, mean: Floats, weight: Floats, bend: float, rules: Rules) -> bool:
    """Whether the flow rises beyond its scatter over the cells from the bend on, or over the last two."""
    last = max(2, int((v_d >= bend).sum()))
    w = weight[-last:]
    v = v_d[-last:] - np.average(v_d[-last:], weights=w)
    slope_over_error = (mean[-last:] * w) @ v / np.sqrt(w @ v**2)
    return bool(slope_over_error > stats.norm.isf(rules.beyond))


def transition(v_d: Floats, flow: Floats, scanned: Floats, rules: Rules) -> Boundary:
    """Where the mean flow ceases to rise: a broken-stick fit to the cells below phase separation.

    The rise is a line that meets the plateau at an angle, or a parabola that meets it smoothly when that fits
    better by PARABOLA_GAIN. Runs are resampled within cells. The interval reaches from the lowest bend of
    lines to the highest of whichever fits better, so that it holds what the shape leaves open, and one step
    of the places tried; its percentiles are the expanded ones of `uncertainty.tail`. A plateau is supported
    when lines end below the last cell and the flow does not rise beyond its scatter after the bend.

    Parameters
    ----------
    v_d : (cells,) float, m/s, ascending
    flow : (cells, runs) float, 1/s; NaN where a run has none
    scanned : (all cells,) float, m/s
    """
    if v_d.size < rules.least_cells:
        return undecided("too_few_cells")
    mean, weight = np.nanmean(flow, axis=1), cell_weights(flow)
    (line, line_gain), (other, gain) = (bends(v_d, mean[None], weight, q) for q in (LINE, EITHER))
    if gain[0] < stats.chi2.ppf(rules.confidence, 3):  # what a rise, its place and its power gain by chance
        return undecided("no_rise")
    at = float((other if gain[0] > line_gain[0] + PARABOLA_GAIN else line)[0])
    resampled, fewest = resampled_means(flow, rules), int(np.isfinite(flow).sum(axis=1).min())
    low, line_high = bootstrap_interval(bends(v_d, resampled, weight, LINE)[0], fewest, rules.confidence)
    _, high = bootstrap_interval(bends(v_d, resampled, weight, EITHER)[0], fewest, rules.confidence)
    step = (v_d[-1] - v_d[1]) / (BEND_PLACES - 1)
    low = v_d[0] if low <= v_d[1] else low - step  # one cell on the rise: the bend may lie anywhere after it
    found = Boundary(at, float(low), float(max(high, line_high) + step), "decided")
    if max(line_high, at) >= v_d[-1] or still_rises(v_d, mean, weight, at, rules):
        return found._replace(at=np.nan, decision="no_plateau")
    return judged(found, scanned, rules)
