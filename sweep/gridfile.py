"""A grid described in a TOML file.

room = "lin_room"             # or "my_rooms.py:my_room"
store = "results/mine"
on_code_change = "rerun"      # may be left out
common_random_numbers = true  # the same

[axes]
v_d = [0.6, 1.0]
seed = { first = 0, last = 9, step = 1 }

[constants]
N = 200

[until]  # if given: seeds where they are needed, out of those of the axis, see `sweep.until`
clearance_time = 0.05
blocked_share = 0.1

[running]  # how runs are run, where the command line says nothing else; any entry may be left out
jobs = 4
backend = "loky"
scheduler = "tcp://head:8786"
timeout = 600
memory_limit = "2 GB"
fail_fast = false
"""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from engine import BadInput
from engine.errors import require
from sweep.grid import CHOICE, Grid
from sweep.rooms import room_named
from sweep.running.backends import BACKENDS
from sweep.running.limits import limits_of
from sweep.storage.serving import ON_CODE_CHANGE, RERUN
from sweep.tomlfile import Key, TomlFile

PARTS = ("room", "store", "on_code_change", CHOICE, "axes", "constants", "until", "running")
SPAN = ("first", "last", "step")
MOST_VALUES = 100_000


class GridFile(NamedTuple):
    """What a file describes."""

    grid: Grid
    store: str  # its path
    on_code_change: str = RERUN


def read_gridfile(path: Path) -> GridFile:
    """The grid, the path of the store, and the choices that a file describes.

    Raises
    ------
    BadInput
        If the file cannot be read, is no TOML, lacks the room or the store, or describes no valid grid; with the line.
    """
    file = _opened(path)
    for name in ("room", "store"):
        given = file.entries.get(name)
        remedy = f'write {name} = "..." at the top'
        require(isinstance(given, str), f"{file.at(name)}: {name}", repr(given), "is not a name", remedy)
    axes = _each(file, "axes", _axis)
    constants = _each(file, "constants", _constant)
    for name in axes:
        with file.blamed("constants", name):
            require(name not in constants, "keyword", repr(name), "is both axis and constant", "remove one of them")
    choice = file.entries.get("on_code_change", RERUN)
    with file.blamed("on_code_change"):
        remedy = f"choose one of {', '.join(ON_CODE_CHANGE)}"
        require(choice in ON_CODE_CHANGE, "on_code_change", repr(choice), "is not known", remedy)
    return GridFile(_grid(file, axes, constants), file.entries["store"], choice)


def read_until(path: Path) -> dict[str, Any] | None:
    """The table [until] of a file, as it stands there; None if it has none.

    Raises
    ------
    BadInput
        If the file cannot be read or is no TOML, or `until` is no table.
    """
    file = _opened(path)
    return _table(file, "until") if "until" in file.entries else None


def read_running(path: Path) -> dict[str, Any]:
    """The table [running] of a file: keywords of `sweep.sweep`; those that are left out are not there.

    Raises
    ------
    BadInput
        If the file cannot be read or is no TOML, or an entry is not known or not of its kind; with the line.
    """
    file = _opened(path)
    for name in _table(file, "running"):
        with file.blamed("running", name):
            require(name in RUNNING, "running: entry", repr(name), "is not known", f"keep to {', '.join(RUNNING)}")
    return _each(file, "running", lambda name, given: RUNNING[name](name, given))


def where(path: Path, *key: str) -> str:
    """Where in a file an entry, or else its table, stands, as "grid.toml:7"."""
    return _opened(path).at(*key)


def _opened(path: Path) -> TomlFile:
    file = TomlFile(path, "grid file", "name a TOML file; `jamsweep init` writes one")
    for name in file.entries:
        with file.blamed(name):
            require(name in PARTS, "entry", repr(name), "is not known", f"keep to {', '.join(PARTS)}")
    return file


def _table(file: TomlFile, name: str) -> dict[str, Any]:
    table = file.entries.get(name, {})
    with file.blamed(name):
        require(isinstance(table, dict), name, repr(table), "is not a table", f"write [{name}] and the entries below")
    return dict(table)


def _each(file: TomlFile, table: str, read: Callable[[str, Any], Any]) -> dict[str, Any]:
    found = {}
    for name, given in _table(file, table).items():
        with file.blamed(table, name):
            found[name] = read(name, given)
    return found


