"""A grid: axes and constants over the keywords of a room, each point a scenario."""

import inspect
import itertools
import json
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType, NoneType
from typing import Any, get_args, get_type_hints

import numpy as np

from engine import BadInput, Scenario
from engine.errors import require
from engine.rooms import ROOMS

Scalar = bool | int | float | str
Point = dict[str, Scalar]
Room = Callable[..., Scenario]

KINDS = {float: "a number", int: "a whole number", bool: "true or false", str: "a word"}


class Grid:
    """Every combination of the axes' values, with the constants held.

    Parameters
    ----------
    room : a function of named parameters -> Scenario, or its name in `engine.rooms.ROOMS`
    keywords : keywords of the room; a list, tuple, range or array is an axis, a number or word a constant

    Attributes
    ----------
    room, name : the function, and its name as datasets have it
    axes : name -> tuple of values, in the order given
    constants : name -> value

    Raises
    ------
    BadInput
        If the room or a keyword is unknown, an axis is empty or repeats a value, or a point is no scenario.
    """

    def __init__(self, room: Room | str, /, **keywords: Any) -> None:
        self.room = _room(room)
        self.name = _name(self.room)
        _check_names(self.name, self.room, keywords)
        kinds = {name: plain_kind(hint) for name, hint in get_type_hints(self.room).items()}
        axes = {name: _axis(name, given, kinds.get(name)) for name, given in keywords.items() if _many(given)}
        constants = {n: _scalar(n, given, kinds.get(n)) for n, given in keywords.items() if n not in axes}
        self.axes: Mapping[str, tuple[Scalar, ...]] = MappingProxyType(axes)
        self.constants: Mapping[str, Scalar] = MappingProxyType(constants)
        for point in self.points():
            self.scenario(point)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each axis."""
        return tuple(len(values) for values in self.axes.values())

    def __len__(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def __repr__(self) -> str:
        """The room and the size of each axis."""
        sizes = " x ".join(f"{len(values)} {name}" for name, values in self.axes.items()) or "1 run"
        return f"Grid of {self.name}: {sizes}"

    @property
    def defaults(self) -> Point:
        """The room's other parameters, which keep their defaults."""
        given = {**self.axes, **self.constants}
        parameters = inspect.signature(self.room).parameters
        return {name: p.default for name, p in parameters.items() if name not in given}

    def points(self) -> Iterator[Point]:
        """The axes' values at each point, the last axis fastest."""
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
            scenario = self.room(**parameters)
            made = isinstance(scenario, Scenario)
            require(made, "room", self.name, f"returns {type(scenario).__name__}", "return a Scenario")
            return scenario
        except BadInput as error:
            raise BadInput(f"{error} (in {self.name} with {named(parameters)})") from None

    def to_json(self) -> str:
        """Room, axes and constants as JSON."""
        axes = {name: list(values) for name, values in self.axes.items()}
        return json.dumps({"room": self.name, "axes": axes, "constants": dict(self.constants)})

    @staticmethod
    def from_json(text: str) -> "Grid":
        """The grid that `to_json` wrote, if its room is one of `engine.rooms.ROOMS`."""
        plain = json.loads(text)
        return Grid(plain["room"], **plain["axes"], **plain["constants"])


def named(parameters: Mapping[str, Scalar]) -> str:
    """Parameters as a user reads them: "v_d = 1.0, N = 200"."""
    return ", ".join(f"{name} = {value}" for name, value in parameters.items()) or "all defaults"


def _room(room: Room | str) -> Room:
    if isinstance(room, str):
        remedy = f"choose one of {', '.join(ROOMS)}, or give Grid the function itself"
        require(room in ROOMS, "room", repr(room), "is not known", remedy)
        return ROOMS[room]
    require(inspect.isfunction(room), "room", repr(room), "is not a function", "give one that returns a Scenario")
    return room


def _name(room: Room) -> str:
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
