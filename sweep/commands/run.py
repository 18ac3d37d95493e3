"""`jamsweep run`: each room a subcommand, each of its keywords an option."""

import inspect
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_type_hints

import click

from engine import Options, Run, Scenario, simulate
from engine.rooms import ROOMS
from sweep.grid import plain_kind
from sweep.rooms import Room, is_in_a_file, room_named
from sweep.schema import PARAMETERS, engine_of, run_key
from sweep.storage.durable import require_target
from sweep.storage.runfile import write_run


class RoomCommands(click.Group):
    """One subcommand for each room, made by `command_of(name, room)`."""

    def __init__(self, *args: Any, command_of: Callable[[str, Room], click.Command], **keywords: Any) -> None:
        super().__init__(*args, **keywords)
        self._command_of = command_of

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The rooms' names."""
        return list(ROOMS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command:
        """The subcommand of a room."""
        name = cmd_name if is_in_a_file(cmd_name) else cmd_name.replace("-", "_")
        return self._command_of(name, room_named(name))


def _room_command(name: str, room: Room) -> click.Command:
    def once(output: Path | None, as_json: bool, **parameters: Any) -> None:
        _run_once(room(**parameters), output, as_json)

    target = click.Path(dir_okay=False, path_type=Path)
    out = click.Option(["-o", "--output"], type=target, help="netCDF file to write the run to.")
    plain = click.Option(["--json", "as_json"], is_flag=True, help="Say how the run ended as JSON on stdout.")
    summary, example = first_line(room), f"\b\njamsweep run {name} --seed 1 -o run.nc"
    options, words = [*options_of(room), out, plain], f"{summary}\n\n{example}"
    return click.Command(name, params=options, callback=once, help=words, short_help=summary)


@click.group(cls=RoomCommands, command_of=_room_command)
def run() -> None:
    """Run one scenario of a room.

    \b
    jamsweep run lin_room --v-d 1.0 --N 200 --seed 1 -o run.nc
    jamsweep run parisi_room --v-d 4 --record-every 0.1 --contacts -o run.nc
    jamsweep run lin_room --v-d 1.6 --json
    jamsweep run my_rooms.py:my_room --seed 3

    Each room has options of its own: jamsweep run lin_room --help.
    """  # noqa: D301  click reads \b as a character


def _run_once(scenario: Scenario, output: Path | None, as_json: bool) -> None:
    if output is not None:
        require_target(output)
    result = simulate(scenario)
    if output:
        write_run(result, output)
    if as_json:
        click.echo(json.dumps(_plain(result) | {"file": str(output) if output else None}))
        return
    click.echo(str(result))
    if output:
        click.echo(str(output))


def _plain(result: Run) -> dict[str, Any]:
    """What a program wants to know of a run; times in s."""
    ended = {"outcome": result.outcome, "end_time": float(result.end_time), "words": str(result)}
    persons = {"persons": int(result.N), "out": int(result.N_out), "exit_time": result.exit_time.tolist()}
    return ended | persons | {"run_key": run_key(result.scenario), "engine": engine_of(result.scenario)}


def options_of(room: Room) -> list[click.Parameter]:
    """One option for each keyword of a room, with its type, its default and what is known about it."""
    kinds, words = {name: plain_kind(hint) for name, hint in get_type_hints(room).items()}, parameter_words(room)
    words |= {name: _with_units(*known) for name, known in PARAMETERS.items()}
    parameters = inspect.signature(room).parameters.values()
    return [_option(p.name, kinds.get(p.name, str), p.default, words.get(p.name, "")) for p in parameters]


def parameter_words(room: Room) -> dict[str, str]:
    """Meaning of each keyword: of the room's own by its docstring (numpydoc, "A, B : float" holds for both)."""
    return _described(Options, "Attributes") | _described(room, "Parameters")


def _described(thing: object, section: str) -> dict[str, str]:
    text = (inspect.getdoc(thing) or "").partition(f"{section}\n")[2].partition("\n\n")[0]
    entries = re.findall(r"^(\w+(?:, \w+)*)(?: : .*)?\n((?:[ \t]+.*\n?)+)", text, flags=re.MULTILINE)
    return {name: " ".join(words.split()) for names, words in entries for name in names.split(", ")}


def first_line(room: Room) -> str:
    """The first line of a docstring."""
    return (inspect.getdoc(room) or "").partition("\n")[0]


def _with_units(units: str, long_name: str) -> str:
    return long_name if units == "1" else f"{long_name}, {units}"


def _option(name: str, kind: type, default: Any, words: str) -> click.Option:
    flag = "--" + name.replace("_", "-")
    shared: dict[str, Any] = {"help": words, "show_default": True}
    if default is inspect.Parameter.empty:
        shared["required"] = True
    else:
        shared["default"] = default
    if kind is bool:
        return click.Option([f"{flag}/--no-{flag[2:]}", name], **shared)
    return click.Option([flag, name], type=kind, **shared)
