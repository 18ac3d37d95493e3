"""`jamsweep init` and `jamsweep completion`: a grid file to begin with, and a shell that knows the commands."""

import inspect
import json
from pathlib import Path

import click
from click.shell_completion import get_completion_class

from engine.errors import require
from engine.rooms import ROOMS
from sweep.commands.run import parameter_words
from sweep.grid import SEED
from sweep.rooms import Room
from sweep.schema import PARAMETERS
from sweep.storage.durable import replace_durably, require_target

SHELLS = ("bash", "zsh", "fish")
PROGRAM, VARIABLE = "jamsweep", "_JAMSWEEP_COMPLETE"  # by which click knows that it is asked
AXES = {"v_d": "[0.8, 1.2, 1.6]", SEED: "{ first = 0, last = 4, step = 1 }  # both ends included"}
CONSTANTS = {"N": "60"}
TEMPLATE = """\
# A grid of runs. `jamsweep sweep {file}` runs what is missing of it, `jamsweep status {store}` says how far it is.
room = "{room}"
store = "{store}"  # folder of the runs, from where the command is given

# Every combination of these values is run, each with each seed.
[axes]
{axes}

# What is the same in all runs. Any of these may be an axis instead: move it up and give a list.
[constants]
{constants}

# How runs are run; options of the command win. Take the # away from what you want.
[running]
# jobs = 2               # worker processes
# timeout = 600          # s that a run may take; it is then ended and noted, and the others go on
# memory_limit = "2 GB"  # of a worker
# fail_fast = false      # true: begin no further run after one that failed
# backend = "loky"       # or "serial", "dask"
# scheduler = "tcp://head:8786"  # of a dask cluster that sees the store

# Seeds where they are needed, instead of all in each cell: see `jamsweep sweep --help`.
# [until]
# clearance_time = 0.05  # half-width of the mean over itself, in the smooth state
# blocked_share = 0.1    # half-width
"""


@click.command()
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path), default="grid.toml")
@click.option("--room", default="lin_room", show_default=True, help=f"One of {', '.join(ROOMS)}.")
@click.option("--store", default="results/mine", show_default=True, help="Folder that the sweep shall write to.")
@click.option("--force", is_flag=True, help="Replace FILE if it is there.")
def init(file: Path, room: str, store: str, force: bool) -> None:
    """Write FILE, a grid to begin with: 15 small runs, and every keyword of the room with its default.

    \b
    jamsweep init grid.toml
    jamsweep init grid.toml --room parisi_room --store results/parisi
    """  # noqa: D301  click reads \b as a character
    name = room.replace("-", "_")
    require(name in ROOMS, "room", repr(room), "is not known", f"choose one of {', '.join(ROOMS)}")
    plain = store.isprintable() and not set(store) & set('"\\') and store != ""
    require(plain, "store", repr(store), "is no plain path", "name a folder")
    require(force or not file.exists(), "file", f"'{file}'", "is there already", "name another, or give --force")
    require_target(file)
    text = example(name, str(file), store)
    replace_durably(file, lambda temporary: temporary.write_text(text, "utf-8"))
    click.echo(str(file))


def example(name: str, file: str, store: str) -> str:
    """The text of a grid file for a room."""
    room = ROOMS[name]
    axes = "\n".join(f"{keyword} = {value}" for keyword, value in AXES.items())
    held = [f"{keyword} = {value}" for keyword, value in CONSTANTS.items()]
    entries = [*held, *_defaults(room)]
    return TEMPLATE.format(file=file, room=name, store=store, axes=axes, constants="\n".join(entries))


def _defaults(room: Room) -> list[str]:
    """A line for each other keyword, as a comment, with its default and what it is."""
    words, lines = parameter_words(room), []
    for name, parameter in inspect.signature(room).parameters.items():
        if name in AXES or name in CONSTANTS:
            continue
        units, long_name = PARAMETERS.get(name, ("1", words.get(name, "")))
        text = long_name if units == "1" else f"{long_name}, {units}"
        value, follows = parameter.default, "; follows from the others if not given"
        lines.append(
            f"# {name} =   # {text}{follows}" if value is None else f"# {name} = {json.dumps(value)}  # {text}"
        )
    return lines


@click.command()
@click.argument("shell", type=click.Choice(SHELLS))
def completion(shell: str) -> None:
    """Print what makes SHELL complete commands, options, rooms and studies by TAB.

    \b
    eval "$(jamsweep completion bash)"                              # this shell; put it into ~/.bashrc for all
    eval "$(jamsweep completion zsh)"                               # or ~/.zshrc
    jamsweep completion fish > ~/.config/fish/completions/jamsweep.fish
    """  # noqa: D301  click reads \b as a character
    kind = get_completion_class(shell)
    if kind is None:
        raise click.ClickException(f"click has no completion for {shell}")
    command = click.get_current_context().find_root().command
    click.echo(kind(command, {}, PROGRAM, VARIABLE).source())
