"""Verification: everything in a store held against what was written, each finding with its remedy."""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from engine import Scenario
from sweep.grid import Grid
from sweep.schema import SCHEMA_VERSION, key_of, scenario_hash
from sweep.storage import shard
from sweep.storage.durable import is_dead, owner_of, sha256_of
from sweep.storage.manifest import Entry, Folded
from sweep.storage.runfile import read_stored, write_stored
from sweep.storage.store import CORRUPT, KEY, Store, sizes_in

RERUN = "--repair sets it aside, then sweep again"
READOPT = "--repair enters it again"


class Finding(NamedTuple):
    """Something in a store that is not as it was written."""

    path: Path
    what: str
    remedy: str
    repair: Callable[[], object] | None = None  # None where a person has to decide

    def __str__(self) -> str:
        """One line."""
        return f"{self.path}: {self.what}: {self.remedy}"


def verify(store: Store | Path | str, repair: bool = False) -> list[Finding]:
    """What is damaged, lost or foreign in a store; every byte of every run, shard and dataset is read.

    Parameters
    ----------
    repair : set damaged files aside (`.corrupt`), so that the next sweep runs their runs again; enter whole files
        again whose line in the manifest is lost; forget lines without a file; remove what dead processes left

    Returns
    -------
    Findings; those that a repair cannot end are left to a person.

    Raises
    ------
    BadInput
        If the folder is none of a store, or one of a newer jamsweep.
    """
    store = Store(store)
    store.check()
    findings = [*_runs(store), *_shards(store), *_strangers(store), *_dataset(store), *_notes(store)]
    for finding in findings if repair else []:
        if finding.repair:
            finding.repair()
    return findings


def _runs(store: Store) -> Iterator[Finding]:
    entries, sizes = store.vouched.read().entries, sizes_in(store.runs)
    folded = {e.key for name in store.vouched.shards() for e in shard.entries(store.shard(name))}
    for key, entry in entries.items():
        if f"{key}.nc" in sizes:
            yield from _run(store, entry, sizes[f"{key}.nc"])
        elif key not in folded and entry.size >= 0:
            forget = _bound(store.vouched.add, replace(entry, size=-1))
            yield Finding(store.file(key), "is missing", "sweep again, or --repair forgets it", forget)
    for name in sorted(sizes):
        if KEY.fullmatch(name.removesuffix(".nc")) and name.endswith(".nc") and name[:-3] not in entries:
            yield _unlisted(store, store.runs / name)


def _run(store: Store, entry: Entry, size: int) -> Iterator[Finding]:
    path = store.file(entry.key)
    if size != entry.size:
        what = f"has {size} bytes instead of {entry.size}" if entry.size >= 0 else "was forgotten, and is there again"
    elif sha256_of(path) != entry.sha256:
        what = "is not what was written (SHA-256 differs)"
    elif entry.schema not in (0, SCHEMA_VERSION):
        what = f"is of schema {entry.schema}, which this jamsweep ({SCHEMA_VERSION}) does not read"
    else:
        return
    yield Finding(path, what, RERUN, _bound(store.set_aside, entry.key, what))


def _unlisted(store: Store, path: Path) -> Finding:
    """A run file without a line in the manifest: torn by a crash, or lost."""
    found = identified(path)
    if found is None:
        what = "is not in the manifest, and not whole"
        return Finding(path, what, RERUN, _bound(store.set_aside, path.stem, what))
    if found[2] != SCHEMA_VERSION:
        what = f"is not in the manifest, and of schema {found[2]}"
        return Finding(path, what, RERUN, _bound(store.set_aside, path.stem, what))
    return Finding(path, "is whole, but not in the manifest", READOPT, _bound(store.enter, path, 0.0, *found))


def identified(path: Path) -> tuple[str, str, int] | None:
    """Hash of the scenario, engine and schema of a run file that proves itself whole; None for one that does not.

    It is whole if all checksums of netCDF hold, its scenario, schema and engine make the key that it is named after,
    and what it holds, written anew, gives the same bytes.
    """
    try:
        run = read_stored(path)
        about = run.attributes
        canonical = Scenario.from_json(about["scenario"]).canonical()
        engine, schema = str(about["engine_fingerprint"]), int(about["schema_version"])
        named = key_of(canonical, schema, engine) == about["run_key"] == path.stem
        with tempfile.TemporaryDirectory() as folder:
            write_stored(run, Path(folder) / path.name)
            same = (Path(folder) / path.name).read_bytes() == path.read_bytes()
    except shard.UNREADABLE:
        return None
    return (scenario_hash(canonical), engine, schema) if named and same and about["complete"] == 1 else None


