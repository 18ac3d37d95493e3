"""The store: a folder with one file for each run, and a manifest of the runs that are finished."""

import hashlib
import json
import os
import socket
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from engine import Run
from engine.errors import require
from sweep.durable import append_line, refuse, replace_durably, require_writable
from sweep.runfile import write_run
from sweep.schema import run_key


@dataclass(frozen=True)
class Entry:
    """A line of the manifest: a run that was finished, and what differs from machine to machine."""

    key: str
    size: int  # bytes
    sha256: str
    duration: float  # s
    host: str
    pid: int
    when: str  # UTC


class Store:
    """A folder of runs: `runs/KEY.nc`, `failed/KEY.txt`, `manifest.jsonl`, `grid.json`, `dataset.nc`.

    Parameters
    ----------
    path : the folder; it is made when the first run is written

    Raises
    ------
    BadInput
        If the path is a file.
    """

    def __init__(self, path: "Path | str | Store") -> None:
        named = isinstance(path, Store | Path) or (isinstance(path, str) and path != "" and "\0" not in path)
        require(named, "store", repr(path), "is not the name of a folder", "name a folder, or one to be made")
        self.path: Path = path.path if isinstance(path, Store) else Path(path).expanduser()
        folder = self.path.is_dir() or not self.path.exists()
        require(folder, "store", f"'{self.path}'", "is not a folder", "name a folder, or one to be made")
        self.runs, self.failed = self.path / "runs", self.path / "failed"
        self.manifest = self.path / "manifest.jsonl"
        self.grid = self.path / "grid.json"
        self.dataset = self.path / "dataset.nc"

    def make(self) -> None:
        """Make the folders.

        Raises
        ------
        BadInput
            If they cannot be written to.
        """
        try:
            self.runs.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            refuse(self.path, "store", error)
        require_writable(self.path, "store")
        require_writable(self.runs, "store")

    def file(self, key: str) -> Path:
        """Where the run of this key is, or will be."""
        return self.runs / f"{key}.nc"

    def finished(self) -> dict[str, Entry]:
        """The runs that count as done, by key: in the manifest, and with a file of the size it says."""
        return {key: entry for key, entry in self._entries().items() if _size(self.file(key)) == entry.size}

    def keep(self, run: Run, duration: float) -> None:
        """Write a run's file, then the line that makes it count; `duration` in s."""
        key = run_key(run.scenario)
        path = self.file(key)
        write_run(run, path)
        written = path.read_bytes()
        when = datetime.now(UTC).isoformat(timespec="seconds")
        digest = hashlib.sha256(written).hexdigest()
        entry = Entry(key, len(written), digest, round(duration, 6), socket.gethostname(), os.getpid(), when)
        append_line(self.manifest, json.dumps(asdict(entry)))

    def note_grid(self, text: str) -> None:
        """Keep which grid was swept last, as JSON."""
        replace_durably(self.grid, lambda path: _write_text(path, text))

    def note_failure(self, key: str, text: str) -> Path:
        """Keep why a run failed; returns where."""
        self.failed.mkdir(exist_ok=True)
        path = self.failed / f"{key}.txt"
        replace_durably(path, lambda temporary: _write_text(temporary, text))
        return path

    def forget_failure(self, key: str) -> None:
        """Remove what an earlier attempt at this run left."""
        (self.failed / f"{key}.txt").unlink(missing_ok=True)

    def _entries(self) -> dict[str, Entry]:
        if not self.manifest.exists():
            return {}
        lines = self.manifest.read_text("utf-8", errors="replace").splitlines()
        return {entry.key: entry for entry in map(_entry, lines) if entry}


def _entry(line: str) -> Entry | None:
    try:
        entry = Entry(**json.loads(line))
    except (ValueError, TypeError):  # torn by a crash: its run does not count
        return None
    return entry if isinstance(entry.key, str) else None


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except FileNotFoundError:
        return -1


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, "utf-8")
