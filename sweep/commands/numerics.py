"""`jamsweep check-numerics`: whether the physics of a room depends on the time step."""

from typing import Any

import click

from engine.errors import require
from sweep.commands.run import RoomCommands, first_line, options_of
from sweep.numerics import FINER, Comparison, compare_steps
from sweep.rooms import Room

MARGIN = 0.02
FAILED = 1  # exit code
SET = {"seed", "time_limit"}  # keywords of a room that the check sets
VERDICTS = {"yes": "the same within 2 %", "NO": "DIFFERENT", "open": "not decided: give more --seeds"}


def _command(name: str, room: Room) -> click.Command:
    def check(seeds: int, jobs: int, duration: float, **parameters: Any) -> None:
        _check(room, seeds, jobs, duration, parameters)

    own = [option for option in options_of(room) if option.name not in SET]
    more = [
        click.Option(["--seeds"], type=int, default=120, show_default=True, help="Runs at each step."),
        click.Option(["--jobs"], type=int, default=2, show_default=True, help="Worker processes."),
        click.Option(["--duration"], type=float, default=60.0, show_default=True, help="Time that is simulated, s."),
    ]
    words = f"{first_line(room)}\n\n\b\njamsweep check-numerics {name} --v-d 1.6 --N 100"
    return click.Command(name, params=[*more, *own], callback=check, help=words, short_help=first_line(room))


@click.group(cls=RoomCommands, command_of=_command)
def check_numerics() -> None:
    """Compare the friction of a jam at the time step of a room with that at a quarter of it.

    If the two differ by more than 2 %, the time step decides about the results: choose a shorter one, or a law whose
    friction does not depend on it. Exit code 1 where they differ, 0 else.

    \b
    jamsweep check-numerics lin_room --v-d 1.6 --N 100
    jamsweep check-numerics my_rooms.py:my_room --accuracy 1mm
    """  # noqa: D301  click reads \b as a character


def _check(room: Room, seeds: int, jobs: int, duration: float, parameters: dict[str, Any]) -> None:
    require(seeds > 1, "seeds", seeds, "leave no interval", "give 2 or more")
    require(jobs > 0, "jobs", jobs, "is not a whole number above 0", "give the number of worker processes")
    scenarios = [room(seed=seed, time_limit=duration, **parameters) for seed in range(seeds)]
    dt = scenarios[0].numerics.dt
    click.echo(f"{seeds} runs of {duration:g} s at {dt:g} s and at {dt / FINER:g} s")
    found = compare_steps(scenarios, jobs)
    for comparison in found:
        click.echo(_sentence(comparison))
    if any(comparison.verdict(MARGIN) == "NO" for comparison in found):
        raise click.exceptions.Exit(FAILED)


def _sentence(c: Comparison) -> str:
    verdict = c.verdict(MARGIN)
    if verdict not in VERDICTS:
        return f"between {c.between}, {c.quantity}: {verdict}"
    values = f"{c.coarse:.4f} and {c.fine:.4f}, {c.difference:+.1%} [{c.low:+.1%}, {c.high:+.1%}]"
    return f"between {c.between}, {c.quantity}: {values}: {VERDICTS[verdict]}"
