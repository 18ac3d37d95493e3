"""Ctrl-C while compiled code runs: held until it returns.

A KeyboardInterrupt that is pending when numba hands its results back crashes the interpreter.
"""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def interrupts_held() -> Iterator[Callable[[], None]]:
    """Hold SIGINT back in this block.

    Yields
    ------
    A function to call where an interruption is safe: it raises the KeyboardInterrupt that is due, if any.
    """
    if threading.current_thread() is not threading.main_thread() or not callable(signal.getsignal(signal.SIGINT)):
        yield lambda: None  # Python interrupts the main thread only; ignored or foreign handling stays
        return
    due: list[int] = []

    def raise_if_due() -> None:
        if due:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, lambda number, frame: due.append(number))
    try:
        yield raise_if_due
    finally:
        signal.signal(signal.SIGINT, before)
    raise_if_due()
