"""What a study says in the end: published beside found, line by line."""

from collections.abc import Iterable
from typing import NamedTuple

MARKS = {True: "yes", False: "NO", None: "open"}


class Verdict(NamedTuple):
    """One published statement and what came of it."""

    statement: str
    published: str
    found: str
    holds: bool | None  # None: the runs at hand cannot tell


def table(verdicts: Iterable[Verdict]) -> str:
    """The verdicts as aligned text."""
    rows = [("statement", "published", "found", "holds")]
    rows += [(v.statement, v.published, v.found, MARKS[v.holds]) for v in verdicts]
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def interval(mean: float, low: float, high: float, digits: int = 0) -> str:
    """A mean with its interval, as "211 [203, 219]"."""
    return f"{mean:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"
