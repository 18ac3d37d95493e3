"""The execution of a sweep's missing runs: handed to a back end, their ends noted and said."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from typing import NamedTuple

from sweep.errors import SweepStopped
from sweep.grid import Grid, named
from sweep.report import late_word, tell
from sweep.report import progress as progress_of
from sweep.running.backends import DASK, LOKY, SERIAL, Backend, Loky, Serial, results
from sweep.running.cluster import Dask
from sweep.running.estimate import Durations
from sweep.running.interruption import two_stages
from sweep.running.limits import Limits
from sweep.running.notes import command, note_of
from sweep.running.plan import Task
from sweep.running.shipping import packed
from sweep.running.slot import Job
from sweep.running.worker import Done, Outdated, Result, prepare
from sweep.storage.store import Store

PATIENCE = 2.0  # s without a word


class Manner(NamedTuple):
    """How runs are run."""

    backend: str
    jobs: int
    scheduler: str | None
    limits: Limits
    fail_fast: bool
    shown: bool


class Execution:
    """Runs tasks of a grid into a store.

    Parameters
    ----------
    tasks : in the order in which they shall begin
    durations : what is known of how long they take
    """

    def __init__(self, tasks: list[Task], durations: Durations, grid: Grid, store: Store, manner: Manner) -> None:
        self._tasks, self._durations, self._grid, self._store, self._manner = tasks, durations, grid, store, manner
        self._points = {task.key: task.point for task in tasks}
        self._waiting = Counter(durations.cell(task.point) for task in tasks)
        self._failures = 0

    def run(self) -> None:
        """Run all tasks; an end before the last one says what is kept.

        Raises
        ------
        SweepStopped, KeyboardInterrupt
            See `sweep.sweep`.
        """
        try:
            _compile(self._tasks, self._manner.shown)
            with two_stages(self._manner.backend != SERIAL) as stopping:
                self._run_all(stopping)
                if stopping():
                    raise KeyboardInterrupt
        except KeyboardInterrupt:
            tell(f"interrupted: {self._kept()}, run again to resume")
            raise
        except SweepStopped as stop:
            raise SweepStopped(f"{stop}: {self._kept()}, run again to resume") from None
        if self._failures:
            failed = f"{self._failures} of {len(self._tasks)} runs failed"
            tell(f"{failed}: parameters, tracebacks and commands are in {self._store.failed}")

    def _run_all(self, stopping: Callable[[], bool]) -> None:
        said = False

        def drain() -> bool:
            nonlocal said
            if stopping() and not said:
                said = True
                tell("stopping: runs under way are finished, Ctrl-C again ends them; then run again to resume")
            return said or (self._manner.fail_fast and self._failures > 0)

        shown = progress_of(len(self._tasks), self._manner.shown)
        with shown as advance, self._backend() as backend, closing(results(backend, self._jobs(), drain)) as ended:
            for result in ended:
                self._note(result)
                advance(self._left(result) / backend.places())
        if self._manner.fail_fast and self._failures:
            raise SweepStopped("a run failed")

    def _backend(self) -> Backend:
        jobs = min(self._manner.jobs, len(self._tasks))
        if self._manner.backend == DASK:
            return Dask(self._manner.scheduler, jobs, self._store)
        return Loky(jobs) if self._manner.backend == LOKY else Serial()

    def _jobs(self) -> Iterator[Job]:
        path = str(self._store.path.absolute())
        return (Job(task.key, packed(task.scenario), path, self._manner.limits) for task in self._tasks)

    def _note(self, result: Result) -> None:
        """Note and say a failure, or note that an earlier one is overcome."""
        if isinstance(result, Outdated):
            raise SweepStopped("the engine's sources were edited meanwhile")
        if isinstance(result, Done):
            self._store.forget_failure(result.key)
            return
        self._failures += 1
        point = self._points[result.key]
        self._store.note_failure(result.key, note_of(result, self._grid, point))
        tell(f"failed: {named({**self._grid.constants, **point})}: {result.error}")
        tell(f"  again: {command(self._grid, point)}")

    def _left(self, result: Result) -> float:
        """How long the runs that are not over will take one after the other, s."""
        point = self._points[result.key]
        self._waiting[self._durations.cell(point)] -= 1
        if isinstance(result, Done):
            self._durations.note(point, result.duration)
        return self._durations.left(self._waiting)

    def _kept(self) -> str:
        finished = self._store.finished()
        return f"{sum(task.key in finished for task in self._tasks)} of {len(self._tasks)} runs are kept"


def _compile(tasks: Iterable[Task], shown: bool) -> None:
    """Compile each model once: workers then find it in numba's cache on disk."""
    kinds = {task.kind: task for task in tasks}
    with late_word(PATIENCE, "compiling the model, once for each state of the engine ...", shown):
        for task in kinds.values():
            prepare(task.scenario)