def _shards(store: Store) -> Iterator[Finding]:
    known, sizes = store.vouched.shards(), sizes_in(store.shards)
    for name, folded in known.items():
        path = store.shard(name)
        if path.name not in sizes:
            if folded.runs > 0:
                forget = _bound(store.vouched.add_shard, folded._replace(runs=0))
                yield Finding(
                    path, f"is missing, with {folded.runs} runs", "sweep again, or --repair forgets it", forget
                )
        elif sha256_of(path) != folded.sha256:
            what = f"is not what was written (SHA-256 differs), with {folded.runs} runs"
            yield Finding(path, what, RERUN, _bound(store.set_shard_aside, name, what))
    for name in sorted(sizes):
        if name.endswith(".nc") and name.removesuffix(".nc") not in known:
            yield _unlisted_shard(store, store.shards / name)


def _unlisted_shard(store: Store, path: Path) -> Finding:
    runs = shard.entries(path)
    if runs and _each_unfolds(path, runs):
        line = Folded(path.stem, path.stat().st_size, sha256_of(path), len(runs))
        what = f"is whole, with {len(runs)} runs, but not listed"
        return Finding(path, what, READOPT, _bound(store.vouched.add_shard, line))
    what = "is not listed, and not whole"
    return Finding(path, what, RERUN, _bound(store.set_shard_aside, path.stem, what))


def _each_unfolds(path: Path, runs: list[Entry]) -> bool:
    """Whether every run of a shard gives the file that it was folded from, byte for byte."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            for row, entry in enumerate(runs):
                target = Path(folder) / f"{entry.key}.nc"
                shard.unfold_to(path, row, target)
                if sha256_of(target) != entry.sha256:
                    return False
                target.unlink()
    except shard.UNREADABLE:
        return False
    return True


def _strangers(store: Store) -> Iterator[Finding]:
    for folder, ending in ((store.runs, ".nc"), (store.failed, ".txt")):
        for name in sorted(sizes_in(folder)):
            base = name.removesuffix(".txt").removesuffix(CORRUPT) if CORRUPT in name else name
            ours = KEY.fullmatch(base.removesuffix(ending)) and base.endswith(ending)
            if not ours and not name.endswith(".tmp"):
                yield Finding(folder / name, "is no file of jamsweep", "move it elsewhere")
    for path in store.temporaries():
        owner = owner_of(path)
        if owner is None:
            yield Finding(path, "is a temporary of an unknown owner", "delete it if nothing is running")
        elif is_dead(owner):
            what = f"is what process {owner[1]} left, which ended"
            yield Finding(path, what, "the next sweep, or --repair, removes it", _bound(_remove, path))


def _dataset(store: Store) -> Iterator[Finding]:
    path = store.dataset
    if path.is_file() and sha256_of(path) not in store.vouched.datasets():
        aside = path.with_name(path.name + CORRUPT)
        yield Finding(
            path, "is not what was written", "--repair sets it aside, then gather again", _bound(_move, path, aside)
        )


def _notes(store: Store) -> Iterator[Finding]:
    if store.grid.is_file():
        try:
            Grid.from_json(store.grid.read_text("utf-8"))
        except (KeyError, TypeError, UnicodeDecodeError):
            damaged = True
        except ValueError as error:  # a room of one's own is no damage
            damaged = "is not known" not in str(error)
        else:
            damaged = False
        if damaged:
            yield Finding(store.grid, "does not describe a grid", "sweep again, which writes it anew")


def _bound(function: Callable[..., object], *arguments: object) -> Callable[[], object]:
    return lambda: function(*arguments)


def _remove(path: Path) -> None:
    path.unlink(missing_ok=True)


def _move(path: Path, target: Path) -> None:
    with suppress(FileNotFoundError):
        path.replace(target)
