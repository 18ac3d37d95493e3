"""A grid: axes and constants over the keywords of a room, each point a scenario."""

import copy
import hashlib
import inspect
import itertools
import json
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType, NoneType
from typing import Any, get_args, get_type_hints

import numpy as np

from engine import BadInput, Scenario, with_options
from engine.errors import require
from engine.rooms import ROOMS
from sweep.rooms import Room, room_named

Scalar = bool | int | float | str
Point = dict[str, Scalar]
Cell = tuple[Scalar, ...]

SEED, CHOICE, SEEDS = "seed", "common_random_numbers", "seeds_of_cells"
KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "a word"}


class Grid:
    """Every combination of the axes' values, with the constants held.

    Parameters
    ----------
    room : a function of named parameters -> Scenario, or its name (see `sweep.rooms.room_named`); each has the options
        of runs (`engine.Options`) as keywords besides its own
    common_random_numbers : whether runs of one seed begin with the same random numbers, whatever the values of the
        other axes; if not, every cell draws its own, from the seed and from the parameters that differ from the
        room's defaults, so that a grid that is extended keeps its runs
    keywords : keywords of the room; a list, tuple, range or array is an axis, a number or word a constant

    Attributes
    ----------
    room, name : the function, and its name as datasets have it
    axes : name -> tuple of values, in the order given
    constants : name -> value
    common_random_numbers : as given
    seeds_of_cells : cell (values of the axes but `seed`, in their order) -> number of seeds; None: each has all

    Raises
    ------
    BadInput
        If the room or a keyword is unknown, an axis is empty or repeats a value, or a point is no scenario.
    """

    def __init__(self, room: Room | str, /, *, common_random_numbers: Any = True, **keywords: Any) -> None:
        self._describe(_room(room), _name(room), common_random_numbers, keywords)
        self._try_points()

    def _describe(self, room: Room, name: str, common_random_numbers: Any, keywords: Mapping[str, Any]) -> None:
        self.room, self.name = room, name
        self._known = inspect.signature(room).parameters
        _check_names(self.name, self.room, keywords)
        kinds = {name: plain_kind(hint) for name, hint in get_type_hints(self.room).items()}
        axes = {name: _axis(name, given, kinds.get(name)) for name, given in keywords.items() if _many(given)}
        constants = {n: _scalar(n, given, kinds.get(n)) for n, given in keywords.items() if n not in axes}
        self.axes: Mapping[str, tuple[Scalar, ...]] = MappingProxyType(axes)
        self.constants: Mapping[str, Scalar] = MappingProxyType(constants)
        self.common_random_numbers = _choice(common_random_numbers, self)
        self.seeds_of_cells: Mapping[Cell, int] | None = None

    def over(self, **axes: Any) -> "Grid":
        """The same grid with other values of some axes."""
        other = Grid.__new__(Grid)
        other._describe(self.room, self.name, self.common_random_numbers, {**self.axes, **axes, **self.constants})
        other._try_points()
        return other

    def first_seeds(self, numbers: Mapping[Cell, int]) -> "Grid":
        """The same grid, of which each cell has only the first so many seeds; those not named have none."""
        _check_seeds(self, numbers)
        part = copy.copy(self)
        part.seeds_of_cells = MappingProxyType(dict(numbers))
        return part

    def cell(self, point: Point) -> Cell:
        """What runs that differ only in their seed share: values of the other axes."""
        return tuple(point[name] for name in self.axes if name != SEED)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each axis."""
        return tuple(len(values) for values in self.axes.values())

    def __len__(self) -> int:
        """Number of points."""
        return math.prod(self.shape) if self.seeds_of_cells is None else sum(self.seeds_of_cells.values())

    def __repr__(self) -> str:
        """The room and the size of each axis."""
        sizes = " x ".join(f"{len(values)} {name}" for name, values in self.axes.items()) or "1 run"
        return f"Grid of {self.name}: {sizes}"

    @property
    def defaults(self) -> Point:
        """The room's other parameters, which keep their defaults."""
        given = {**self.axes, **self.constants}
        return {name: p.default for name, p in self._known.items() if name not in given}

    @property
    def seeds_alone(self) -> bool:
        """Whether the seed is known to decide nothing but the random numbers: so it is in the engine's rooms."""
        return self.name in ROOMS and SEED in self._known

    def points(self) -> Iterator[Point]:
        """The axes' values at each point, the last axis fastest."""
        if self.seeds_of_cells is None:
            yield from self.product()
            return
        numbers, rank = self.seeds_of_cells, {seed: k for k, seed in enumerate(self.axes[SEED])}
        yield from (point for point in self.product() if rank[point[SEED]] < numbers.get(self.cell(point), 0))

    def product(self) -> Iterator[Point]:
        """Every combination of the axes' values, also those that are no points since their cell has fewer seeds."""
        for values in itertools.product(*self.axes.values()):
            yield dict(zip(self.axes, values, strict=True))

    def scenario(self, point: Point) -> Scenario:
        """The scenario of a point.

        Raises
        ------
        BadInput
            With the parameters of the point.
        """
        parameters = {**self.constants, **point}
        try:
            scenario = self.room(**parameters | self._own_seed(parameters))
            made = isinstance(scenario, Scenario)
            require(made, "room", self.name, f"returns {type(scenario).__name__}", "return a Scenario")
            return scenario
        except BadInput as error:
            raise BadInput(f"{error} (in {self.name} with {named(parameters)})") from None

    def seed_of(self, point: Point) -> int:
        """The seed that the room is given at a point."""
        parameters = {**self.constants, **point}
        given = parameters | self._own_seed(parameters)
        return int(given.get(SEED, self._known[SEED].default))

    def to_json(self) -> str:
        """Room, axes, constants, the choice of random numbers, and unequal numbers of seeds as JSON."""
        plain: dict[str, Any] = {
            "room": self.name,
            "axes": {name: list(values) for name, values in self.axes.items()},
            "constants": dict(self.constants),
        }
        if not self.common_random_numbers:
            plain[CHOICE] = False
        if self.seeds_of_cells is not None:
            plain[SEEDS] = [[*cell, number] for cell, number in self.seeds_of_cells.items()]
        return json.dumps(plain)

    @staticmethod
    def from_json(text: str) -> "Grid":
        """The grid that `to_json` wrote, if its room is one of `engine.rooms.ROOMS`; its points are not tried again."""
        plain = json.loads(text)
        grid = Grid.__new__(Grid)
        known = plain["room"] in ROOMS  # data must not name code to run
        require(known, "room", repr(plain["room"]), "is not known", "it is a user's own: gather it where it was swept")
        keywords = {**plain["axes"], **plain["constants"]}
        grid._describe(_room(plain["room"]), plain["room"], plain.get(CHOICE, True), keywords)
        return grid.first_seeds({tuple(cell): number for *cell, number in plain[SEEDS]}) if SEEDS in plain else grid

    def _own_seed(self, parameters: Point) -> Point:
        """The seed of a cell that has random numbers of its own; nothing where they are common."""
        if self.common_random_numbers:
            return {}
        known = self._known
        number = parameters.get(SEED, known[SEED].default)
        require(number >= 0, SEED, number, "is not a whole number of 0 or more", "number the runs 0, 1, 2 ...")
        differing = {n: v for n, v in parameters.items() if n != SEED and v != known[n].default}
        exact = {n: v.hex() if isinstance(v, float) else v for n, v in differing.items()}
        digest = hashlib.sha256(json.dumps([self.name, exact], sort_keys=True).encode()).digest()
        cell = np.frombuffer(digest, "<u4").tolist()
        return {SEED: int(np.random.SeedSequence(number, spawn_key=cell).generate_state(1, np.uint64)[0] >> 1)}

    def _try_points(self) -> None:
        """Refuse a grid of which a point is no scenario."""
        for point in self._telling():
            self.scenario(point)

    def _telling(self) -> Iterator[Point]:
        """Points of which all are scenarios if these are."""
        if not (self.seeds_alone and SEED in self.axes):
            yield from self.points()
            return
        first = {name: values[0] for name, values in self.axes.items()}
        yield from ({**first, SEED: seed} for seed in self.axes[SEED])
        others = {name: values if name != SEED else values[:1] for name, values in self.axes.items()}
        yield from (dict(zip(others, values, strict=True)) for values in itertools.product(*others.values()))


