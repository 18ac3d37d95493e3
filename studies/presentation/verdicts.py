"""What a study says in the end: published beside found, line by line."""

from collections.abc import Iterable, Sequence
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
    return columns(rows)


def columns(rows: Sequence[Sequence[str]]) -> str:
    """Rows of cells as aligned text, the first one the head."""
    widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def interval(mean: float, low: float, high: float, digits: int = 0) -> str:
    """A mean with its interval, as "211 [203, 219]"."""
    return f"{mean:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"
