"""The command `jamsweep`."""

import importlib
import pkgutil
import re
import sys
from collections.abc import Sequence
from importlib import metadata

import click
from click.shell_completion import CompletionItem

from engine import FINGERPRINT, BadInput
from engine.errors import require
from sweep.commands.beginning import completion, init
from sweep.commands.export import export
from sweep.commands.numerics import check_numerics
from sweep.commands.pages import report, view
from sweep.commands.run import run
from sweep.commands.store import FAILED, compact, gather, status, verify
from sweep.commands.sweeping import sweep
from sweep.errors import DamagedFile, SweepStopped
from sweep.report import tell

BAD_INPUT, INTERRUPTED = 2, 130  # exit codes
SETTINGS = {
    "help_option_names": ["-h", "--help"],
    "token_normalize_func": lambda word: word.replace("_", "-"),
}
STUDIES = "studies"
EVERYTHING, FIGURE = "everything", r"(fig|table)\d+|hazard"  # modules of a paper of several studies
PLAIN = "lin"  # the paper whose figures go without its name: fig10 is Lin's, fig1 of another paper parisi-fig1


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
    jamsweep init grid.toml
    jamsweep sweep grid.toml --jobs 2
    jamsweep status results/mine
    eval "$(jamsweep completion bash)"   # completion by TAB; also zsh, fish

    Exit codes: 0 all done, 1 a run failed or a file is damaged, 2 bad input, 130 interrupted. Results are written to
    stdout, progress and complaints to stderr.
    """  # noqa: D301  click reads \b as a character


for command in (init, run, check_numerics, sweep, status, gather, view, report, export, verify, compact, completion):
    cli.add_command(command)


def _complete_study(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    return [CompletionItem(name) for name in _studies() if name.startswith(incomplete)]


@cli.command()
@click.argument("name", shell_complete=_complete_study)
@click.option("--quick", is_flag=True, help="A thinned grid that ends within two minutes.")
@click.option("--jobs", type=int, default=2, show_default=True, help="Number of worker processes.")
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
