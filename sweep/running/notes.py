"""What is noted about a run that failed, and whether a later sweep tries it again.

A note begins with a line that says what happened; then the command that repeats the run, its parameters, and the
traceback.
"""

import inspect
import math
import re
import shlex

from sweep.grid import Grid, Point, named
from sweep.rooms import is_in_a_file
from sweep.running.limits import Limits
from sweep.running.slot import ASIDE, LATE
from sweep.running.worker import Failed
from sweep.storage.store import Store


def note_of(failure: Failed, grid: Grid, point: Point) -> str:
    """The text of `failed/KEY.txt`."""
    parameters = {**grid.constants, **point}
    parts = [failure.error, f"again: {command(grid, point)}", f"parameters: {named(parameters)}", failure.traceback]
    return "\n\n".join(part.strip() for part in parts if part.strip()) + "\n"


def command(grid: Grid, point: Point) -> str:
    """The line that runs a point of a grid again, to the shell; for a room of one's own through Python."""
    parameters = {**grid.constants, **point}
    if ":" not in grid.name or is_in_a_file(grid.name):
        options = (_option(name, value) for name, value in parameters.items())
        return " ".join(["jamsweep", "run", grid.name, *options])
    module, _, name = grid.name.partition(":")
    keywords = ", ".join(f"{key}={value!r}" for key, value in parameters.items())
    path = inspect.getsourcefile(grid.room)
    load = f"import runpy; room = runpy.run_path({path!r})[{name!r}]" if module == "__main__" else ""
    load = load or f"from {module} import {name} as room"
    return f"python -c {shlex.quote(f'{load}; from engine import simulate; print(simulate(room({keywords})))')}"


def held_back(store: Store, key: str, limits: Limits) -> bool:
    """Whether a run is left alone until it is asked for.

    One that workers did not survive might take the machine along as well; one that ran out of time would do so again
    if it is not given more.
    """
    try:
        with (store.failed / f"{key}.txt").open(encoding="utf-8", errors="replace") as note:
            line = note.readline()
    except OSError:
        return False
    late = re.match(rf"{LATE} (\S+) s", line)
    return line.startswith(ASIDE) or (late is not None and limits.timeout <= _number(late[1]))


def _option(name: str, value: object) -> str:
    flag = name.replace("_", "-")
    if isinstance(value, bool):
        return f"--{flag}" if value else f"--no-{flag}"
    return f"--{flag} {shlex.quote(str(value))}"


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.inf
