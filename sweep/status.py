"""How far the grid of a store is: what is done, what is not, and why."""

import math
from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from sweep.grid import SEED, Grid, Point, Scalar, named
from sweep.storage.keys import Wanted, keys_of
from sweep.storage.manifest import Entry
from sweep.storage.serving import RERUN, Serving, serving
from sweep.storage.store import CORRUPT, Store, sizes_in

DONE = "done"
REASONS = {  # state -> why a run of it is not done; the first that holds is given
    "stale": "done by another state of the engine",
    "corrupt": "its file is not of the size that was written",
    "unlisted": "its file is not in the manifest: `jamsweep verify --repair` enters it if it is whole",
    "set aside": "its damaged file was set aside",
    "failed": "it failed before",
    "lost": "it was done, and its file is gone",
    "missing": "it was never run",
}
STATES = (DONE, *REASONS)


class Run(NamedTuple):
    """A run that a grid asks for."""

    key: str
    point: Point
    state: str


class Status(NamedTuple):
    """The distinct runs of a grid.

    Attributes
    ----------
    runs : each once, in the order of the grid
    seconds : CPU time that those not done will take, of how long their like took; nan if nothing tells
    """

    runs: list[Run]
    seconds: float

    def counts(self) -> dict[str, int]:
        """Number of runs in each state."""
        found = Counter(run.state for run in self.runs)
        return {state: found[state] for state in STATES}

    def __str__(self) -> str:
        """One line: how many runs there are, are done, and are to do."""
        total, done = len(self.runs), self.counts()[DONE]
        words = f"{total} run{'s' * (total != 1)}: {done} done, {total - done} to do"
        return words if done < total else f"{words}; nothing to run"

    def more(self) -> Iterator[str]:
        """Lines with the states of those to do, where they are not just missing, and with the CPU time left."""
        waiting = {state: n for state, n in self.counts().items() if n and state != DONE}
        if waiting.keys() - {"missing"}:
            yield ", ".join(f"{n} {state}" for state, n in waiting.items())
        if waiting and not math.isnan(self.seconds):
            yield f"about {spoken(self.seconds)} of CPU time left"

    def why(self) -> Iterator[str]:
        """A line for each reason, with the runs that it holds for, cell by cell."""
        for state, reason in REASONS.items():
            runs = [run for run in self.runs if run.state == state]
            if runs:
                yield f"{state}: {reason} ({len(runs)})"
                yield from (f"  {line}" for line in _cells(runs))


def status_of(grid: Grid, store: Store, on_code_change: str = RERUN) -> Status:
    """What a sweep would find done and to do; opens no run file."""
    wanted = keys_of(grid, store)
    points = {w.key: (point, w) for w, point in zip(wanted, grid.points(), strict=True)}
    states = _States(store)  # first: what a sweep finishes meanwhile is then served, and not taken for corrupt
    served = serving(wanted, store, on_code_change)
    runs = [Run(key, point, states.of(w, served)) for key, (point, w) in points.items()]
    return Status(runs, _left(runs, served))


class _States:
    def __init__(self, store: Store) -> None:
        self._files, self._failed = sizes_in(store.runs), sizes_in(store.failed)
        self._listed = store.vouched.read().entries

    def of(self, run: Wanted, served: Serving) -> str:
        file = f"{run.key}.nc"
        states = {
            DONE: run.key in served.entries,
            "stale": run.key in served.stale,
            "corrupt": file in self._files and run.key in self._listed,
            "unlisted": file in self._files,
            "set aside": file + CORRUPT in self._files,
            "failed": f"{run.key}.txt" in self._failed,
            "lost": run.key in self._listed,
        }
        return next((state for state, holds in states.items() if holds), "missing")


def _left(runs: list[Run], served: Serving) -> float:
    """Expected duration of what is not done: that of the stale run, or the mean of its cell, or of all, s."""
    cells: dict[tuple[Scalar, ...], list[float]] = {}
    for run in runs:
        if run.key in served.entries and served.entries[run.key].duration > 0:
            cells.setdefault(_cell(run.point), []).append(served.entries[run.key].duration)
    means = {cell: float(np.mean(durations)) for cell, durations in cells.items()}
    overall = float(np.mean(list(means.values()))) if means else math.nan
    waiting = [run for run in runs if run.state != DONE]
    return math.fsum(_expected(served.stale.get(run.key), means.get(_cell(run.point), overall)) for run in waiting)


def _expected(stale: Entry | None, mean: float) -> float:
    return stale.duration if stale and stale.duration > 0 else mean


def _cell(point: Point) -> tuple[Scalar, ...]:
    return tuple(value for name, value in point.items() if name != SEED)


def _cells(runs: list[Run]) -> Iterator[str]:
    """Runs that differ in their seed alone on one line."""
    cells: dict[tuple[Scalar, ...], list[Run]] = {}
    for run in runs:
        cells.setdefault(_cell(run.point), []).append(run)
    for together in cells.values():
        rest = named({name: value for name, value in together[0].point.items() if name != SEED})
        seeds = [str(run.point[SEED]) for run in together if SEED in run.point]
        yield f"{rest}, {SEED} = {', '.join(seeds)}" if seeds else rest


def spoken(seconds: float) -> str:
    """A duration as people say it."""
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * length:
            return f"{seconds / length:.1f} {unit}"
    return f"{seconds:.1f} s"
