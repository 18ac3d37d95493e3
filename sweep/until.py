"""Seeds where they are needed: a sweep in rounds that gives more of them to the cells that are least certain."""

import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from engine import Scenario
from engine.errors import BadInput, require
from sweep.gathering import gather
from sweep.grid import Grid, Point, Scalar, named
from sweep.report import tell
from sweep.runner import sweep
from sweep.schema import GATHERED
from sweep.storage.store import Store

SEED = "seed"
RULES = "studies.until.rules"  # looked up by name at run time, as studies are: nothing here builds on it
Excess = Callable[[xr.Dataset], xr.DataArray]
Refine = Callable[[xr.Dataset], Sequence[Point]]
Cell = tuple[Scalar, ...]  # values of the axes but `seed`


@dataclass(frozen=True)
class Until:
    """When a cell has seeds enough, and how many are added at a time.

    Parameters
    ----------
    excess : dataset -> half-width of each cell's interval over the wanted one, (axes but seed...) float. A cell
        is settled where it is 1 or less; nan means that nothing is known, which is less certain than all else.
        The dataset has the outcome "missing" where a cell has no such seed.
    least : seeds of every cell before anything is decided. An interval from few runs is at times narrow by
        chance, and a sweep that stops just then reports it: `make study-until` measures what that costs.
    batch : seeds that a cell gets at a time
    budget : number of runs, over all cells, that is not exceeded; None: as many as the grid has
    refine : dataset -> cells to be added, as values of the axes but `seed`; asked once no cell wants seeds

    Raises
    ------
    BadInput
        If a number is out of its range.
    """

    excess: Excess
    least: int = 10
    batch: int = 10
    budget: int | None = None
    refine: Refine | None = None

    def __post_init__(self) -> None:
        for name, value, low in (("least", self.least, 2), ("batch", self.batch, 1), ("budget", self.budget, 1)):
            whole = (type(value) is int and value >= low) or (name == "budget" and value is None)
            require(whole, f"until: {name}", repr(value), f"is not a whole number of {low} or more", "give one")


def sweep_until(
    grid: Grid,
    store: Path | str | Store,
    until: Until | str | Mapping[str, Any],
    jobs: int = 2,
    progress: bool = True,
    **manner: Any,
) -> xr.Dataset:
    """Run as many seeds in each cell of a grid as its interval needs.

    In each round every cell that is not settled gets the next `batch` seeds of the grid's axis `seed`, in their
    order, the least certain cells first where the budget ends. What is decided follows from the seeds decided on
    before and from nothing else: not from what more the store holds, the number of workers, or interruptions.

    Parameters
    ----------
    grid : its axis `seed` is the supply: no cell gets more seeds than it has
    store : folder of the runs; runs that it holds are not run again
    until : a rule; or its goals as a table or in words, "clearance_time=5%, blocked_share=0.1, budget=2000", see
        `studies.until.rules.until_of`
    jobs, progress, manner : as of `sweep`

    Returns
    -------
    Dataset as `gather` gives it, "missing" where a cell was not given that seed; with `seeds_given` and `excess`
    (axes but seed...), and the attributes `runs_given`; `runs_uniform`, cells times the most seeds of a cell,
    what a grid with as many seeds in all cells takes; and `cells_open`, cells that the budget or the supply left
    short of the goal. `dataset.nc` holds what the store has of the same grid.

    Raises
    ------
    BadInput
        If the grid has no axis `seed` or too few seeds, the budget does not reach for the first round, or the
        words are none.
    SweepStopped
        See `sweep`; finished runs are kept, and the same call goes on from there.
    """
    until = until if isinstance(until, Until) else _from_words(until)
    _check(grid, until)
    store, cells = Store(store), Cells(grid, until.least)
    try:
        while True:
            ds, excess = cells.run(store, until.excess, jobs=jobs, progress=progress, **manner)
            wanted = cells.wanting(excess, until)
            if not wanted and until.refine is not None:
                cells.add(until.refine(ds), until)
                wanted = {cell: until.least for cell, seeds in cells.seeds.items() if not seeds}
            if not wanted:
                return _accounted(ds, excess, cells)
            cells.give(wanted)
            if progress:
                tell(f"{cells.runs} runs: {len(wanted)} of {len(cells.seeds)} cells get more seeds")
    finally:
        store.make()
        store.note_grid(cells.whole().to_json())


