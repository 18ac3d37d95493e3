"""The runner: finds what is missing in a store and has workers run it."""

from collections.abc import Generator, Iterable
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import xarray as xr
from joblib import Parallel, delayed, parallel_config
from joblib.externals.loky.process_executor import TerminatedWorkerError

from engine import Record, Scenario, simulate
from engine.errors import require
from sweep.errors import SweepStopped
from sweep.gather import gather
from sweep.grid import Grid, Point, named
from sweep.report import late_word, tell
from sweep.report import progress as progress_of
from sweep.schema import run_key
from sweep.store import Store
from sweep.worker import Done, Failed, Outdated, Result, work, work_apart

PATIENCE = 2.0  # s without a word


class Task(NamedTuple):
    """One run that a grid asks for."""

    key: str
    point: Point
    scenario: Scenario


class Plan(NamedTuple):
    """The distinct runs of a grid, and those of them that the store lacks."""

    tasks: list[Task]
    missing: list[Task]

    def __str__(self) -> str:
        """How many runs there are, are done, and are to do."""
        total, left = len(self.tasks), len(self.missing)
        words = f"{total} run{'s' * (total != 1)}: {total - left} done, {left} to do"
        return words if left else f"{words}; nothing to run"


def sweep(grid: Grid, store: Path | str | Store, jobs: int = 2, progress: bool = True) -> xr.Dataset:
    """Run what the store does not hold of a grid, and gather the whole.

    Parameters
    ----------
    grid : what to run
    store : folder of the runs; a second call with the same one runs only what is missing
    jobs : number of worker processes; 1 runs in this process. No value depends on it.
    progress : whether to say how far it is; failing runs are always said

    Returns
    -------
    Dataset
        See `gather`. Runs that failed have the outcome "missing"; `failed/KEY.txt` in the store says why.

    Raises
    ------
    BadInput
        If the store cannot be written to.
    SweepStopped
        If a worker was killed or the engine edited meanwhile; finished runs are kept.
    """
    whole = isinstance(jobs, int) and jobs > 0
    require(whole, "jobs", repr(jobs), "is not a whole number above 0", "give a number of workers")
    store = Store(store)
    store.make()
    store.note_grid(grid.to_json())
    plan = plan_of(grid, store)
    if progress:
        tell(str(plan))
    if plan.missing:
        _run(plan.missing, grid, store, min(jobs, len(plan.missing)), progress)
    return gather(grid, store)


def plan_of(grid: Grid, store: Store) -> Plan:
    """What a sweep would find done and to do."""
    finished = store.finished()
    points = ((point, grid.scenario(point)) for point in grid.points())
    tasks = {key: Task(key, point, scenario) for point, scenario in points for key in [run_key(scenario)]}
    return Plan(list(tasks.values()), [task for key, task in tasks.items() if key not in finished])


def _run(tasks: list[Task], grid: Grid, store: Store, jobs: int, shown: bool) -> None:
    """Run all tasks; an end before the last one leaves a line that says what is kept."""
    try:
        _compile((task.scenario for task in tasks), shown)
        failures = _run_all(tasks, grid, store, jobs, shown)
    except KeyboardInterrupt:
        tell(f"interrupted: {_kept(tasks, store)}, run again to resume")
        raise
    except TerminatedWorkerError:
        why = "a worker process was killed (out of memory?)"
        raise SweepStopped(f"{why}: {_kept(tasks, store)}, run again to resume") from None
    if failures:
        tell(f"{failures} of {len(tasks)} runs failed: parameters and tracebacks are in {store.failed}")


def _run_all(tasks: list[Task], grid: Grid, store: Store, jobs: int, shown: bool) -> int:
    """Number of failures; each is said and noted when it comes."""
    failures = 0
    parameters = {task.key: {**grid.constants, **task.point} for task in tasks}
    with progress_of(len(tasks), shown) as advance, closing(_results(tasks, store, jobs)) as results:
        for result in results:
            if isinstance(result, Outdated):
                kept = _kept(tasks, store)
                raise SweepStopped(f"the engine's sources were edited meanwhile: {kept}, start again")
            failures += _note(result, store, parameters[result.key])
            advance()
    return failures


def _results(tasks: list[Task], store: Store, jobs: int) -> Generator[Result]:
    """Run tasks, here or in workers; results come in the order in which the runs end."""
    path = str(store.path.absolute())
    if jobs == 1:
        yield from (work(task.scenario, path, task.key) for task in tasks)
        return
    with parallel_config("loky", inner_max_num_threads=1):
        run = Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)
        yield from run(delayed(work_apart)(task.scenario, path, task.key) for task in tasks)


def _compile(scenarios: Iterable[Scenario], shown: bool) -> None:
    """Compile each model once, by a run of one step: workers then find it in numba's cache on disk."""
    kinds = {tuple(map(type, scenario.model)): scenario for scenario in scenarios}
    with late_word(PATIENCE, "compiling the model, once for each state of the engine ...", shown):
        for scenario in kinds.values():
            short = replace(scenario.stopping, time_limit=scenario.numerics.dt)
            with suppress(Exception):  # its own run tells
                simulate(replace(scenario, stopping=short, record=Record()))


def _note(result: Done | Failed, store: Store, parameters: Point) -> bool:
    """Note a failure, or that an earlier one is overcome; true for a failure."""
    if isinstance(result, Done):
        store.forget_failure(result.key)
        return False
    text = f"{result.error}\n\nparameters: {named(parameters)}\n\n{result.traceback}"
    store.note_failure(result.key, text)
    tell(f"failed: {named(parameters)}: {result.error}")
    return True


def _kept(tasks: list[Task], store: Store) -> str:
    finished = store.finished()
    return f"{sum(task.key in finished for task in tasks)} of {len(tasks)} runs are kept"
