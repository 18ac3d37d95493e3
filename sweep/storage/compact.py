"""Compaction: finished runs folded into shards, so that a million runs are not a million files."""

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from engine.errors import require
from sweep.errors import DamagedFile, SweepStopped
from sweep.report import tell
from sweep.storage import shard
from sweep.storage.durable import locked, replace_durably, sha256_of
from sweep.storage.manifest import Entry, Folded
from sweep.storage.runfile import Stored, read_stored
from sweep.storage.store import Store

MOST_RUNS, MOST_BYTES = 1000, 2**28  # of one shard: what memory holds a few times over


class Compacted(NamedTuple):
    """What a compaction did."""

    runs: int
    shards: int
    before: int  # bytes of the run files
    after: int  # bytes of the shards


def compact(store: Store | Path | str, most_runs: int = MOST_RUNS) -> Compacted:
    """Fold the finished runs that have files of their own into shards, and remove those files.

    At any moment each run is whole in its file or in a shard that counts, or in both. A shard is read back and
    compared, value by value, before it counts. Sweeps may go on meanwhile.

    Parameters
    ----------
    most_runs : of one shard

    Raises
    ------
    BadInput
        If the folder is none of a store.
    SweepStopped
        If another compaction of this store is under way.
    CannotWrite
        If the disk is full.
    """
    require(isinstance(most_runs, int) and most_runs > 0, "most_runs", most_runs, "is no number of runs", "give one")
    store = Store(store)
    store.check()
    require(store.path.is_dir(), "store", f"'{store.path}'", "does not exist", "name the folder of a sweep")
    done = Compacted(0, 0, 0, 0)
    with store.writing(), locked(store.lock) as ours:
        if not ours:
            raise SweepStopped(f"store '{store.path}' is being compacted by another process: wait for it")
        _remove_doubles(store)
        for batch in _batches(store, most_runs):
            before, after = sum(entry.size for entry, _ in batch), _fold(store, batch)
            done = Compacted(done.runs + len(batch), done.shards + 1, done.before + before, done.after + after)
    return done


Batch = list[tuple[Entry, Stored]]


def _batches(store: Store, most_runs: int) -> Iterator[Batch]:
    """Finished runs with a file of their own, those of one layout together."""
    waiting: dict[shard.Layout, Batch] = {}
    for entry in [entry for entry in store.finished().values() if not entry.shard]:
        run = _whole(store, entry)
        if run is None:
            continue
        batch = waiting.setdefault(shard.layout_of(run), [])
        batch.append((entry, run))
        if len(batch) == most_runs or sum(map(_size, batch)) > MOST_BYTES:
            yield waiting.pop(shard.layout_of(run))
    yield from waiting.values()


def _size(member: tuple[Entry, Stored]) -> int:
    return sum(values.nbytes for _, values in member[1].variables)


def _whole(store: Store, entry: Entry) -> Stored | None:
    """What a run file holds; None for a damaged one, which is set aside."""
    path = store.file(entry.key)
    try:
        if sha256_of(path) == entry.sha256:
            return read_stored(path)
    except FileNotFoundError:
        return None
    except shard.UNREADABLE:  # of another schema
        return None
    store.set_aside(entry.key, "met by compaction: SHA-256 differs")
    tell(f"run file '{path}' is damaged; set aside as {path.name}.corrupt, a sweep runs it again")
    return None


def _fold(store: Store, batch: Batch) -> int:
    """Make a shard of runs and remove their files; returns its size."""
    entries, runs = [entry for entry, _ in batch], [run for _, run in batch]
    name = hashlib.sha256("".join(entry.sha256 for entry in entries).encode()).hexdigest()[:32]
    path = store.shard(name)
    store.shards.mkdir(exist_ok=True)
    replace_durably(path, lambda temporary: _write(temporary, runs, entries))
    size = path.stat().st_size
    store.vouched.add_shard(Folded(name, size, sha256_of(path), len(runs)))
    _remove(store, {entry.key for entry in entries})
    return size


def _write(path: Path, runs: list[Stored], entries: list[Entry]) -> None:
    shard.write(runs, entries, path)
    for row, (run, again) in enumerate(zip(runs, shard.unfold_all(path), strict=True)):
        if not _equal(run, again):
            raise DamagedFile(f"shard '{path}' does not hold what run {entries[row].key} does: nothing was removed")


def _equal(run: Stored, other: Stored) -> bool:
    attributes = list(run.attributes.items()) == list(other.attributes.items())
    pairs = zip(run.variables, other.variables, strict=True)
    return attributes and all(v.name == w.name and _same(x, y) for (v, x), (w, y) in pairs)


def _same(x: np.ndarray, y: np.ndarray) -> bool:
    """Whether type, shape and every bit are the same: nan and the sign of 0 as well."""
    return x.dtype == y.dtype and x.shape == y.shape and x.tobytes() == y.tobytes()


def _remove_doubles(store: Store) -> None:
    """Remove run files that are in a shard as well: a compaction was cut short."""
    own = store.vouched.read().entries
    doubles: set[str] = set()
    for name, folded in store.vouched.shards().items():
        path = store.shard(name)
        try:
            shard.require_whole(path, folded)
        except DamagedFile:
            continue
        folded_runs = shard.entries(path)
        doubles |= {e.key for e in folded_runs if e.key in own and own[e.key].sha256 == e.sha256}
    if doubles:
        _remove(store, doubles)


def _remove(store: Store, keys: set[str]) -> None:
    """Remove the files and then the lines of runs that are in a shard that counts."""
    for key in keys:
        store.file(key).unlink(missing_ok=True)
    store.vouched.drop(keys)
