"""A grid described in a TOML file.

room = "lin_room"
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
"""

import math
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from engine import BadInput
from engine.errors import require
from sweep.grid import CHOICE, Grid
from sweep.storage.serving import ON_CODE_CHANGE, RERUN

PARTS = ("room", "store", "on_code_change", CHOICE, "axes", "constants", "until")
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
        If the file cannot be read, is no TOML, lacks the room or the store, or describes no valid grid.
    """
    parts = _parsed(path)
    for name in parts:
        require(name in PARTS, f"{path}: entry", repr(name), "is not known", f"keep to {', '.join(PARTS)}")
    for name in ("room", "store"):
        given = isinstance(parts.get(name), str)
        require(
            given,
            f"{path}: {name}",
            repr(parts.get(name)),
            "is not a name",
            f'write {name} = "..." at the top',
        )
    axes = {name: _axis(name, given) for name, given in _table(parts, "axes").items()}
    constants = {name: _constant(name, given) for name, given in _table(parts, "constants").items()}
    for name in axes:
        require(name not in constants, "keyword", repr(name), "is both axis and constant", "remove one of them")
    choice = parts.get("on_code_change", RERUN)
    remedy = f"choose one of {', '.join(ON_CODE_CHANGE)}"
    require(choice in ON_CODE_CHANGE, f"{path}: on_code_change", repr(choice), "is not known", remedy)
    common = {CHOICE: parts[CHOICE]} if CHOICE in parts else {}
    return GridFile(Grid(parts["room"], **common, **axes, **constants), parts["store"], choice)


def read_until(path: Path) -> dict[str, Any] | None:
    """The table [until] of a file, as it stands there; None if it has none.

    Raises
    ------
    BadInput
        If the file cannot be read or is no TOML, or `until` is no table.
    """
    parts = _parsed(path)
    return _table(parts, "until") if "until" in parts else None


def _parsed(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        why = (error.strerror or "refused").lower()
        raise BadInput(f"grid file '{path}' cannot be read ({why}): name a TOML file") from None
    except ValueError as error:  # of TOML or of UTF-8
        raise BadInput(f"grid file '{path}' is no valid TOML ({error}): mend it") from None


def _table(parts: dict[str, Any], name: str) -> dict[str, Any]:
    table = parts.get(name, {})
    require(isinstance(table, dict), name, repr(table), "is not a table", f"write [{name}] and the entries below")
    return table


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
    values = first + step * np.arange(int(count))
    return (values if whole else np.round(values, 12)).tolist()  # 1.0, not 1.0000000000000002


def _constant(name: str, given: Any) -> Any:
    single = not isinstance(given, list | dict)
    require(single, f"constant {name}", given, "is not a single value", "move it to [axes]")
    return given
