"""Ctrl-C in two stages: the first lets the runs under way finish, the second stops at once."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def two_stages(active: bool = True) -> Iterator[Callable[[], bool]]:
    """Catch the first Ctrl-C in this block; the second is a KeyboardInterrupt.

    Yields
    ------
    A function that says whether the first one came. Where Ctrl-C is not Python's to handle, or not `active`, it
    always says no.
    """
    ours = threading.current_thread() is threading.main_thread() and callable(signal.getsignal(signal.SIGINT))
    if not (active and ours):
        yield lambda: False
        return
    presses: list[int] = []

    def press(number: int, frame: FrameType | None) -> None:
        presses.append(number)
        if len(presses) > 1:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, press)
    try:
        yield lambda: bool(presses)
    finally:
        signal.signal(signal.SIGINT, before)
