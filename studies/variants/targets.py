"""The published numbers, each with its tolerance, as terms of one score."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.special import betaln

from studies.published import lin2016 as paper
from studies.variants.sweeps import Cell

Floats = NDArray[np.float64]
Facts = Mapping[str, Floats]  # name of a fact -> (variants, seeds) of one cell
Sample = Mapping[Cell, Facts]

SHARE = 0.10  # tolerance of a clearance time or mean flow: the text rounds to 10 s of 120 and gives single runs
SHARE_OF_RANGE = 0.20  # tolerance of the ends of a range of flows, share of its upper end: extremes of few runs
MOST = 25.0  # a statement missed by five tolerances or more, or by no run getting out, is missed: none decides alone
SHOWN = 5  # runs behind a published "blocked" or "not blocked": the paper says several and gives no number
JEFFREYS = 0.5
FITTED, HELD_OUT = "fitted", "held out"


class Target(NamedTuple):
    """A published statement: `term` is what it adds to the score of each variant, 0 where it is met exactly."""

    group: str  # FITTED or HELD_OUT
    figure: str
    statement: str
    tolerance: str
    found: Callable[[Sample], Floats]  # (variants,), what the statement speaks of
    term: Callable[[Sample], Floats]  # (variants,)
    digits: int = 0


def mean_out(values: Floats) -> Floats:
    """Mean of the finite values along the last axis, NaN where there is none."""
    finite = np.isfinite(values)
    number = finite.sum(axis=-1)
    total = np.where(finite, values, 0.0).sum(axis=-1)
    return np.asarray(np.divide(total, number, out=np.full(number.shape, np.nan), where=number > 0))


def deviation(found: Floats, published: float, tolerance: float) -> Floats:
    """((found - published)/tolerance)^2, at most MOST, which it is where nothing was found."""
    squared = ((found - published) / tolerance) ** 2
    return np.asarray(np.where(np.isfinite(found), np.minimum(squared, MOST), MOST))


def predictive(hits: Floats, runs: Floats, shown: int = SHOWN) -> Floats:
    """-2 ln P(all of `shown` further runs are hits | hits of runs), with Jeffreys' prior for the share.

    The beta-binomial predictive: runs that agree a few times over do not prove a share of 1, and a single
    contrary run does not make the published statement impossible.
    """
    a, b = hits + JEFFREYS, runs - hits + JEFFREYS
    return np.asarray(-2.0 * (betaln(a + shown, b) - betaln(a, b)))


def more_often(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> Floats:
    """-2 ln P(share of the first > share of the second), each share with Jeffreys' posterior; pairs (hits, runs)."""
    pairs = zip(*first, *second, strict=True)
    return np.array([-2.0 * np.log(_probably_more(*map(int, numbers))) for numbers in pairs])


@lru_cache(maxsize=4096)  # resamples of ten runs meet the same few numbers again and again
def _probably_more(hits: int, runs: int, other_hits: int, other_runs: int) -> float:
    middles = (np.arange(200) + 0.5) / 200.0
    of_first = stats.beta.ppf(middles, hits + JEFFREYS, runs - hits + JEFFREYS)
    return float(stats.beta.cdf(of_first, other_hits + JEFFREYS, other_runs - other_hits + JEFFREYS).mean())


def counts(sample: Sample, *cells: Cell, hit: str = "blocked") -> tuple[Floats, Floats]:
    """Blocked (or `hit`="free": not blocked) runs and runs of some cells together: (variants,) each."""
    runs = np.sum([sample[cell]["known"].sum(axis=-1) for cell in cells], axis=0)
    blocked = np.sum([sample[cell]["blocked"].sum(axis=-1) for cell in cells], axis=0)
    return (blocked if hit == "blocked" else runs - blocked), runs


def share(hits: Floats, runs: Floats) -> Floats:
    """hits/runs, NaN without runs."""
    return np.asarray(np.divide(hits, runs, out=np.full(np.shape(runs), np.nan), where=runs > 0))


def _clearance(group: str, figure: str, published: float, *cells: Cell) -> Target:
    def found(sample: Sample) -> Floats:
        return mean_out(np.stack([mean_out(sample[cell]["clearance_time"]) for cell in cells], axis=-1))

    names = str(cells[0]) if len(cells) == 1 else f"N={cells[0].N} v_d={cells[0].v_d:g}-{cells[-1].v_d:g}"
    text = f"clearance time, {names}: {published:.0f} s"
    return Target(
        group, figure, text, f"{SHARE:.0%}", found, lambda s: deviation(found(s), published, SHARE * published)
    )


def _all_alike(figure: str, cell: Cell, hit: str) -> Target:
    """Every run of a cell is blocked, or, with `hit`="free", none."""
    words, share_blocked = ("every run blocked", 1) if hit == "blocked" else ("no run blocked", 0)
    return Target(
        FITTED,
        figure,
        f"{words}, {cell}: {share_blocked}",
        f"{SHOWN} runs",
        lambda s: share(*counts(s, cell)),
        lambda s: predictive(*counts(s, cell, hit=hit)),
        2,
    )


