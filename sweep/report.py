"""What a sweep says while it runs, on stderr."""

import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

SILENCE = 10.0  # s between lines where no bar can be drawn


def tell(line: str) -> None:
    """Say one line."""
    print(line, file=sys.stderr, flush=True)


@contextmanager
def late_word(after: float, line: str, shown: bool = True) -> Iterator[None]:
    """Say a line if the block takes longer than `after` seconds."""
    timer = threading.Timer(after, tell, [line])
    if shown:
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


@contextmanager
def progress(total: int, shown: bool = True) -> Iterator[Callable[[float], None]]:
    """Show how many of `total` runs are over: a bar on a terminal, elsewhere a line now and then.

    Yields
    ------
    A function to call for each run that is over, with the time that the others will take, s, or nan.
    """
    console = Console(stderr=True)
    if not shown:
        yield lambda left: None
    elif console.is_terminal or (console.is_jupyter and find_spec("ipywidgets")):  # rich warns of a bar without
        with _bar(console) as bar:
            task = bar.add_task("runs", total=total, left="")
            yield lambda left: bar.update(task, advance=1, left=_words(left))
    else:
        yield _Lines(total).advance


def _bar(console: Console) -> Progress:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    return Progress(*columns, TextColumn("{task.fields[left]}"), console=console)


class _Lines:
    """Progress as lines of text."""

    def __init__(self, total: int) -> None:
        self.total, self.over = total, 0
        self.said = time.monotonic()

    def advance(self, left: float) -> None:
        self.over += 1
        now = time.monotonic()
        if now - self.said >= SILENCE or self.over == self.total:
            tell(f"{self.over} of {self.total} runs over" + (f", {_words(left)}" if left > 0.0 else ""))
            self.said = now


def _words(left: float) -> str:
    """What to say of the time left; nothing if it is not known."""
    return "" if math.isnan(left) else f"about {_spoken(left)} left"


def _spoken(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"
