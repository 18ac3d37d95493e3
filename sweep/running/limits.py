"""What one run may take: time and memory."""

import math
import re
from typing import NamedTuple

from engine.errors import require

UNITS = {"": 1, "B": 1, "KB": 1e3, "MB": 1e6, "GB": 1e9, "KIB": 2**10, "MIB": 2**20, "GIB": 2**30}  # bytes


class Limits(NamedTuple):
    """What one run may take before its worker is ended."""

    timeout: float = math.inf  # s
    memory: float = math.inf  # bytes, resident, of the worker as a whole

    @property
    def given(self) -> bool:
        """Whether there is any."""
        return min(self) < math.inf


def limits_of(timeout: float | None, memory_limit: float | str | None) -> Limits:
    """Checked limits; None is none.

    Raises
    ------
    BadInput
        If one is not above 0 or no number.
    """
    return Limits(_seconds(timeout), _bytes(memory_limit))


def megabytes(size: float) -> str:
    """A size in bytes as a user reads it."""
    return f"{size / 1e6:.0f} MB"


def _seconds(given: float | None) -> float:
    if given is None:
        return math.inf
    positive = isinstance(given, int | float) and not isinstance(given, bool) and given > 0
    require(positive, "timeout", repr(given), "is not a time above 0", "give seconds")
    return float(given)


def _bytes(given: float | str | None) -> float:
    if given is None:
        return math.inf
    parts = re.fullmatch(r"\s*([0-9.]+(?:[eE][0-9]+)?)\s*([A-Za-z]*)\s*", str(given))
    scale = UNITS.get(parts[2].upper()) if parts else None
    try:
        size = float(parts[1]) * scale if parts and scale and not isinstance(given, bool) else 0.0
    except ValueError:  # 1.2.3
        size = 0.0
    require(size > 0.0, "memory_limit", repr(given), "is not an amount of memory", 'give bytes, or "500 MB", "2 GB"')
    return size