def _rotation_same(without: Cell, with_it: Cell) -> Target:
    def found(sample: Sample) -> Floats:
        return mean_out(sample[without]["clearance_time"]) / mean_out(sample[with_it]["clearance_time"])

    text = "rotation off at 1 m/s, clearance time without / with: 1"
    return Target(HELD_OUT, "5", text, f"{SHARE:.0%}", found, lambda s: deviation(found(s), 1.0, SHARE), 2)


def _rotation_clogs(without: Cell, with_it: Cell) -> Target:
    def found(sample: Sample) -> Floats:
        return share(*counts(sample, without)) - share(*counts(sample, with_it))

    text = "rotation off at 2 m/s, blocked share without - with: > 0"
    term = lambda s: more_often(counts(s, without), counts(s, with_it))  # noqa: E731  a field, as its neighbours
    return Target(HELD_OUT, "5", text, "likelihood", found, term, 2)


def _end_of_range(figure: str, published: float, tolerance: float, name: str, cell: Cell) -> Target:
    word = {"least": "least", "most": "greatest"}[name]

    def found(sample: Sample) -> Floats:
        return mean_out(sample[cell][name])

    text = f"{word} flow in 10 s, {cell}: {published} /s"
    return Target(
        HELD_OUT, figure, text, f"{tolerance:.2f} /s", found, lambda s: deviation(found(s), published, tolerance), 2
    )


def flows(sample: Sample, cells: tuple[Cell, ...]) -> Floats:
    """Mean flow N/T of each run that got out: (variants, cells seeds), NaN for the others."""
    return np.concatenate([cell.N / sample[cell]["clearance_time"] for cell in cells], axis=-1)


def _flow(text: str, published: float, of: Callable[[Floats], Floats], cells: tuple[Cell, ...]) -> Target:
    def found(sample: Sample) -> Floats:
        return of(flows(sample, cells))

    text = f"{text}: {published} /s"
    return Target(
        HELD_OUT, "10", text, f"{SHARE:.0%}", found, lambda s: deviation(found(s), published, SHARE * published), 2
    )


def quantile_out(q: float) -> Callable[[Floats], Floats]:
    """The q-quantile of the finite values along the last axis, NaN where there is none (linear, as numpy)."""

    def of(values: Floats) -> Floats:
        number = np.isfinite(values).sum(axis=-1)
        ordered = np.sort(values, axis=-1)  # NaN last
        place = q * np.maximum(number - 1, 0)
        low = np.floor(place).astype(int)
        high = np.minimum(low + 1, np.maximum(number - 1, 0))
        a, b = (np.take_along_axis(ordered, k[..., None], axis=-1)[..., 0] for k in (low, high))
        return np.asarray(a + (place - low) * (b - a))

    return of


def _many(N: int, *v_d: float) -> tuple[Cell, ...]:
    return tuple(Cell(N, v) for v in v_d)


TRANSITION = (*_many(200, 1.0, 1.2, 1.4, 1.6), *_many(100, 1.0, 1.6))
SEPARATION = (Cell(200, 1.8), Cell(100, 2.0))
STILL_1, STILL_2 = Cell(100, 1.0, rotation=False), Cell(100, 2.0, rotation=False)


def _fig9() -> list[Target]:
    cells = {0.6: paper.FIG9_FLOW[(0.6, 0.6)], 1.0: paper.FIG9_FLOW[(1.0, 1.2)], 1.6: paper.FIG9_FLOW[(1.6, np.inf)]}
    return [
        _end_of_range("9", end, SHARE_OF_RANGE * ends[1], name, Cell(100, v_d))
        for v_d, ends in cells.items()
        for name, end in zip(("least", "most"), ends, strict=True)
    ]


TARGETS: tuple[Target, ...] = (
    *(_clearance(FITTED, "7", time, Cell(200, v_d)) for v_d, time in paper.FIG7_CLEARANCE_TIME.items()),
    _clearance(FITTED, "7", paper.FIG7_PLATEAU_CLEARANCE_TIME, *_many(200, 1.2, 1.4, 1.6)),
    *(
        _clearance(FITTED, "4", time, Cell(paper.FIG4_N, paper.FIG4_V_D, A))
        for A, time in paper.FIG4_CLEARANCE_TIME.items()
    ),
    *(_all_alike("7", cell, "free") for cell in _many(200, 0.6, 1.0, 1.2, 1.4)),
    _all_alike("7", Cell(200, paper.FIG7_BLOCKED_FROM), "blocked"),
    _rotation_same(STILL_1, Cell(100, 1.0)),
    _rotation_clogs(STILL_2, Cell(100, 2.0)),
    *_fig9(),
    _flow("mean flow 1.0-1.6 m/s", paper.TRANSITION_MEAN_FLOW, mean_out, TRANSITION),
    _flow("mean flow 1.0-1.6 m/s, 5 %", paper.TRANSITION_FLOW[0], quantile_out(0.05), TRANSITION),
    _flow("mean flow 1.0-1.6 m/s, 95 %", paper.TRANSITION_FLOW[1], quantile_out(0.95), TRANSITION),
    _flow("greatest mean flow above 1.6 m/s", paper.PHASE_SEPARATION_FLOW[1], quantile_out(1.0), SEPARATION),
)