def _grid(file: TomlFile, axes: Mapping[str, Any], constants: Mapping[str, Any]) -> Grid:
    """The grid of a file; what is wrong is said of the entry that it goes with."""
    room = file.entries["room"]
    with file.blamed("room"):
        room_named(room)
    given: dict[Key, Any] = {("axes", name): value for name, value in axes.items()}
    given |= {("constants", name): value for name, value in constants.items()}
    if CHOICE in file.entries:
        given[CHOICE,] = file.entries[CHOICE]
    try:
        return _made(room, given)
    except BadInput as error:
        raise BadInput(f"{file.at(*_wrong(room, given))}: {error}") from None


def _made(room: str, given: Mapping[Key, Any]) -> Grid:
    return Grid(room, **{key[-1]: value for key, value in given.items()})


def _wrong(room: str, given: Mapping[Key, Any]) -> Key:
    """The first entry without which the grid is right, or else something else is wrong with it; () for none."""
    without = {key: _complaint(room, {k: v for k, v in given.items() if k != key}) for key in given}
    right = (key for key, complaint in without.items() if not complaint)
    said = _complaint(room, given)
    return next(right, next((key for key, complaint in without.items() if complaint != said), ()))


def _complaint(room: str, given: Mapping[Key, Any]) -> str:
    """What is wrong with a grid, without the parameters that this is said of; "" if nothing is."""
    try:
        _made(room, given)
    except BadInput as error:
        return str(error).partition(" (in ")[0]
    return ""


def _jobs(name: str, given: Any) -> int:
    require(type(given) is int and given > 0, name, repr(given), "is not a whole number above 0", "give one")
    return int(given)


def _backend(name: str, given: Any) -> str:
    require(given in BACKENDS, name, repr(given), "is not known", f"choose one of {', '.join(BACKENDS)}")
    return str(given)


def _address(name: str, given: Any) -> str:
    require(isinstance(given, str), name, repr(given), "is not an address", 'write it as "tcp://head:8786"')
    return str(given)


def _timeout(name: str, given: Any) -> float:
    return limits_of(given, None).timeout


def _memory(name: str, given: Any) -> Any:
    limits_of(None, given)
    return given


def _switch(name: str, given: Any) -> bool:
    require(type(given) is bool, name, repr(given), "is not true or false", "give one of them")
    return bool(given)


RUNNING: dict[str, Callable[[str, Any], Any]] = {
    "jobs": _jobs,
    "backend": _backend,
    "scheduler": _address,
    "timeout": _timeout,
    "memory_limit": _memory,
    "fail_fast": _switch,
}


def _axis(name: str, given: Any) -> list[Any]:
    if isinstance(given, dict):
        return _span(name, given)
    remedy = "give [a, b, ...] or { first = , last = , step = }, or move it to [constants]"
    require(isinstance(given, list), f"axis {name}", repr(given), "is not a list", remedy)
    return given


def _span(name: str, given: dict[str, Any]) -> list[Any]:
    """Values from first to last, both included."""
    whole = all(type(given.get(part)) is int for part in SPAN)
    numbers = whole or all(type(given.get(part)) in (int, float) for part in SPAN)
    complete = set(given) == set(SPAN) and numbers and all(map(math.isfinite, given.values())) and given["step"] > 0
    remedy = "give { first = , last = , step = }, with a step above 0"
    require(complete, f"axis {name}", given, "is not a span", remedy)
    first, last, step = (given[part] for part in SPAN)
    count = (last - first) / step + 1.0 + 1e-9
    fits = 1.0 <= count <= MOST_VALUES
    zero = "makes a grid of zero runs" if count < 1.0 else f"has more than {MOST_VALUES} values"
    require(fits, f"axis {name}", given, zero, "give a last that is not below first and not too far")
    if whole:
        return list(range(first, last + 1, step))
    return np.round(first + step * np.arange(int(count)), 12).tolist()  # 1.0, not 1.0000000000000002


def _constant(name: str, given: Any) -> Any:
    single = not isinstance(given, list | dict)
    require(single, f"constant {name}", given, "is not a single value", "move it to [axes]")
    return given
