"""Work that goes wrong in the ways in which workers die; run in place of `sweep.running.worker.work`."""

import ctypes
import os
import signal
import time
from pathlib import Path

import numba
import numpy as np

from engine import Scenario
from sweep.running import worker
from sweep.running.worker import Result


def killed(scenario: Scenario, store: str, key: str) -> Result:
    """Always killed."""
    os.kill(os.getpid(), signal.SIGKILL)
    return worker.work(scenario, store, key)


def killed_once(scenario: Scenario, store: str, key: str) -> Result:
    """Killed in the first attempt."""
    mark = Path(store) / f"{key}.tried"
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return worker.work(scenario, store, key)


def killed_after_keeping(scenario: Scenario, store: str, key: str) -> Result:
    """Killed when the run is kept, before it is reported; a second attempt is noted."""
    with (Path(store) / "attempts").open("a") as attempts:
        attempts.write("x")
    worker.work(scenario, store, key)
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


def killed_at_seed_one(scenario: Scenario, store: str, key: str) -> Result:
    """Killed in every attempt at the runs of seed 1."""
    return (killed if scenario.seed == 1 else worker.work)(scenario, store, key)


def segfault(scenario: Scenario, store: str, key: str) -> Result:
    """Reads where nothing is."""
    ctypes.string_at(0)
    raise AssertionError


def hog(scenario: Scenario, store: str, key: str) -> Result:
    """Takes a gigabyte and stays."""
    taken = np.ones(2**27)
    time.sleep(60.0)
    return worker.Failed(key, "not ended", str(taken.sum()))


def hang(scenario: Scenario, store: str, key: str) -> Result:
    """A compiled loop without end, which holds Python's lock."""
    return worker.Failed(key, "not ended", str(_endless(0)))


@numba.njit
def _endless(k: int) -> int:
    while k >= 0:
        k = (k + 1) % 1000
    return k
