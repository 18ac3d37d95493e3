"""What a store vouches for: runs that were finished, shards, gathered datasets.

A line of JSON each, in `manifest.jsonl`, `shards.jsonl` and `datasets.jsonl`. Lines are added, and those of runs are
dropped when a shard has them.
"""

import json
from collections.abc import Container, Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple

from sweep.storage.durable import append_line, rewrite_lines


@dataclass(frozen=True, slots=True)
class Entry:
    """A run that was finished, and what differs from machine to machine."""

    key: str
    size: int  # bytes
    sha256: str
    duration: float  # s
    host: str
    pid: int
    when: str  # UTC; for people, nothing is decided by it
    scenario: str = ""  # hash of what was run, whatever the engine
    engine: str = ""  # fingerprint
    schema: int = 0
    shard: str = ""  # name of the shard that holds it, "" for a file of its own


class Folded(NamedTuple):
    """A shard: several runs in one file."""

    shard: str  # its name
    size: int  # bytes
    sha256: str
    runs: int


class Lines(NamedTuple):
    """What a manifest says; later lines override earlier ones."""

    entries: dict[str, Entry]  # by key
    torn: list[int]  # numbers of lines that say nothing, from 1


NAMES = frozenset(field.name for field in fields(Entry))
NEEDED: dict[str, Any] = {"key": str, "size": int, "sha256": str, "duration": (int, float)}


class Manifest:
    """The lines of a store.

    Parameters
    ----------
    folder : that of the store
    """

    def __init__(self, folder: Path) -> None:
        self.runs, self._shards, self._datasets = (folder / f"{n}.jsonl" for n in ("manifest", "shards", "datasets"))

    def read(self) -> Lines:
        """The runs that have a file of their own, as far as lines are whole."""
        lines = Lines({}, [])
        for number, parts in _lines(self.runs):
            entry = _entry(parts)
            if entry:
                lines.entries[entry.key] = entry
            else:
                lines.torn.append(number)
        return lines

    def shards(self) -> dict[str, Folded]:
        """The shards, by name."""
        found: dict[str, Folded] = {}
        for _, parts in _lines(self._shards):
            with suppress(KeyError, ValueError, TypeError):
                shard = Folded(str(parts["shard"]), int(parts["size"]), str(parts["sha256"]), int(parts["runs"]))
                found[shard.shard] = shard
        return found

    def datasets(self) -> dict[str, str]:
        """SHA-256 of each gathered dataset that was written -> what it was made of."""
        whole = (parts for _, parts in _lines(self._datasets) if {"dataset", "content"} <= parts.keys())
        return {str(parts["dataset"]): str(parts["content"]) for parts in whole}

    def add(self, entry: Entry) -> None:
        """Have a run count as finished."""
        append_line(self.runs, json.dumps({name: value for name, value in asdict(entry).items() if value != ""}))

    def drop(self, keys: Container[str]) -> None:
        """Remove the lines of runs that are in a shard."""
        rewrite_lines(self.runs, lambda line: _parsed(line).get("key") not in keys)

    def add_shard(self, shard: Folded) -> None:
        """Have the runs of a shard count as finished."""
        append_line(self._shards, json.dumps(shard._asdict()))

    def add_dataset(self, sha256: str, content: str) -> None:
        """Vouch for a gathered dataset, and say what it was made of."""
        append_line(self._datasets, json.dumps({"dataset": sha256, "content": content}))


def _lines(path: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """Number of each line, from 1, and what it says: nothing, if a crash tore it."""
    try:
        text = path.read_text("utf-8", errors="replace")
    except FileNotFoundError:
        return
    for number, line in enumerate(text.split("\n"), 1):
        if line:
            yield number, _parsed(line)


def _parsed(line: str) -> dict[str, Any]:
    try:
        parts = json.loads(line)
    except ValueError:
        return {}
    return parts if isinstance(parts, dict) else {}


def _entry(parts: dict[str, Any]) -> Entry | None:
    try:
        entry = Entry(**(parts if parts.keys() <= NAMES else {n: parts[n] for n in NAMES & parts.keys()}))
    except TypeError:
        return None
    good = all(isinstance(getattr(entry, name), kind) for name, kind in NEEDED.items())
    return entry if good else None
