"""What a worker does: one run, from its scenario to its file."""

import time
import traceback
from contextlib import suppress
from dataclasses import dataclass

from engine import Scenario, simulate
from sweep.running.shipping import PackedScenario, unpacked
from sweep.schema import run_key
from sweep.storage.store import Store


@dataclass(frozen=True)
class Done:
    """A run that was kept."""

    key: str
    duration: float  # s


@dataclass(frozen=True)
class Failed:
    """A run that raised an error, or was ended."""

    key: str
    error: str  # one line
    traceback: str


@dataclass(frozen=True)
class Outdated:
    """A run that was not begun: the engine here is another than the one that asked for it."""

    key: str


Result = Done | Failed | Outdated
Kind = tuple[object, ...]


def work(shipped: Scenario | PackedScenario, store: str, key: str) -> Result:
    """Simulate a scenario and keep the run.

    Parameters
    ----------
    shipped : what to run
    store : path of the store
    key : what the parent finds the run by

    Returns
    -------
    Done, Failed or Outdated
        No exception leaves, except an interruption from the keyboard.
    """
    try:
        scenario = unpacked(shipped)
        if run_key(scenario) != key:
            return Outdated(key)
        return _kept(scenario, Store(store), key)
    except Exception as error:
        return failed(key, error)


def failed(key: str, error: BaseException) -> Failed:
    """An exception as data."""
    line = " ".join(f"{type(error).__name__}: {error}".split())
    return Failed(key, line, "".join(traceback.format_exception(error)))


def kind_of(scenario: Scenario) -> Kind:
    """What decides which compiled code a scenario needs."""
    return (*map(type, scenario.model), scenario.numerics.integrator, scenario.law_fingerprint)


def prepare(shipped: Scenario | PackedScenario) -> None:
    """Have the code that a scenario needs compiled, or loaded from numba's cache on disk: a run of one step."""
    with suppress(Exception):  # the run itself tells
        scenario = unpacked(shipped)
        simulate(scenario, time_limit=scenario.numerics.dt, record_every=0.0, contacts=False)


def _kept(scenario: Scenario, store: Store, key: str) -> Done:
    begin = time.perf_counter()
    run = simulate(scenario)
    duration = time.perf_counter() - begin
    store.keep(run, duration)
    return Done(key, duration)
