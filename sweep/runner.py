"""The runner: finds what is missing in a store and has it run."""

from pathlib import Path

import xarray as xr

from engine.errors import require
from sweep.backends import chosen
from sweep.execution import Execution, Manner
from sweep.gather import gather
from sweep.grid import Grid
from sweep.limits import limits_of
from sweep.plan import durations_of, longest_first, not_held_back, plan_of
from sweep.report import tell
from sweep.store import Store


def sweep(
    grid: Grid,
    store: Path | str | Store,
    jobs: int = 2,
    progress: bool = True,
    *,
    backend: str | None = None,
    scheduler: str | None = None,
    timeout: float | None = None,
    memory_limit: float | str | None = None,
    fail_fast: bool = False,
    retry: bool = False,
) -> xr.Dataset:
    """Run what the store does not hold of a grid, and gather the whole.

    Parameters
    ----------
    grid : what to run
    store : folder of the runs; a second call with the same one runs only what is missing
    jobs : number of worker processes; 1 runs in this process, if no back end is named and nothing limits a run. No
        value depends on it.
    progress : whether to say how far it is; failing runs are always said
    backend : "loky" (worker processes of this machine), "serial" (this process) or "dask"
    scheduler : address of a dask scheduler; without one, the back end "dask" starts `jobs` workers of its own
    timeout : time that one run may take, s; it is then ended, noted as failed, and the sweep goes on
    memory_limit : what the worker of a run may take, in bytes or as "2 GB"; it is watched ten times a second
    fail_fast : begin no further run after one that failed
    retry : whether to try again also what is set aside: runs in which workers ended twice, and runs that took
        longer than a time-out that was not shorter than this one

    Returns
    -------
    Dataset
        See `gather`. Runs that failed have the outcome "missing"; `failed/KEY.txt` in the store says why, and has
        the command that repeats the run.

    Raises
    ------
    BadInput
        If the store cannot be written to or is not seen by the workers, or an option is not valid.
    SweepStopped
        If a run failed and `fail_fast` is set, the engine was edited meanwhile, or no workers can be had; finished
        runs are kept.
    KeyboardInterrupt
        After Ctrl-C: the first lets the runs under way finish, a second ends them. Finished runs are kept.
    """
    whole = isinstance(jobs, int) and jobs > 0
    require(whole, "jobs", repr(jobs), "is not a whole number above 0", "give a number of workers")
    limits = limits_of(timeout, memory_limit)
    manner = Manner(chosen(backend, jobs, scheduler, limits), jobs, scheduler, limits, fail_fast, progress)
    store = Store(store)
    store.make()
    store.note_grid(grid.to_json())
    plan = plan_of(grid, store)
    if progress:
        tell(str(plan))
    tasks = plan.missing if retry else not_held_back(plan.missing, store, limits)
    aside = len(plan.missing) - len(tasks)
    if aside:
        tell(f"{aside} of them set aside, see {store.failed}: retry=True (--retry) tries them again")
    if tasks:
        durations = durations_of(plan, grid, store)
        Execution(longest_first(tasks, durations), durations, grid, store, manner).run()
    return gather(grid, store)
