"""What ties a worker process to its parent: it ends with it, leaves Ctrl-C to it, and can say where it is."""

import ctypes
import faulthandler
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker

PINNED = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "BLIS_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
        "NUMBA_NUM_THREADS",
    ),
    "1",
)  # environment of a worker: as many threads as workers, so that jobs = cores fills the machine once
ASK = signal.SIGUSR1  # a worker answers with its stack, also from compiled code
LOOK = 1.0  # s between two looks whether the parent is still there
PR_SET_PDEATHSIG = 1  # linux/prctl.h


def attach(parent: int, log: str) -> None:
    """Set a new worker process up.

    Parameters
    ----------
    parent : its process id
    log : file that the stack of a crash, or of a process that is asked, is written to
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_with(parent)
    with suppress(OSError):  # the file is for the first worker of an executor; a later one does without
        stream = os.open(log, os.O_WRONLY | os.O_APPEND)
        faulthandler.enable(stream, all_threads=False)
        faulthandler.register(ASK, stream, all_threads=False)


def end_with(parent: int) -> None:
    """End this process when its parent is gone, however it went.

    On Linux the kernel sees to it at once. Elsewhere a thread looks every second; a compiled loop lets it, since it
    returns to Python every few tenths of a second.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(LOOK)
    os._exit(1)


@contextmanager
def ctrl_c_left_alone() -> Iterator[None]:
    """Have processes that are started here ignore Ctrl-C from their first instruction: masks are inherited."""
    resource_tracker.ensure_running()  # which would lift the mask if it were started with the first worker
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
