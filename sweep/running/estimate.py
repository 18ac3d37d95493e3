"""How long runs will take, of how long their like took."""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from sweep.grid import SEED, Cell, Grid, Point, Scalar


class Durations:
    """Mean durations of the cells of a grid; a cell without any takes those of the nearest one.

    Parameters
    ----------
    grid : its axes other than `seed` make the cells; distances are in ranks of their values
    """

    def __init__(self, grid: Grid) -> None:
        self.cell = grid.cell
        self._axes = [name for name in grid.axes if name != SEED]
        self._rank = {name: _ranks(grid.axes[name]) for name in self._axes}
        self._sums: dict[Cell, tuple[float, int]] = {}
        self._nearest: dict[Cell, Cell] = {}

    def note(self, point: Point, duration: float) -> None:
        """Take in how long a run took, s."""
        cell = self.cell(point)
        total, count = self._sums.get(cell, (0.0, 0))
        if not count:
            self._nearest.clear()
        self._sums[cell] = total + duration, count + 1

    def expected(self, point: Point) -> float:
        """How long a run will take, s; nan if none is known."""
        return self._mean(self.cell(point))

    def left(self, waiting: Mapping[Cell, int]) -> float:
        """How long so many runs of these cells will take one after the other, s."""
        return math.fsum(count * self._mean(cell) for cell, count in waiting.items() if count)

    def longest_first(self, points: Iterable[Point]) -> list[int]:
        """The order in which to run points, as indices; that given, where nothing tells."""
        expected = [self.expected(point) for point in points]
        return sorted(range(len(expected)), key=lambda k: -expected[k] if expected[k] > 0.0 else 0.0)

    def _mean(self, cell: Cell) -> float:
        if not self._sums:
            return math.nan
        if cell not in self._sums:
            if cell not in self._nearest:
                self._nearest[cell] = self._closest(cell)
            cell = self._nearest[cell]
        total, count = self._sums[cell]
        return total / count

    def _closest(self, cell: Cell) -> Cell:
        known = list(self._sums)
        distance = np.square(np.array([self._place(other) for other in known]) - self._place(cell)).sum(axis=1)
        return known[int(distance.argmin())]

    def _place(self, cell: Cell) -> np.ndarray:
        return np.array([self._rank[name][value] for name, value in zip(self._axes, cell, strict=True)], float)


def _ranks(values: tuple[Scalar, ...]) -> dict[Scalar, int]:
    return {value: k for k, value in enumerate(sorted(values, key=_order))}


def _order(value: Scalar) -> tuple[str, Scalar]:
    return ("", value) if isinstance(value, int | float) else (str(type(value)), value)
