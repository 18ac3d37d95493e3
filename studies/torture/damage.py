"""Damage: truncated files and flipped bits; all must be found, none served."""

import io
import random
import shutil
import sys
import tempfile
from collections.abc import Callable
from contextlib import redirect_stderr
from pathlib import Path

import xarray as xr

from sweep import Grid, Store, gather, sweep
from sweep.storage.compact import compact
from sweep.storage.verify import identified, verify

GRID = Grid("lin_room", v_d=[1.0, 1.4], seed=range(2), N=12, size=4.0, time_limit=4.0, record_every=0.5, contacts=True)
TRUNCATIONS, FLIPS = 50, 200
QUICK_TRUNCATIONS, QUICK_FLIPS = 4, 12
SEED = 20161
KINDS = ("run", "unlisted run", "dataset", "shard")  # the last one folds the runs


def main(quick: bool) -> list[str]:
    """Damage one file of a store again and again; returns what was not found, or was served."""
    random.seed(SEED)
    truncations, flips = (QUICK_TRUNCATIONS, QUICK_FLIPS) if quick else (TRUNCATIONS, FLIPS)
    problems: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        store = Store(Path(folder) / "store")
        whole = sweep(GRID, store, jobs=1, progress=False)
        for kind in KINDS:
            if kind == "shard":
                compact(store)
            victim = _victim(store, kind)
            for spoil in (*[_truncated] * truncations, *[_flipped] * flips):
                with redirect_stderr(io.StringIO()):  # a thousand lines that say what was found
                    problems += _tried(store, victim, kind, spoil, whole)
    tried = f"{truncations} truncations and {flips} flipped bits each of {', '.join(KINDS)}"
    print(f"damage: {tried}: {len(problems)} not found or served")
    return problems


def _victim(store: Store, kind: str) -> Path:
    if kind == "dataset":
        return store.dataset
    return next(iter(sorted((store.shards if kind == "shard" else store.runs).glob("*.nc"))))


def _tried(store: Store, victim: Path, kind: str, spoil: Callable[[bytes], bytes], whole: xr.Dataset) -> list[str]:
    """Spoil a copy of the store and look whether anybody notices."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Store(Path(folder) / "store")
        shutil.copytree(store.path, copy.path)
        path = copy.path / victim.relative_to(store.path)
        spoilt = spoil(path.read_bytes())
        path.write_bytes(spoilt)
        how = f"{kind} {victim.name[:8]}: {len(spoilt)} of {victim.stat().st_size} bytes, {_difference(victim, spoilt)}"
        if kind == "unlisted run":
            (copy.path / "manifest.jsonl").write_text("")
            return [f"{how}: taken for whole"] if identified(path) else []
        found = [finding for finding in verify(copy) if finding.path == path]
        if kind != "dataset":
            copy.dataset.unlink()
        served = gather(GRID, copy)
        problems = [] if found else [f"{how}: not found by verify"]
        wrong = [] if _right(served, whole) else [f"{how}: served by gather"]
        return problems + wrong


def _right(served: xr.Dataset, whole: xr.Dataset) -> bool:
    """Whether every value is missing or as it should be."""
    there = served.outcome > 0
    return served.where(there).equals(whole.isel(exit=slice(served.sizes["exit"])).where(there))


def _truncated(content: bytes) -> bytes:
    return content[: random.randrange(len(content))]


def _flipped(content: bytes) -> bytes:
    place, bit = random.randrange(len(content)), random.randrange(8)
    return content[:place] + bytes([content[place] ^ (1 << bit)]) + content[place + 1 :]


def _difference(victim: Path, spoilt: bytes) -> str:
    whole = victim.read_bytes()
    return next(
        (f"bit of byte {k} flipped" for k, (a, b) in enumerate(zip(whole, spoilt, strict=False)) if a != b), "cut"
    )


if __name__ == "__main__":
    lost = main("--quick" in sys.argv)
    print("\n".join(lost))
    sys.exit(bool(lost))
