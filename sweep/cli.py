"""The command `jamsweep`."""

import importlib
import pkgutil
import re
import sys
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from engine import FINGERPRINT, OUTCOMES, BadInput
from engine.errors import require
from sweep.commands.export import export
from sweep.commands.pages import report, view
from sweep.commands.run import run
from sweep.commands.store import code_option, compact, gather, say, status, verify
from sweep.errors import DamagedFile, SweepStopped
from sweep.gridfile import read_gridfile, read_until
from sweep.report import tell
from sweep.running.backends import BACKENDS, DASK, LOKY
from sweep.status import status_of
from sweep.storage.store import Store

if TYPE_CHECKING:
    import xarray as xr

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130  # exit codes
SETTINGS = {
    "help_option_names": ["-h", "--help"],
    "token_normalize_func": lambda word: word.replace("_", "-"),
}
STUDIES = "studies"
RUNNER, UNTIL = "sweep.runner", "sweep.until"  # imported when they are needed, since that takes half a second
EVERYTHING, FIGURE = "everything", r"(fig|table)\d+|hazard"  # modules of a paper of several studies
PLAIN = "lin"  # the paper whose figures go without its name: fig10 is Lin's, fig1 of another paper parisi-fig1
jobs_option = click.option("--jobs", type=int, default=2, show_default=True, help="Number of worker processes.")
dry_option = click.option("--dry-run", is_flag=True, help="Say what there is to do, and do nothing.")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command; every error is one line on stderr and an exit code."""
    try:
        code = cli.main(arguments, prog_name="jamsweep", standalone_mode=False)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message())
        code = 0
    except click.ClickException as error:
        code = _complain(error.format_message(), error.exit_code)
    except BadInput as error:
        code = _complain(error, BAD_INPUT)
    except OSError as error:
        code = _complain(f"{error.filename or 'file'}: {error.strerror or error}", BAD_INPUT)
    except (SweepStopped, DamagedFile) as error:
        code = _complain(error, FAILED)
    except (KeyboardInterrupt, click.Abort):
        code = INTERRUPTED
    sys.exit(code or 0)


def _complain(error: object, code: int) -> int:
    tell("jamsweep: " + " ".join(str(error).split()))
    return code


def _version() -> str:
    try:
        return metadata.version("jamsweep")
    except metadata.PackageNotFoundError:
        return "(not installed)"


@click.group(context_settings=SETTINGS)
@click.version_option(_version(), message=f"%(prog)s %(version)s, engine {FINGERPRINT}")
def cli() -> None:
    """Sweep a crowd through a door until it jams.

    \b
    jamsweep run lin_room --v-d 1.0 --N 200 --seed 1 -o run.nc
    jamsweep sweep grid.toml --jobs 2
    jamsweep status results/mine
    """  # noqa: D301  click reads \b as a character


for command in (run, view, status, gather, report, verify, compact, export):
    cli.add_command(command)


@cli.command()
@click.argument("file", type=click.Path(path_type=Path))
@jobs_option
@dry_option
@click.option("--why", is_flag=True, help="With --dry-run: also say which runs are to do, and why.")
@code_option
@click.option("--backend", default=None, help=f"One of {', '.join(BACKENDS)}.  [default: {LOKY}]")
@click.option("--scheduler", metavar="ADDRESS", help="Scheduler of a dask cluster that sees the store.")
@click.option("--timeout", type=float, metavar="SECONDS", help="End a run that takes longer; the others go on.")
@click.option("--memory-limit", metavar="SIZE", help='End a worker that takes more, such as "2 GB".')
@click.option("--fail-fast", is_flag=True, help="Begin no further run after one that failed.")
@click.option("--retry", is_flag=True, help="Try again what is set aside: ended its workers, or ran out of time.")
def sweep(
    file: Path, jobs: int, dry_run: bool, why: bool, on_code_change: str | None, backend: str | None, **manner: Any
) -> None:
    """Run what is missing of the grid that FILE (TOML) describes, and gather it.

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
    budget = 2000                # runs

    Exit code 1 if a run failed; the others are done nevertheless. Ctrl-C lets the runs under way finish, a second one
    ends them; both give exit code 130, and the same command resumes.
    """  # noqa: D301  click reads \b as a character
    described = read_gridfile(file)
    choice, kept = on_code_change or described.on_code_change, Store(described.store)
    if dry_run:
        kept.check()
        say(status_of(described.grid, kept, choice), why)
        return
    manner["backend"] = backend or (DASK if manner["scheduler"] else LOKY)
    manner["on_code_change"] = choice
    goals = read_until(file)
    ds = importlib.import_module(RUNNER).sweep(described.grid, kept, jobs, until=goals, **manner)
    if goals is None:
        _finish(ds, kept.dataset)
        return
    click.echo(importlib.import_module(UNTIL).account(ds))
    _finish(ds, kept.dataset, meant=int((ds.seeds_given.max() - ds.seeds_given).sum()))


def _finish(ds: "xr.Dataset", path: Path, meant: int = 0) -> None:
    """Say how runs ended and where the dataset is; `meant`: runs that are missing because they were not asked for."""
    number = {word: int((ds.outcome == code).sum()) for code, word in enumerate(OUTCOMES)}
    number["missing"] -= meant
    click.echo(", ".join(f"{count} {word}" for word, count in number.items() if count))
    click.echo(str(path))
    if number["missing"]:
        raise click.exceptions.Exit(FAILED)


@cli.command()
@click.argument("name")
@click.option("--quick", is_flag=True, help="A thinned grid that ends within two minutes.")
@jobs_option
def study(name: str, quick: bool, jobs: int) -> None:
    """Run the study NAME: its grid, its table and its figure.

    \b
    jamsweep study fig10 --quick
    """  # noqa: D301  click reads \b as a character
    modules = _studies()
    plain = name.replace("_", "-").removeprefix(f"{PLAIN}-")
    require(plain in modules, "study", repr(name), "is not known", f"choose one of {', '.join(modules)}")
    importlib.import_module(modules[plain]).main(quick=quick, jobs=jobs)


def _studies() -> dict[str, str]:
    """Names of the studies and their modules.

    A package is a paper of several: fig10 is studies.lin.fig10 and lin studies.lin.everything; parisi-fig1 is
    studies.parisi.fig1 and parisi studies.parisi.everything.
    """
    package = importlib.import_module(STUDIES)
    found: dict[str, str] = {}
    for module in pkgutil.iter_modules(package.__path__):
        if module.ispkg:
            found |= _studies_of_paper(module.name, [f"{path}/{module.name}" for path in package.__path__])
        else:
            found[module.name.replace("_", "-")] = f"{STUDIES}.{module.name}"
    return dict(sorted(found.items()))


def _studies_of_paper(paper: str, path: list[str]) -> dict[str, str]:
    names = [module.name for module in pkgutil.iter_modules(path)]
    prefix = "" if paper == PLAIN else f"{paper}-"
    figures = {f"{prefix}{name}": f"{STUDIES}.{paper}.{name}" for name in names if re.fullmatch(FIGURE, name)}
    return figures | ({paper: f"{STUDIES}.{paper}.{EVERYTHING}"} if EVERYTHING in names else {})


if __name__ == "__main__":
    main()
