"""The store: a folder with one file for each run, shards of folded runs, and a manifest of those that are finished."""

import json
import os
import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path

from engine import Run
from engine.errors import require
from sweep.errors import CannotWrite, DamagedFile
from sweep.schema import SCHEMA_VERSION, engine_of, run_key, scenario_hash
from sweep.storage import shard
from sweep.storage.durable import is_dead, owner_of, refuse, replace_durably, require_writable, sha256_of
from sweep.storage.manifest import Entry, Manifest
from sweep.storage.runfile import write_run

LAYOUT = 1  # of the folder
MARKS = ("store.json", "manifest.jsonl", "grid.json")
KEY = re.compile("[0-9a-f]{64}")
CORRUPT = ".corrupt"


class Store:
    """A folder of runs: `runs/KEY.nc`, `shards/NAME.nc`, `failed/KEY.txt`, `manifest.jsonl`, `dataset.nc` and notes.

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
        self.runs, self.failed, self.shards = self.path / "runs", self.path / "failed", self.path / "shards"
        self.manifest = self.path / "manifest.jsonl"
        self.grid = self.path / "grid.json"
        self.dataset = self.path / "dataset.nc"
        self.lock = self.path / ".lock"

    # --- What it is --------------------------------------------------------------------------------------

    def check(self) -> None:
        """Refuse a folder of something else, and a store that a newer jamsweep wrote; nothing is written.

        Raises
        ------
        BadInput
            With what was found there.
        """
        if not self.path.is_dir():
            return
        names = sorted(name for name in os.listdir(self.path) if not name.startswith("."))
        ours = not names or any(name in names for name in MARKS) or _of_runs(self.runs)
        found = f"holds '{names[0]}' and no manifest" if names else ""
        require(ours, "store", f"'{self.path}'", f"is a folder of something else ({found})", "name another folder")
        self.check_version()

    def check_version(self) -> None:
        """Refuse a store that a newer jamsweep wrote.

        Raises
        ------
        BadInput
            With the versions.
        """
        layout, schema = _versions(self.path / MARKS[0])
        newer = layout > LAYOUT or schema > SCHEMA_VERSION
        written = (
            f"was written by a newer jamsweep (layout {layout}, schema {schema}; known: {LAYOUT}, {SCHEMA_VERSION})"
        )
        require(not newer, "store", f"'{self.path}'", written, "update jamsweep, or name another folder")

    def make(self) -> None:
        """Make the folders.

        Raises
        ------
        BadInput
            If they cannot be written to, or hold something else.
        """
        self.check()
        try:
            self.runs.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            refuse(self.path, "store", error)
        require_writable(self.path, "store")
        require_writable(self.runs, "store")
        if _versions(self.path / MARKS[0]) != (LAYOUT, SCHEMA_VERSION):
            about = {"made_by": "jamsweep", "layout": LAYOUT, "schema_version": SCHEMA_VERSION}
            self.note(MARKS[0], json.dumps(about))

    # --- Runs that are done ------------------------------------------------------------------------------

    def file(self, key: str) -> Path:
        """Where the run of this key is, or will be, as long as it is not folded into a shard."""
        return self.runs / f"{key}.nc"

    def shard(self, name: str) -> Path:
        """Where a shard is."""
        return self.shards / f"{name}.nc"

    @property
    def vouched(self) -> Manifest:
        """What the store vouches for, whether or not the files are there."""
        return Manifest(self.path)

    def finished(self) -> dict[str, Entry]:
        """The runs that count as done, by key: in the manifest, and with a file of the size it says."""
        entries, sizes = self.vouched.read().entries, sizes_in(self.runs)
        done: dict[str, Entry] = {}
        for name, folded in self.vouched.shards().items():
            if sizes_in_one(self.shard(name)) == folded.size:
                done |= {entry.key: entry for entry in shard.entries(self.shard(name))}
        own = entries.items()
        return done | {key: entry for key, entry in own if sizes.get(f"{key}.nc") == entry.size}

    def keep(self, run: Run, duration: float) -> None:
        """Write a run's file, then the line that makes it count; `duration` in s.

        Raises
        ------
        CannotWrite
            If the disk takes no more; no half of the run remains.
        """
        canonical, path = run.scenario.canonical(), self.file(run_key(run.scenario))
        with self.writing():
            write_run(run, path)
            self.enter(path, round(duration, 6), scenario_hash(canonical), engine_of(run.scenario), SCHEMA_VERSION)

    def enter(self, path: Path, duration: float, scenario: str, engine: str, schema: int) -> None:
        """Have the run count that a file holds, as it is."""
        when = datetime.now(UTC).isoformat(timespec="seconds")
        size, digest, key = path.stat().st_size, sha256_of(path), path.name.removesuffix(".nc")
        here = socket.gethostname(), os.getpid()
        self.vouched.add(Entry(key, size, digest, duration, *here, when, scenario, engine, schema))

    def require_whole(self, key: str) -> None:
        """Raise `DamagedFile` if a run file is not what the manifest says; without a line there, nothing is known."""
        entry = self.vouched.read().entries.get(key)
        if entry and sha256_of(self.file(key)) != entry.sha256:
            raise DamagedFile(f"run file '{self.file(key)}' is damaged: sweep again, which sets it aside")

    def set_aside(self, key: str, why: str) -> Path:
        """Put a damaged run file out of the way, as `KEY.nc.corrupt`, so that its run is run again; returns where."""
        return _put_aside(self.file(key), why)

    def set_torn_aside(self) -> list[Path]:
        """Put every run file out of the way whose size is not that which the manifest says; returns where."""
        sizes = sizes_in(self.runs)
        torn = [e for k, e in self.vouched.read().entries.items() if sizes.get(f"{k}.nc", e.size) != e.size]
        return [
            self.set_aside(entry.key, f"of {sizes[f'{entry.key}.nc']} instead of {entry.size} bytes") for entry in torn
        ]

    def set_shard_aside(self, name: str, why: str) -> Path:
        """The same for a shard, and all its runs."""
        return _put_aside(self.shard(name), why)

    # --- Notes -------------------------------------------------------------------------------------------

    def note(self, name: str, text: str) -> None:
        """Keep a text under a name; an older one is replaced.

        Raises
        ------
        CannotWrite
            If the disk takes no more.
        """
        with self.writing():
            replace_durably(self.path / name, lambda path: _write_text(path, text))

    def note_grid(self, text: str) -> None:
        """Keep which grid was swept last, as JSON."""
        self.note(self.grid.name, text)

    def note_failure(self, key: str, text: str) -> Path:
        """Keep why a run failed; returns where."""
        with self.writing():
            self.failed.mkdir(exist_ok=True)
        path = self.failed / f"{key}.txt"
        self.note(f"{self.failed.name}/{path.name}", text)
        return path

    def forget_failure(self, key: str) -> None:
        """Remove what an earlier attempt at this run left."""
        (self.failed / f"{key}.txt").unlink(missing_ok=True)

    # --- Temporaries -------------------------------------------------------------------------------------

    def temporaries(self) -> Iterator[Path]:
        """Files that are being written, or whose writing a crash cut short."""
        for folder in (self.path, self.runs, self.failed, self.shards):
            yield from (folder / name for name in sizes_in(folder) if name.endswith(".tmp"))

    def sweep_leftovers(self) -> list[Path]:
        """Remove the temporaries whose owner is known to be dead: a process of this machine that ended."""
        left = [path for path in self.temporaries() for owner in [owner_of(path)] if owner and is_dead(owner)]
        for path in left:
            path.unlink(missing_ok=True)
        return left

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Say a full disk, or one that became read-only, as `CannotWrite`."""
        try:
            yield
        except OSError as error:
            why = (error.strerror or "refused").lower()
            remedy = "make room, or give rights, and run again; finished runs are kept"
            raise CannotWrite(f"store '{self.path}' cannot be written to ({why}): {remedy}") from None


