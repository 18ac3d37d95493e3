"""The runner: finds what is missing in a store and has it run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from engine.errors import require
from sweep.grid import Grid
from sweep.running.backends import chosen
from sweep.running.completion import Way, complete, opened
from sweep.running.execution import Manner
from sweep.running.limits import limits_of
from sweep.storage.serving import RERUN
from sweep.storage.store import Store
from sweep.until import Until, sweep_until


def sweep(
    grid: Grid,
    store: Path | str | Store,
    jobs: int = 2,
    progress: bool = True,
    *,
    until: Until | str | Mapping[str, Any] | None = None,
    on_code_change: str = RERUN,
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
    until : gives each cell only as many of the grid's seeds as its interval needs, in rounds, see
        `sweep.until`: a rule, or its goals as a table or in words, "clearance_time=5%, blocked_share=0.1,
        budget=2000", see `studies.until.rules.until_of`
    on_code_change : what becomes of runs that another state of the engine made: "rerun" runs them anew, "accept" takes
        them as they are (`accepted_engines` of the dataset says how many), "error" stops
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
        If a run failed and `fail_fast` is set, `on_code_change` is "error" and there are such runs, the engine was
        edited meanwhile, or no workers can be had; finished runs are kept.
    CannotWrite
        If the disk is full; finished runs are kept.
    DamagedFile
        If files that were just written are damaged time and again.
    KeyboardInterrupt
        After Ctrl-C: the first lets the runs under way finish, a second ends them. Finished runs are kept.
    """
    whole = isinstance(jobs, int) and jobs > 0
    require(whole, "jobs", repr(jobs), "is not a whole number above 0", "give a number of workers")
    limits = limits_of(timeout, memory_limit)
    manner = Manner(chosen(backend, jobs, scheduler, limits), jobs, scheduler, limits, fail_fast, progress)
    way = Way(manner, on_code_change, retry)
    if until is not None:
        return sweep_until(grid, Store(store), until, way)
    return complete(grid, opened(Store(store)), way)
