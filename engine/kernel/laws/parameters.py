"""Meaning, unit and range of a law's parameter, written at its field.

class Exponential(NamedTuple):
    A: Annotated[float, at_least(0.0, "N", "force at contact")]
"""

import functools
import math
from typing import Any, NamedTuple, get_type_hints


class Parameter(NamedTuple):
    """Range, unit and meaning of a parameter."""

    low: float
    high: float
    low_included: bool
    unit: str
    meaning: str

    def __contains__(self, value: object) -> bool:
        """Whether a finite number lies in the range."""
        return isinstance(value, float) and self.low <= value <= self.high and (self.low_included or value > self.low)

    @property
    def requirement(self) -> str:
        """Range in words: "above 0"."""
        if self.high < math.inf:
            return f"from {self.low:g} to {self.high:g}"
        if self.low == -math.inf:
            return "finite"
        return f"of {self.low:g} or more" if self.low_included else f"above {self.low:g}"


def at_least(low: float, unit: str, meaning: str) -> Parameter:
    """A parameter of `low` or more."""
    return Parameter(low, math.inf, True, unit, meaning)


def above(low: float, unit: str, meaning: str) -> Parameter:
    """A parameter above `low`."""
    return Parameter(low, math.inf, False, unit, meaning)


def between(low: float, high: float, unit: str, meaning: str) -> Parameter:
    """A parameter from `low` to `high`, both included."""
    return Parameter(low, high, True, unit, meaning)


ANY = Parameter(-math.inf, math.inf, True, "1", "")  # of a field that is a plain float


@functools.cache
def parameters_of(law: type) -> dict[str, Parameter]:
    """Range, unit and meaning of each parameter of a law."""
    return {name: _parameter(hint) for name, hint in get_type_hints(law, include_extras=True).items()}


def _parameter(hint: Any) -> Parameter:
    return next((known for known in getattr(hint, "__metadata__", ()) if isinstance(known, Parameter)), ANY)