def named(parameters: Mapping[str, Scalar]) -> str:
    """Parameters as a user reads them: "v_d = 1.0, N = 200"."""
    return ", ".join(f"{name} = {value}" for name, value in parameters.items()) or "all defaults"


def _choice(common: Any, grid: Grid) -> bool:
    require(type(common) is bool, CHOICE, repr(common), "is not true or false", "give one of them")
    seeded = common or SEED in inspect.signature(grid.room).parameters
    require(seeded, "room", grid.name, f"has no keyword {SEED}", f"let it have one, or leave {CHOICE} true")
    return bool(common)


def _room(room: Room | str) -> Room:
    if isinstance(room, str):
        return room_named(room)
    require(inspect.isfunction(room), "room", repr(room), "is not a function", "give one that returns a Scenario")
    return with_options(room)


def _name(room: Room | str) -> str:
    if isinstance(room, str):
        return room
    own = f"{room.__module__}:{room.__qualname__}"
    return next((name for name, function in ROOMS.items() if function is room), own)


def _check_names(room: str, function: Room, keywords: Mapping[str, Any]) -> None:
    parameters = inspect.signature(function).parameters
    for name in keywords:
        remedy = f"choose from {', '.join(parameters)}"
        require(name in parameters, "axis or constant", repr(name), f"is not a keyword of {room}", remedy)
    for name, parameter in parameters.items():
        given = name in keywords or parameter.default is not parameter.empty
        require(given, "keyword", repr(name), f"of {room} has no default", "give it a value or an axis")


