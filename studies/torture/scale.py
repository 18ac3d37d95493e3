"""Many tiny runs through the whole path: what a run costs besides its computation, and what the parent holds.

The cost of a run is processor time, of the parent and its one worker, beyond that of a sweep of one run and beyond that
of the bare simulations; other programs on the machine do not add to it. What the disk takes to hold the files for good
comes on top: the time that calls of fsync take, measured in a serial sweep. Gathering and status take processor
time too.
"""

import itertools
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import psutil

from engine import simulate
from sweep import Grid, Store, gather
from sweep.running.execution import Execution, Manner
from sweep.running.limits import Limits
from sweep.running.plan import durations_of, plan_of
from sweep.running.worker import Result
from sweep.status import status_of
from sweep.storage import durable

FOLDER = Path("results/torture")  # on a disk: /tmp may be memory
LONGEST = 0.020  # s, the cost of a run with durable write
GROWTH = 5.0  # MB of the parent between its 1000th and its last run
FEW = 1000
COLD, WARM = 3.0, 0.1  # s, to gather 1000 run files, and to open what was gathered
STATUS = 1.0  # s, to say how far 10,000 runs are, once the program has started
TINY = {"N": 2, "size": 4.0, "time_limit": 0.1}


class Measured(NamedTuple):
    """A sweep of many tiny runs."""

    planning: float  # s of processor time, until the first run could begin
    cost: float  # s of processor time a run besides its computation
    syncing: float  # s a run in fsync of this process, median
    few: float  # MB the parent holds when 1000 runs of the sweep are over
    many: float  # MB when all are
    cold: float  # s of processor time to gather as many runs as `few` from their files
    warm: float  # s to do so again
    status: float  # s to say the state of all runs


def main(quick: bool) -> list[str]:
    """Measure; returns what is beyond its bound."""
    runs, few = (300, 100) if quick else (10_000, FEW)
    loky, serial = _apart("loky", runs, few), _apart("serial", few, few)
    total = loky.cost + serial.syncing
    problems = []
    if total > LONGEST and not quick:  # CI's machines are shared
        problems.append(f"a run costs {total * 1e3:.1f} ms besides its computation, above {LONGEST * 1e3:g} ms")
    for what, took, longest in (
        (f"gathering {few} files", loky.cold, COLD),
        (f"gathering {few} files again", loky.warm, WARM),
        (f"the status of {runs} runs", loky.status, STATUS),
    ):
        if took > longest and not quick:
            problems.append(f"{what} takes {took:.2f} s, above {longest:g} s")
    if loky.many - loky.few > GROWTH:
        problems.append(f"the parent grew from {loky.few:.0f} to {loky.many:.0f} MB while it ran")
    costs = (
        f"{loky.cost * 1e3:.1f} by loky, {serial.cost * 1e3:.1f} in one process, {serial.syncing * 1e3:.1f} for fsync"
    )
    memory = f"parent {loky.few:.0f} MB after {few}, {loky.many:.0f} MB after {runs} runs"
    planning = f"planning {loky.planning * 1e3 / runs:.2f} ms a run"
    reading = f"gathering {few} runs {loky.cold:.2f} s, again {loky.warm:.3f} s; status of {runs} {loky.status:.2f} s"
    print(f"scale: ms a run besides computation: {costs}; {planning}; {memory}; {reading}; {len(problems)} problems")
    return problems


def _apart(backend: str, runs: int, few: int) -> Measured:
    """Measure in a process of its own."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=FOLDER) as folder:
        command = [sys.executable, "-m", "studies.torture.scale", folder, backend, str(runs), str(few)]
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return Measured(*json.loads(done.stdout))


def measured(folder: Path, backend: str, runs: int, few: int) -> Measured:
    """Run one run, then all."""
    calls = _timed_fsync()
    store, grid = Store(folder), _grid(range(runs))
    store.make()
    begin = _processor()
    plan_of(grid, store)
    planning = _processor() - begin
    single = _took(_grid(range(runs, runs + 1)), store, backend)
    calls.clear()
    held: list[float] = []
    took = _took(grid, store, backend, few, held) - single
    syncing = statistics.median(calls) * len(calls) / runs if calls else 0.0
    resident, cost = _resident(), (took / runs) - _bare(grid)
    gather(_grid(range(1)), store)  # what the first call alone costs
    cold, warm = (_spent(gather, _grid(range(few)), store) for _ in range(2))
    return Measured(planning, cost, syncing, held[0], resident, cold, warm, _spent(status_of, grid, store))


def _spent(call: Callable[..., object], *arguments: object) -> float:
    """Processor time of a call, s."""
    begin = _processor()
    call(*arguments)
    return _processor() - begin


class Watched(Execution):
    """An execution that notes what the parent holds after so many runs."""

    few: int
    held: list[float]

    def _note(self, result: Result) -> None:
        super()._note(result)
        self.few -= 1
        if self.few == 0:
            self.held.append(_resident())


def _took(grid: Grid, store: Store, backend: str, few: int = 1, held: list[float] | None = None) -> float:
    """Processor time of running what is missing, s; `held` gets what the parent holds after `few` runs, MB."""
    plan = plan_of(grid, store)
    manner = Manner(backend, 1, None, Limits(), fail_fast=True, shown=False)
    execution = Watched(plan.missing, durations_of(plan, grid, store), grid, store, manner)
    execution.few, execution.held = few, [] if held is None else held
    begin = _processor()
    execution.run()
    return _processor() - begin


def _bare(grid: Grid) -> float:
    """Processor time of one simulation, s."""
    scenarios = [grid.scenario(point) for point in itertools.islice(grid.points(), 20)]
    begin = _processor()
    for scenario in scenarios:
        simulate(scenario)
    return (_processor() - begin) / len(scenarios)


def _timed_fsync() -> list[float]:
    """Note how long each call of fsync takes in this process, s."""
    calls: list[float] = []
    fsync = os.fsync

    def timed(descriptor: int) -> None:
        begin = time.perf_counter()
        fsync(descriptor)
        calls.append(time.perf_counter() - begin)

    durable.os.fsync = timed  # type: ignore[assignment]  # in this process only, which measures
    return calls


def _processor() -> float:
    """Processor time of this process and of those it has seen end, s."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


def _grid(seeds: range) -> Grid:
    return Grid("lin_room", seed=seeds, **TINY)


def _resident() -> float:
    return psutil.Process().memory_info().rss / 1e6


if __name__ == "__main__":
    _folder, _backend, _runs, _few = sys.argv[1:]
    print(json.dumps(measured(Path(_folder), _backend, int(_runs), int(_few))))