def sizes_in(folder: Path) -> dict[str, int]:
    """Name -> size in bytes of the files in a folder; none if there is no folder."""
    sizes: dict[str, int] = {}
    with suppress(FileNotFoundError), os.scandir(folder) as files:
        for file in files:
            with suppress(FileNotFoundError):  # gone since the folder was read
                if file.is_file():
                    sizes[file.name] = file.stat().st_size
    return sizes


def sizes_in_one(path: Path) -> int:
    """Size of a file in bytes, -1 if there is none."""
    try:
        return path.stat().st_size
    except FileNotFoundError:
        return -1


def _of_runs(folder: Path) -> bool:
    """Whether a folder is one of run files, perhaps without any yet."""
    names = sizes_in(folder)
    return folder.is_dir() and all(KEY.match(name.lstrip(".")) for name in names) and not _subfolders(folder)


def _subfolders(folder: Path) -> bool:
    return any(path.is_dir() for path in folder.iterdir())


def _versions(path: Path) -> tuple[int, int]:
    """Versions of layout and schema that a store says it has; zeros if it does not say."""
    try:
        about = json.loads(path.read_text("utf-8"))
        return int(about["layout"]), int(about["schema_version"])
    except (OSError, ValueError, KeyError, TypeError):
        return 0, 0


def _put_aside(path: Path, why: str) -> Path:
    aside = path.with_name(path.name + CORRUPT)
    os.replace(path, aside)
    with suppress(OSError):
        _write_text(aside.with_name(aside.name + ".txt"), why + "\n")
    return aside


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, "utf-8")


def holding(path: Path) -> Store | None:
    """The store that a path is a run file of; None if it is no such path."""
    folder = path.absolute().parent
    ours = folder.name == "runs" and KEY.fullmatch(path.stem) and (folder.parent / MARKS[1]).is_file()
    return Store(folder.parent) if ours else None
