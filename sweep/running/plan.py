"""What a sweep finds done and to do, and in which order it goes about it."""

from typing import NamedTuple

from engine import Scenario
from sweep.grid import Grid, Point
from sweep.report import tell
from sweep.running.estimate import Durations
from sweep.running.limits import Limits
from sweep.running.notes import held_back
from sweep.running.worker import Kind, kind_of
from sweep.storage.keys import keys_of
from sweep.storage.serving import RERUN, changed, serving
from sweep.storage.store import Store

NOTHING: Kind = ()  # of a run that is done


class Task(NamedTuple):
    """One run that a grid asks for."""

    key: str
    point: Point
    grid: Grid
    kind: Kind  # of compiled code that it needs

    @property
    def scenario(self) -> Scenario:
        """Made anew each time: a plan of a million runs does not hold a million scenarios."""
        return self.grid.scenario(self.point)


class Plan(NamedTuple):
    """The distinct runs of a grid, and those of them that the store lacks."""

    tasks: list[Task]
    missing: list[Task]

    def __str__(self) -> str:
        """How many runs there are, are done, and are to do."""
        total, left = len(self.tasks), len(self.missing)
        words = f"{total} run{'s' * (total != 1)}: {total - left} done, {left} to do"
        return words if left else f"{words}; nothing to run"


def plan_of(grid: Grid, store: Store, on_code_change: str = RERUN) -> Plan:
    """What a sweep would find done and to do; runs that another state of the engine made are said."""
    wanted = keys_of(grid, store)
    served = serving(wanted, store, on_code_change)
    if served.stale:
        tell(f"{changed(served.stale, len(wanted))}: run anew (on_code_change = 'accept' would take them as they are)")
    kinds: dict[Kind, Kind] = {}  # one object for each, which tasks share
    tasks: dict[str, Task] = {}
    for (key, _), point in zip(wanted, grid.points(), strict=True):
        kind = NOTHING if key in served.entries else kind_of(grid.scenario(point))
        tasks[key] = Task(key, point, grid, kinds.setdefault(kind, kind))
    return Plan(list(tasks.values()), [task for key, task in tasks.items() if key not in served.entries])


def not_held_back(tasks: list[Task], store: Store, limits: Limits) -> list[Task]:
    """The tasks that a sweep takes up without being asked for them; see `sweep.running.notes.held_back`."""
    return [task for task in tasks if not held_back(store, task.key, limits)]


def durations_of(plan: Plan, grid: Grid, store: Store) -> Durations:
    """How long the runs of a plan took that are done."""
    finished, durations = store.finished(), Durations(grid)
    for task in plan.tasks:
        if task.key in finished:
            durations.note(task.point, finished[task.key].duration)
    return durations


def longest_first(tasks: list[Task], durations: Durations) -> list[Task]:
    """The order in which to begin, so that no long run is left for the end."""
    return [tasks[k] for k in durations.longest_first(task.point for task in tasks)]
