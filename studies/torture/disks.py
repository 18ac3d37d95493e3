"""Disks that are full, turn read-only, or stand beside a clock that jumps: a clear error, and nothing lost."""

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import xarray as xr

from sweep import Grid, Store, sweep
from sweep.storage.verify import verify

ROOM = {"N": 12, "size": 4.0, "time_limit": 4.0}
FULL_AT, QUICK_FULL_AT = 40, 3  # sizes of the disk that are tried
SMALLEST, LARGEST = 120, 1200  # kB
RUN = """
import sys
from sweep import Grid, sweep
sweep(Grid.from_json(sys.argv[2]), sys.argv[1], jobs=int(sys.argv[3]), progress=False)
"""
JUMPING = """
import random, time
random.seed(7)
real = time.time
time.time = lambda: real() + random.choice([-1e9, -3600.0, 0.0, 3600.0, 1e9])
"""
LIMITED = """
import resource, signal
resource.setrlimit(resource.RLIMIT_FSIZE, ({0}, {0}))
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
"""
MAIN = """
import sys
from sweep.cli import main
main(["sweep", sys.argv[1], "--jobs", "1"])
"""


def main(quick: bool) -> list[str]:
    """Sweep on bad disks, then on good ones; returns what was lost, or was no clear error."""
    grid = Grid("lin_room", seed=range(6 if quick else 12), **ROOM)
    with tempfile.TemporaryDirectory() as folder:
        whole = sweep(grid, Path(folder) / "alone", jobs=1, progress=False)
        number = QUICK_FULL_AT if quick else FULL_AT
        sizes = [SMALLEST + (LARGEST - SMALLEST) * k // number for k in range(number)]
        parts = (_full(grid, whole, sizes), _limited(grid, whole), _read_only(grid, whole), _clock(grid, whole))
        tried = [list(part) for part in parts]
    problems = [problem for part in tried for case in part for problem in case]
    counts = ", ".join(f"{len(part)} {name}" for part, name in zip(tried, NAMES, strict=True))
    print(f"disks: {counts}: {len(problems)} problems")
    return problems


NAMES = ("full disks", "limits of a file's size", "read-only disks", "jumping clocks")


def _full(grid: Grid, whole: xr.Dataset, sizes: list[int]) -> Iterator[list[str]]:
    """A disk of each size, in kB: full in mid-write, then enlarged."""
    for size in sizes:
        with tempfile.TemporaryDirectory() as folder, _disk(Path(folder), f"size={size}k") as able:
            if not able:
                return
            store = Store(Path(folder) / "store")
            found = _stops_clearly(grid, store)
            _mount(Path(folder), "remount,size=100m")
            yield _at(f"disk of {size} kB", found + _resumes(grid, store, whole))


def _limited(grid: Grid, whole: xr.Dataset) -> Iterator[list[str]]:
    """The same without a disk of one's own: the process may not write files beyond a size."""
    for size in (100, 5_000, 40_000):
        with tempfile.TemporaryDirectory() as folder:
            store = Store(Path(folder) / "store")
            found = _stops_clearly(grid, store, LIMITED.format(size))
            yield _at(f"files of {size} bytes", found + _resumes(grid, store, whole))


def _read_only(grid: Grid, whole: xr.Dataset) -> Iterator[list[str]]:
    """A disk that is read-only from the beginning, or becomes so when half is done."""
    part = Grid("lin_room", seed=range(2), **ROOM)
    with tempfile.TemporaryDirectory() as folder, _disk(Path(folder), "size=100m") as able:
        if not able:
            return
        store = Store(Path(folder) / "store")
        sweep(part, store, jobs=1, progress=False)
        before = {path: path.read_bytes() for path in store.path.rglob("*") if path.is_file()}
        _mount(Path(folder), "remount,ro")
        found = _stops_clearly(grid, store)
        if {path: path.read_bytes() for path in store.path.rglob("*") if path.is_file()} != before:
            found.append("files changed")
        _mount(Path(folder), "remount,rw")
        yield _at("read-only disk", found + _resumes(grid, store, whole))


def _clock(grid: Grid, whole: xr.Dataset) -> Iterator[list[str]]:
    """A clock that jumps by decades both ways while a sweep runs."""
    with tempfile.TemporaryDirectory() as folder:
        store = Store(Path(folder) / "store")
        done = _python(JUMPING + RUN, str(store.path), grid.to_json(), "1")
        found = [] if done.returncode == 0 else [done.stderr[-300:]]
        yield _at("jumping clock", found + _resumes(grid, store, whole))


def _at(where: str, found: list[str]) -> list[str]:
    return [f"{where}: {problem}" for problem in found]


def _stops_clearly(grid: Grid, store: Store, before: str = "") -> list[str]:
    """Sweep by the command; a failure must be a clear line that names the store."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "grid.toml"
        constants = "\n".join(f"{name} = {value}" for name, value in grid.constants.items())
        seeds = list(grid.axes["seed"])
        path.write_text(
            f'room = "lin_room"\nstore = "{store.path}"\n[axes]\nseed = {seeds}\n[constants]\n{constants}\n'
        )
        done = _python(before + MAIN, str(path))
    last = (done.stderr.strip() or " ").splitlines()[-1]
    clear = "cannot be written to (" in done.stderr or "is not kept in" in done.stderr
    good = done.returncode in (0, 1, 2) and (not done.returncode or clear) and "Traceback" not in done.stderr
    return [] if good else [f"exit code {done.returncode}, {last}"]


def _resumes(grid: Grid, store: Store, whole: xr.Dataset) -> list[str]:
    """With room again: finished runs are still there, and the rest is run."""
    kept = {path: path.stat().st_ino for key in store.finished() for path in [store.file(key)]}
    ds = sweep(grid, store, jobs=1, progress=False)
    lost = [path.name for path, inode in kept.items() if not path.exists() or path.stat().st_ino != inode]
    found = [f"{len(lost)} finished runs were run again"] if lost else []
    found += [] if ds.equals(whole) else ["values differ from those of a good disk"]
    return found + [str(finding) for finding in verify(store)]


@contextmanager
def _disk(folder: Path, options: str) -> Iterator[bool]:
    """Mount a disk in memory, where there are the rights to; yields whether there were."""
    able = shutil.which("mount") is not None and _mount(folder, options)
    try:
        yield able
    finally:
        if able:
            subprocess.run(["umount", str(folder)], check=True)


def _mount(folder: Path, options: str) -> bool:
    return (
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], capture_output=True).returncode
        == 0
    )


def _python(code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True)


if __name__ == "__main__":
    found = main("--quick" in sys.argv)
    print("\n".join(found))
    sys.exit(bool(found))
