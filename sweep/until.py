"""Seeds where they are needed: a sweep in rounds that gives more of them to the cells that are least certain."""

import importlib
import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from engine.errors import BadInput, require
from sweep.grid import SEED, Cell, Grid, Point, Scalar
from sweep.report import tell
from sweep.running.completion import Way, complete, opened
from sweep.storage.store import Store

RULES = "studies.until.rules"  # looked up by name at run time, as studies are: nothing here builds on it
Excess = Callable[[xr.Dataset], xr.DataArray]
Refine = Callable[[xr.Dataset], Sequence[Point]]


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


def sweep_until(grid: Grid, store: Store, until: Until | str | Mapping[str, Any], way: Way) -> xr.Dataset:
    """Run as many seeds in each cell of a grid as its interval needs.

    In each round every cell that is not settled gets the next `batch` seeds of the grid's axis `seed`, in their
    order, the least certain cells first where the budget ends. What is decided follows from the seeds decided on
    before and from nothing else: not from what more the store holds, the number of workers, or interruptions.

    Parameters
    ----------
    grid : its axis `seed` is the supply: no cell gets more seeds than it has
    store : of the runs; runs that it holds are not run again
    until, way : as of `sweep.sweep`

    Returns
    -------
    Dataset as `gather` gives it, "missing" where a cell was not given that seed; with `seeds_given` and `excess`
    (axes but seed...), and the attributes `runs_given`; `runs_uniform`, cells times the most seeds of a cell,
    what a grid with as many seeds in all cells takes; and `cells_open`, cells that the budget or the supply left
    short of the goal.

    Raises
    ------
    BadInput
        If the grid has no axis `seed` or too few seeds, the budget does not reach for the first round, or the
        words are none.
    SweepStopped
        See `sweep.sweep`; finished runs are kept, and the same call goes on from there.
    """
    until = rule_of(grid, until)
    store, cells = opened(store), Cells(grid, until.least)
    while True:
        ds = cells.counted(complete(cells.given(), store, way))
        excess = cells.excess(ds, until.excess)
        wanted = cells.wanting(excess, until)
        if not wanted and until.refine is not None:
            cells.add(until.refine(ds), until)
            wanted = {cell: until.least for cell, seeds in cells.seeds.items() if not seeds}
        if not wanted:
            return _accounted(ds, excess, cells)
        cells.give(wanted)
        if way.manner.shown:
            tell(f"{cells.runs} runs: {len(wanted)} of {len(cells.seeds)} cells get more seeds")


def rule_of(grid: Grid, given: Until | str | Mapping[str, Any]) -> Until:
    """The rule for a grid.

    Raises
    ------
    BadInput
        If the words are none, or the grid has too few seeds, or the budget does not reach for the first round.
    """
    until = given if isinstance(given, Until) else _from_words(given)
    require(SEED in grid.axes, "grid", repr(grid), "has no axis seed", "give seed=range(100), the most for any cell")
    seeds = len(grid.axes[SEED])
    least = until.least
    require(seeds >= least, "grid", f"with {seeds} seeds", f"has fewer than until's least, {least}", "give more seeds")
    first = least * (len(grid) // seeds)
    enough = until.budget is None or until.budget >= first
    remedy = "raise the budget, or lower least or the number of cells"
    require(enough, "until: budget", until.budget, f"is below the first round of {first} runs", remedy)
    return until


def first_round(grid: Grid, given: Until | str | Mapping[str, Any]) -> Grid:
    """The runs that are made before anything is decided."""
    return Cells(grid, rule_of(grid, given).least).given()


class Cells:
    """How many seeds each cell of a grid has been given so far.

    Attributes
    ----------
    axes : name -> values, without `seed`
    seeds : cell -> number of seeds; they are the first ones of the supply
    """

    def __init__(self, grid: Grid, least: int) -> None:
        self.grid, self.supply = grid, grid.axes[SEED]
        self.axes: dict[str, tuple[Scalar, ...]] = {n: v for n, v in grid.axes.items() if n != SEED}
        points = grid.over(**{SEED: self.supply[:1]}).points()
        self.seeds: dict[Cell, int] = {grid.cell(point): least for point in points}

    @property
    def runs(self) -> int:
        """Number of runs given."""
        return sum(self.seeds.values())

    def given(self) -> Grid:
        """The grid of all cells, with the seeds that each has been given."""
        whole = self.grid.over(**self.axes, **{SEED: self.supply[: max(self.seeds.values())]})
        return whole.first_seeds(self.seeds)

    def excess(self, ds: xr.Dataset, rule: Excess) -> xr.DataArray:
        """How far each cell is from its goal: infinitely far where nothing is known."""
        found = rule(ds).transpose(*self.axes)
        return found.where(found.notnull(), np.inf)

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
            (plain,) = self.grid.over(**{n: [v] for n, v in point.items()}, **{SEED: self.supply[:1]}).points()
            if room and self.grid.cell(plain) not in self.seeds:
                self.seeds[self.grid.cell(plain)] = 0
                self.axes |= {name: _with(values, plain[name]) for name, values in self.axes.items()}

    def _bare(self) -> int:
        return sum(not seeds for seeds in self.seeds.values())

    def _at(self, values: xr.DataArray, cell: Cell) -> float:
        return float(values.sel(dict(zip(self.axes, cell, strict=True))))

    def counted(self, ds: xr.Dataset) -> xr.Dataset:
        """A dataset with the seeds given to each cell."""
        shape = [ds.sizes[name] for name in self.axes]
        numbers = np.array([self.seeds.get(cell, 0) for cell in itertools.product(*self.axes.values())], np.int64)
        about = {"units": "1", "long_name": "seeds given to the cell"}
        return ds.assign(seeds_given=(list(self.axes), numbers.reshape(shape), about))


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


def _from_words(given: str | Mapping[str, Any]) -> Until:
    """The rule that a table, or words such as "clearance_time=5%, budget=500", describe."""
    known = isinstance(given, str | Mapping)
    require(known, "until", repr(given), "is no rule, table or words", "write 'clearance_time=5%, blocked_share=0.1'")
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
