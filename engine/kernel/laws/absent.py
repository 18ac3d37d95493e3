"""Physics that is not there."""

from typing import NamedTuple

from engine.kernel.dispatch import type_constant


class Absent(NamedTuple):
    """Physics that is not there; it costs nothing."""


@type_constant
def is_present(parameters: type) -> bool:
    """Whether there is such physics."""
    return parameters is not Absent