class Cells:
    """How many seeds each cell of a grid has been given so far.

    Attributes
    ----------
    axes : name -> values, without `seed`
    seeds : cell -> number of seeds; they are the first ones of the supply
    done : the same when runs were last made
    """

    def __init__(self, grid: Grid, least: int) -> None:
        self.grid, self.supply = grid, grid.axes[SEED]
        self.axes: dict[str, tuple[Scalar, ...]] = {n: v for n, v in grid.axes.items() if n != SEED}
        points = Grid(grid.room, **{**grid.axes, SEED: self.supply[:1]}, **grid.constants).points()
        self.seeds: dict[Cell, int] = {self._cell(point): least for point in points}
        self.done: dict[Cell, int] = dict.fromkeys(self.seeds, 0)

    @property
    def runs(self) -> int:
        """Number of runs given."""
        return sum(self.seeds.values())

    def whole(self) -> Grid:
        """The grid of all cells with the most seeds that any has."""
        seeds = self.supply[: max(self.seeds.values())]
        axes = {name: seeds if name == SEED else self.axes[name] for name in self.grid.axes}
        return Grid(self.grid.room, **axes, **self.grid.constants)

    def run(self, store: Store, excess: Excess, **manner: Any) -> tuple[xr.Dataset, xr.DataArray]:
        """Run what was given last; the dataset of all that is given and nothing else, and the excess of its cells."""
        if self.done != self.seeds:
            sweep(self._rows(), store, **manner)
        self.done = dict(self.seeds)
        ds = gather(self.whole(), store)
        given = self._number_given(ds)
        ds = only(ds, xr.DataArray(np.arange(ds.sizes[SEED]), dims=SEED) < given)
        found = excess(ds).transpose(*self.axes)
        return ds.assign(seeds_given=given), found.where(found.notnull(), np.inf)

    def wanting(self, excess: xr.DataArray, until: Until) -> dict[Cell, int]:
        """The cells short of the goal that supply and budget reach, the least certain first, and how many seeds."""
        by_cell = {cell: self._at(excess, cell) for cell, seeds in self.seeds.items() if seeds}
        left = len(self.supply) * len(self.seeds) if until.budget is None else until.budget - self.runs
        wanted: dict[Cell, int] = {}
        for cell in sorted(by_cell, key=lambda c: -by_cell[c]):  # stable: the grid's order among equals
            number = min(until.batch, len(self.supply) - self.seeds[cell], left)
            if by_cell[cell] > 1.0 and number > 0:
                wanted[cell], left = number, left - number
        return wanted

    def give(self, wanted: Mapping[Cell, int]) -> None:
        """Give more seeds."""
        for cell, number in wanted.items():
            self.seeds[cell] += number

    def add(self, points: Sequence[Point], until: Until) -> None:
        """Add cells, as far as the budget reaches for their first seeds; all others of their rows get none."""
        for point in points:
            require(set(point) == set(self.axes), "refined cell", point, "does not name each axis", "name them all")
            room = until.budget is None or self.runs + self._bare() * until.least + until.least <= until.budget
            if room and self._cell(point) not in self.seeds:
                self.seeds[self._cell(point)] = 0
                self.axes |= {name: _with(self.axes[name], value) for name, value in point.items()}

    def _bare(self) -> int:
        return sum(not seeds for seeds in self.seeds.values())

    def _rows(self) -> Grid:
        """Each new run as one value of one axis: cells with unequal numbers of seeds are no product of axes."""
        points = [
            dict(zip(self.axes, cell, strict=True)) | {SEED: seed}
            for cell, number in self.seeds.items()
            for seed in self.supply[self.done.get(cell, 0) : number]
        ]
        by_words = {named(point): point for point in points}
        grid = self.grid

        def one_of_unequal_cells(run: str) -> Scenario:
            return grid.scenario(by_words[run])

        return Grid(one_of_unequal_cells, run=list(by_words))

    def _cell(self, point: Point) -> Cell:
        return tuple(point[name] for name in self.axes)

    def _at(self, values: xr.DataArray, cell: Cell) -> float:
        return float(values.sel(dict(zip(self.axes, cell, strict=True))))

    def _number_given(self, ds: xr.Dataset) -> xr.DataArray:
        coords = {name: ds[name] for name in self.axes}
        shape = [ds.sizes[name] for name in self.axes]
        given = xr.DataArray(np.zeros(shape, dtype=np.int64), coords, list(self.axes))
        for cell, number in self.seeds.items():
            given.loc[dict(zip(self.axes, cell, strict=True))] = number
        return given.assign_attrs(units="1", long_name="seeds given to the cell")


