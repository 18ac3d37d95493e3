"""What a worker does: one run, from its scenario to its file."""

import signal
import time
import traceback
from dataclasses import dataclass

from engine import Scenario, simulate
from sweep.schema import run_key
from sweep.store import Store


@dataclass(frozen=True)
class Done:
    """A run that was kept."""

    key: str
    outcome: str
    duration: float  # s


@dataclass(frozen=True)
class Failed:
    """A run that raised an error."""

    key: str
    error: str  # one line
    traceback: str


@dataclass(frozen=True)
class Outdated:
    """A run that was not begun: the engine here is another than the one that asked for it."""

    key: str


Result = Done | Failed | Outdated


def work(scenario: Scenario, store: str, key: str) -> Result:
    """Simulate a scenario and keep the run.

    Parameters
    ----------
    scenario : what to run
    store : path of the store
    key : what the parent finds the run by

    Returns
    -------
    Done, Failed or Outdated
        No exception leaves, except an interruption from the keyboard.
    """
    if run_key(scenario) != key:
        return Outdated(key)
    try:
        return _kept(scenario, Store(store), key)
    except Exception as error:
        line = " ".join(f"{type(error).__name__}: {error}".split())
        return Failed(key, line, traceback.format_exc())


def work_apart(scenario: Scenario, store: str, key: str) -> Result:
    """As `work`, in a process of its own, where Ctrl-C is the parent's to handle."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    return work(scenario, store, key)


def _kept(scenario: Scenario, store: Store, key: str) -> Done:
    begin = time.perf_counter()
    run = simulate(scenario)
    duration = time.perf_counter() - begin
    store.keep(run, duration)
    return Done(key, run.outcome, duration)