def _check_seeds(grid: Grid, numbers: Mapping[Cell, int]) -> None:
    known = [set(values) for name, values in grid.axes.items() if name != SEED]
    most = len(grid.axes.get(SEED, ()))
    require(len(numbers) > 0, "cells", "{}", "are none", "name one")
    for cell, number in numbers.items():
        held = len(cell) == len(known) and all(value in values for value, values in zip(cell, known, strict=True))
        require(held, "cell", cell, "is none of the grid", "name a value of each axis but seed")
        whole = type(number) is int and 0 <= number <= most
        require(whole, f"seeds of cell {cell}", repr(number), f"is not a whole number from 0 to {most}", "give one")


def _many(given: Any) -> bool:
    return isinstance(given, Iterable) and not isinstance(given, str) and getattr(given, "ndim", 1) > 0


def plain_kind(hint: Any) -> Any:
    """The kind of value of a keyword that may also be left to follow from others: float of `float | None`."""
    kinds = [kind for kind in get_args(hint) if kind is not NoneType]
    return kinds[0] if len(kinds) == 1 else hint


def _axis(name: str, given: Any, kind: type | None) -> tuple[Scalar, ...]:
    ordered = not isinstance(given, set | frozenset | Mapping)
    require(ordered, f"axis {name}", given, "has no order", "give a list, a range or an array")
    values = tuple(_scalar(name, value, kind) for value in given)
    require(
        len(values) > 0,
        f"axis {name}",
        "without values",
        "makes a grid of zero runs",
        "give at least one value",
    )
    repeated = [value for value, times in Counter(values).items() if times > 1]
    require(not repeated, f"axis {name}", f"with {repeated[:1]} twice", "repeats a value", "name each value once")
    return values


def _scalar(name: str, given: Any, kind: type | None) -> Scalar:
    value = given.item() if isinstance(given, np.generic | np.ndarray) and given.ndim == 0 else given
    if kind is float and type(value) is int:
        return float(value)  # 1 and 1.0 are the same run
    fits = type(value) is kind if kind in KINDS else type(value) in KINDS
    wanted = KINDS.get(kind, "a number, a word or true or false") if kind else "a number or a word"
    require(fits, name, repr(given), f"is not {wanted}", "give a value of that kind")
    return value
