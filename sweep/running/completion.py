"""A grid completed in a store: what is missing is run, then all is gathered."""

from typing import NamedTuple

import xarray as xr

from sweep.errors import DamagedFile
from sweep.gathering import collect
from sweep.grid import Grid
from sweep.report import tell
from sweep.running.execution import Execution, Manner
from sweep.running.plan import Plan, durations_of, longest_first, not_held_back, plan_of
from sweep.storage.store import Store

ATTEMPTS = 3  # at a sweep whose files are damaged as soon as they are written


class Way(NamedTuple):
    """How a grid is completed; the words are those of `sweep.sweep`."""

    manner: Manner
    on_code_change: str
    retry: bool


def opened(store: Store) -> Store:
    """A store that is ready to be written to; files of a crash are swept, torn ones set aside."""
    store.make()
    store.sweep_leftovers()
    torn = store.set_torn_aside()
    if torn:
        tell(f"{len(torn)} run file{' is' if len(torn) == 1 else 's are'} damaged: set aside (.corrupt) and run again")
    return store


def complete(grid: Grid, store: Store, way: Way) -> xr.Dataset:
    """Run what the store does not hold of a grid, and gather the whole; see `sweep.sweep`."""
    store.note_grid(grid.to_json())
    for _ in range(ATTEMPTS):
        _run_missing(plan_of(grid, store, way.on_code_change), grid, store, way)
        gathered = collect(grid, store, way.on_code_change)
        if not gathered.aside:  # damaged runs that gathering met are run again
            return gathered.ds
    raise DamagedFile(f"store '{store.path}' damages what is written to it: check its disk")


def _run_missing(plan: Plan, grid: Grid, store: Store, way: Way) -> None:
    if way.manner.shown:
        tell(str(plan))
    tasks = plan.missing if way.retry else not_held_back(plan.missing, store, way.manner.limits)
    aside = len(plan.missing) - len(tasks)
    if aside:
        tell(f"{aside} of them set aside, see {store.failed}: retry=True (--retry) tries them again")
    if tasks:
        durations = durations_of(plan, grid, store)
        Execution(longest_first(tasks, durations), durations, grid, store, way.manner).run()
