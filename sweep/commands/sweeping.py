"""`jamsweep sweep`: what is missing of a grid file is run, in the manner that the file and the options say."""

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from engine import OUTCOMES, BadInput
from sweep.commands.store import FAILED, code_option, say
from sweep.gridfile import read_gridfile, read_running, read_until, where
from sweep.running.backends import BACKENDS, DASK, LOKY
from sweep.status import status_of
from sweep.storage.store import Store, sizes_in

if TYPE_CHECKING:
    import xarray as xr

RUNNER, UNTIL = "sweep.runner", "sweep.until"  # imported when they are needed, since that takes half a second
JOBS = 2


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--jobs", type=int, help=f"Number of worker processes.  [default: {JOBS}]")
@click.option("--dry-run", is_flag=True, help="Say what there is to do, and do nothing.")
@click.option("--why", is_flag=True, help="With --dry-run: also say which runs are to do, and why.")
@code_option
@click.option("--backend", help=f"One of {', '.join(BACKENDS)}.  [default: {LOKY}]")
@click.option("--scheduler", metavar="ADDRESS", help="Scheduler of a dask cluster that sees the store.")
@click.option("--timeout", type=float, metavar="SECONDS", help="End a run that takes longer; the others go on.")
@click.option("--memory-limit", metavar="SIZE", help='End a worker that takes more, such as "2 GB".')
@click.option("--fail-fast/--no-fail-fast", default=None, help="Begin no further run after one that failed.")
@click.option("--retry", is_flag=True, help="Try again what is set aside: ended its workers, or ran out of time.")
@click.option("--json", "as_json", is_flag=True, help="Say in the end what there is as JSON on stdout.")
def sweep(
    file: Path,
    dry_run: bool,
    why: bool,
    on_code_change: str | None,
    retry: bool,
    as_json: bool,
    **options: Any,
) -> None:
    """Run what is missing of the grid that FILE (TOML) describes, and gather it.

    \b
    jamsweep init grid.toml      # writes a file to begin with
    jamsweep sweep grid.toml --dry-run
    jamsweep sweep grid.toml --jobs 4 --timeout 600

    \b
    room = "lin_room"
    store = "results/mine"       # from where the command is given
    on_code_change = "rerun"     # or "accept", "error": runs that another state of the engine made
    common_random_numbers = true # false: every cell draws its own
    [axes]
    v_d = [0.6, 1.0]
    seed = { first = 0, last = 9, step = 1 }
    [constants]
    N = 200
    [until]                      # not needed: as many of the seeds in each cell as its interval needs
    clearance_time = 0.05        # half-width of the mean over itself, in the smooth state
    blocked_share = 0.1          # half-width
    resolution = 0.1             # m/s: new cells where a boundary between states is undecided
    budget = 2000                # runs
    [running]                    # not needed: as the options, which win
    jobs = 4
    timeout = 600                # s; also memory_limit, backend, scheduler, fail_fast

    Exit code 1 if a run failed; the others are done nevertheless. Ctrl-C lets the runs under way finish, a second one
    ends them; both give exit code 130, and the same command resumes.
    """  # noqa: D301  click reads \b as a character
    described = read_gridfile(file)
    choice, kept = on_code_change or described.on_code_change, Store(described.store)
    manner = merged(read_running(file), options) | {"on_code_change": choice, "retry": retry}
    goals = read_until(file)
    if dry_run:
        kept.check()
        grid = described.grid
        if goals is not None:
            with _until_blamed(file):
                grid = import_module(UNTIL).first_round(grid, goals)
        found = status_of(grid, kept, choice)
        if as_json:
            click.echo(json.dumps({"runs": len(found.runs), "states": found.counts()}))
        else:
            say(found, why)
            if goals is not None:
                click.echo("these are the first round; cells get more seeds as their intervals need them")
        return
    with _until_blamed(file):
        ds = import_module(RUNNER).sweep(described.grid, kept, until=goals, **manner)
    if goals is None:
        _finish(ds, kept, as_json)
        return
    if not as_json:
        click.echo(import_module(UNTIL).account(ds))
    _finish(ds, kept, as_json, meant=int((ds.seeds_given.max() - ds.seeds_given).sum()))


def merged(from_file: dict[str, Any], options: dict[str, Any]) -> dict[str, Any]:
    """Keywords of `sweep.sweep`: options that are given win over the file's entries, and those over the defaults.

    A back end and a scheduler go together: one that is given as an option also sets aside the other of the file that
    does not go with it.
    """
    given = {name: value for name, value in options.items() if value is not None}
    kept = dict(from_file)
    if given.get("backend", DASK) != DASK:
        kept.pop("scheduler", None)
    if "scheduler" in given:
        kept.pop("backend", None)
    manner = {"jobs": JOBS} | kept | given
    return {"backend": DASK if manner.get("scheduler") else LOKY} | manner


@contextmanager
def _until_blamed(file: Path) -> Iterator[None]:
    """Say of a wrong goal on which line of the file it stands."""
    try:
        yield
    except BadInput as error:
        entry = re.match(r"until: (?:entry )?'?(\w+)", str(error))
        if not str(error).startswith("until"):
            raise
        raise BadInput(f"{where(file, 'until', *(entry.groups() if entry else ()))}: {error}") from None


def _finish(ds: "xr.Dataset", store: Store, as_json: bool, meant: int = 0) -> None:
    """Say how runs ended and where the dataset is; `meant`: runs that are missing because they were not asked for."""
    number = {word: int((ds.outcome == code).sum()) for code, word in enumerate(OUTCOMES)}
    number["missing"] -= meant
    if as_json:
        notes = [str(store.failed / name) for name in sorted(sizes_in(store.failed))]
        told = {"store": str(store.path), "dataset": str(store.dataset), "outcomes": number, "failure_notes": notes}
        click.echo(json.dumps({"runs": sum(number.values())} | told))
    else:
        click.echo(", ".join(f"{count} {word}" for word, count in number.items() if count))
        click.echo(str(store.dataset))
    if number["missing"]:
        raise click.exceptions.Exit(FAILED)