def only(ds: xr.Dataset, given: xr.DataArray) -> xr.Dataset:
    """The dataset as if the store held only the runs that are `given` (axes...) bool."""
    pads = {v.name: np.dtype(v.dtype).type(v.pad) for v in GATHERED if v.name in ds}
    return ds.assign({name: ds[name].where(given, pad).transpose(*ds[name].dims) for name, pad in pads.items()})


def account(ds: xr.Dataset) -> str:
    """What a sweep of unequal seeds took, beside a uniform one, in a sentence."""
    runs, uniform, cells = (int(ds.attrs[name]) for name in ("runs_given", "runs_uniform", "cells_open"))
    given = ds.seeds_given.values[ds.seeds_given.values > 0]
    left = f"; {cells} cells are short of the goal" if cells else ""
    return (
        f"{runs} runs, {given.min()} to {given.max()} seeds a cell; {given.max()} seeds in each of {given.size} cells"
        f" are {uniform} runs: {runs / uniform:.0%} of them were needed{left}"
    )


def _accounted(ds: xr.Dataset, excess: xr.DataArray, cells: Cells) -> xr.Dataset:
    held = ds.seeds_given > 0
    excess = excess.where(held).assign_attrs(units="1", long_name="half-width of the interval over the wanted one")
    uniform = int(held.sum()) * max(cells.seeds.values())
    still = int((excess > 1.0).sum())
    return ds.assign(excess=excess).assign_attrs(runs_given=cells.runs, runs_uniform=uniform, cells_open=still)


def _with(values: tuple[Scalar, ...], value: Scalar) -> tuple[Scalar, ...]:
    """The values of an axis and one more, in ascending order if they were."""
    if value in values:
        return values
    numbers = [v for v in (*values, value) if isinstance(v, int | float)]
    ascending = len(numbers) > len(values) and numbers[:-1] == sorted(numbers[:-1])
    return tuple(sorted(numbers)) if ascending else (*values, value)


def _check(grid: Grid, until: Until) -> None:
    require(SEED in grid.axes, "grid", repr(grid), "has no axis seed", "give seed=range(100), the most for any cell")
    seeds = len(grid.axes[SEED])
    least = until.least
    require(seeds >= least, "grid", f"with {seeds} seeds", f"has fewer than until's least, {least}", "give more seeds")
    first = least * (len(grid) // seeds)
    enough = until.budget is None or until.budget >= first
    remedy = "raise the budget, or lower least or the number of cells"
    require(enough, "until: budget", until.budget, f"is below the first round of {first} runs", remedy)


def _from_words(given: str | Mapping[str, Any]) -> Until:
    """The rule that a table, or words such as "clearance_time=5%, budget=500", describe."""
    table = _table(given) if isinstance(given, str) else given
    made: Until = importlib.import_module(RULES).until_of(table)
    return made


def _table(words: str) -> dict[str, Any]:
    table: dict[str, Any] = {}
    for entry in words.split(","):
        name, equals, value = (part.strip() for part in entry.partition("="))
        good = bool(name and equals) and name not in table
        require(good, "until", repr(words), "is not understood", "write clearance_time=5%, blocked_share=0.1")
        table[name] = _plain(name, value)
    return table


def _plain(name: str, value: str) -> int | float:
    share = value.endswith("%")
    try:
        return float(value[:-1]) / 100.0 if share else int(value) if value.isdigit() else float(value)
    except ValueError:
        raise BadInput(f"until: {name} {value!r} is not a number: write 0.05 or 5%") from None
