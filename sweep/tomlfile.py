"""A TOML file that knows on which line each of its entries stands, so that what is wrong with one is said there."""

import re
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from engine import BadInput

Key = tuple[str, ...]  # ("axes", "v_d") is v_d of [axes]


class TomlFile:
    """The entries of a file, and where they stand.

    Parameters
    ----------
    path : of the file
    kind : what it is to the user, as the message of one that cannot be read begins
    remedy : what helps if it is not there

    Attributes
    ----------
    entries : the file as nested dictionaries

    Raises
    ------
    BadInput
        If it cannot be read or is no TOML; the line is named.
    """

    def __init__(self, path: Path, kind: str, remedy: str = "name a TOML file") -> None:
        self.path = path
        try:
            self._text = path.read_text("utf-8")
            self.entries: dict[str, Any] = tomllib.loads(self._text)
        except OSError as error:
            why = (error.strerror or "refused").lower()
            raise BadInput(f"{kind} '{path}' cannot be read ({why}): {remedy}") from None
        except UnicodeDecodeError as error:
            line = 1 + error.object[: error.start].count(b"\n")
            raise BadInput(f"{path}:{line}: {kind} is no valid TOML (not UTF-8): mend it") from None
        except tomllib.TOMLDecodeError as error:
            line, why = _place(str(error), self._text)
            raise BadInput(f"{path}:{line}: {kind} is no valid TOML ({why}): mend it") from None

    def at(self, *key: str) -> str:
        """Where an entry, or else the table that it would stand in, is: "grid.toml:7"; else the file."""
        lines = lines_of(self._text)
        found = next((lines[key[:end]] for end in range(len(key), 0, -1) if key[:end] in lines), None)
        return str(self.path) if found is None else f"{self.path}:{found}"

    @contextmanager
    def blamed(self, *key: str) -> Iterator[None]:
        """Say of bad input in the block where in the file it stands."""
        try:
            yield
        except BadInput as error:
            raise BadInput(f"{self.at(*key)}: {error}") from None


def lines_of(text: str) -> dict[Key, int]:
    """The line, from 1, on which each table and entry of a valid TOML text begins.

    Statements are told apart by the parser itself: lines are gathered until they parse.
    """
    found: dict[Key, int] = {}
    table: Key = ()
    gathered: list[str] = []
    for number, line in enumerate(text.split("\n"), 1):
        gathered.append(line)
        statement = "\n".join(gathered).lstrip(" \t")
        try:
            parsed = tomllib.loads(statement)
        except tomllib.TOMLDecodeError:
            continue
        begin, gathered = number - len(gathered) + 1, []
        if statement.startswith("["):  # a header: one chain of names
            table = list(_keys(parsed))[-1]
            found.setdefault(table, begin)
        else:
            found |= {(*table, *key): begin for key in _keys(parsed) if (*table, *key) not in found}
    return found


def _keys(entries: dict[str, Any]) -> Iterator[Key]:
    """Names of all entries, tables before what they hold."""
    for name, value in entries.items():
        yield (name,)
        if isinstance(value, dict):
            yield from ((name, *rest) for rest in _keys(value))


def _place(message: str, text: str) -> tuple[int, str]:
    """Line and cause in the words of tomllib: "Expected '=' (at line 3, column 5)", "... (at end of document)"."""
    cause, _, place = message.partition(" (at ")
    line = re.match(r"line (\d+)", place)
    return (int(line[1]) if line else text.rstrip("\n").count("\n") + 1), cause
