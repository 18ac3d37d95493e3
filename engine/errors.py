"""Bad input: one line that names the thing, its value, what is required and the remedy."""

import math
from typing import Any


class BadInput(ValueError):
    """Input that no run can be made of; the message is the line a user reads."""


def require(holds: bool, thing: str, value: object, requirement: str, remedy: str) -> None:
    """Raise `BadInput` unless `holds`.

    Parameters
    ----------
    holds : whether the requirement is met
    thing, value : what was given, as the user knows it
    requirement, remedy : clauses that end the message

    Raises
    ------
    BadInput
        "exit width 0.3 m is narrower than the largest person (0.7 m): widen the exit".
    """
    if not holds:
        raise BadInput(f"{thing} {value} {requirement}: {remedy}")


def number(thing: str, value: Any, remedy: str) -> float:
    """The value as a float.

    Raises
    ------
    BadInput
        If it is not a finite number.
    """
    try:
        good = not isinstance(value, str | bytes) and math.isfinite(value)
    except (TypeError, ValueError, OverflowError):
        good = False
    require(good, thing, value if len(repr(value)) < 80 else "...", "is not a finite number", remedy)
    return float(value)


def finite(thing: str, numbers: Any, count: int) -> tuple[float, ...]:
    """`count` finite numbers as floats.

    Raises
    ------
    BadInput
        If there are more or fewer, or one is not a finite number.
    """
    try:
        values = tuple(float(value) for value in numbers) if not isinstance(numbers, str | bytes) else ()
    except (TypeError, ValueError, OverflowError):
        values = ()
    good = len(values) == count and all(map(math.isfinite, values))
    require(good, thing, numbers, f"is not {count} finite number{'s' * (count > 1)}", "give them in m")
    return values
