"""Physics that is not there."""

from typing import NamedTuple


class Absent(NamedTuple):
    """Physics that is not there; it costs nothing."""
