"""What a report calls axes, values and outcomes."""

import re
from collections.abc import Sequence
from typing import Any

from sweep.pages.cells import Cell, Value
from sweep.schema import PARAMETERS

WORDS = {
    "all_out": "all out",
    "blocked": "blocked",
    "frozen": "frozen",
    "time_limit": "time limit",
    "unstable": "unstable",
    "missing": "missing",
}


def labelled(name: str) -> str:
    """An axis with its units."""
    units, _ = PARAMETERS.get(name, ("1", ""))
    return name if units == "1" else f"{name}, {spoken_units(units)}"


def spoken_units(units: str) -> str:
    """Units as a reader has them: "m s-1" is "m/s", "kg m-1 s-1" is "kg/(m s)"."""
    parts = [re.fullmatch(r"([A-Za-z]+)(-?\d*)", part) for part in units.split()]
    if not all(parts):
        return units
    found = [(part[1], int(part[2] or 1)) for part in parts if part]
    over, under = (
        [f"{name}{abs(power) if abs(power) > 1 else ''}" for name, power in found if (power > 0) == above]
        for above in (True, False)
    )
    below = f"({' '.join(under)})" if len(under) > 1 else "".join(under)
    return f"{' '.join(over) or '1'}/{below}" if under else " ".join(over)


def named(values: Sequence[Value | None]) -> list[str]:
    """Values as texts; none as an empty one."""
    return ["" if value is None else short(value) for value in values]


def short(value: Any) -> str:
    """A value as text, numbers to six digits."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def counted(cell: Cell) -> str:
    """How many runs of a cell ended how: "7 all out, 3 blocked"."""
    return ", ".join(f"{cell.counts[word]} {name}" for word, name in WORDS.items() if cell.counts[word])
