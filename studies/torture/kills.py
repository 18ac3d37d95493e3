"""kill -9 at random moments, to workers and then to whole sweeps, over and over one grid.

After the last resume every file must be that of an undisturbed sweep, byte for byte; what was finished at a kill must
still be there; and of a killed sweep no process may be left.
"""

import os
import random
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import psutil
import xarray as xr

from sweep import Grid, Store, open_results, sweep

GRACE = 10.0  # s, for the processes of a killed sweep to end
PATIENCE = 600.0  # s, for a sweep to come to its end
LONGEST = 4.0  # s between two kills
ROUNDS = 20
JOBS = 2
CONSTANTS = {"N": 8, "size": 4.0, "accuracy": "0.1mm", "time_limit": 4.0}  # tenths of a second a run


def main(quick: bool) -> list[str]:
    """Kill, resume, compare; returns what went wrong."""
    kills, runs = (8, 40) if quick else (100, 600)
    chance, problems, done, rounds = random.Random(1), [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        undisturbed = Path(folder) / "undisturbed"
        sweep(_grid(runs), undisturbed, jobs=JOBS, progress=False)
        while done < kills and rounds < ROUNDS:
            rounds += 1
            disturbed = _Disturbed(Path(folder), f"round{rounds}", runs, chance)
            done += disturbed.kill_workers(-(-(kills - done) // 2)) if done < kills / 2 else 0
            done += disturbed.kill_sweeps(kills - done)
            disturbed.finish()
            problems += disturbed.problems + _differences(undisturbed, disturbed.store.path)
    if done < kills:
        problems.append(f"the sweeps ended before {kills} kills: {done}")
    print(f"kills: {done} in {rounds} sweep{'s' * (rounds > 1)} of {runs} runs, {len(problems)} problems", flush=True)
    return problems


class _Disturbed:
    """A sweep, as a command, that is killed and resumed."""

    def __init__(self, folder: Path, name: str, runs: int, chance: random.Random) -> None:
        self.store, self.problems, self._chance = Store(folder / name), list[str](), chance
        self._toml, self._log = folder / f"{name}.toml", folder / f"{name}.log"
        constants = "\n".join(f"{key} = {value!r}" for key, value in CONSTANTS.items())
        axis = f"[axes]\nseed = {{ first = 0, last = {runs - 1}, step = 1 }}\n"
        head = f"room = 'lin_room'\nstore = '{self.store.path}'\n"
        self._toml.write_text(f"{head}{axis}[constants]\n{constants}\n", "utf-8")

    def kill_workers(self, most: int) -> int:
        """Kill workers of one sweep, until it ends or so many are dead, and then it; how many were killed."""
        process, killed = self._start(), 0
        while killed < most and self._waited(process):
            workers = _workers(process.pid)
            if workers:
                killed += _killed(self._chance.choice(workers))
        return killed + self._end(process)

    def kill_sweeps(self, most: int) -> int:
        """Kill sweeps and begin them again, until one ends or so many are dead; how many were killed."""
        killed = 0
        while killed < most:
            process = self._start()
            self._waited(process)
            if not self._end(process):
                break
            killed += 1
        return killed

    def finish(self) -> None:
        """The last resume; runs whose workers were killed twice are asked for."""
        process = self._start("--retry")
        with suppress(subprocess.TimeoutExpired):
            process.wait(PATIENCE)
        if process.returncode != 0:
            self.problems.append(f"the last resume ended with {process.returncode}: {self._log.read_text()[-500:]}")
            self._end(process)

    def _start(self, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "sweep.cli", "sweep", str(self._toml), "--jobs", str(JOBS), *options]
        with self._log.open("ab") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def _waited(self, process: subprocess.Popen[bytes]) -> bool:
        """Let a random time pass; whether the sweep still runs then."""
        with suppress(subprocess.TimeoutExpired):
            process.wait(self._chance.uniform(0.0, LONGEST))
        return process.poll() is None

    def _end(self, process: subprocess.Popen[bytes]) -> bool:
        """Kill a sweep and look at what it leaves; false if it had ended by itself."""
        finished, family = self.store.finished(), _family(process.pid)
        process.kill()
        killed = process.wait() == -signal.SIGKILL
        left = psutil.wait_procs(family, GRACE)[1]
        self.problems += [f"process {other.pid} outlived its sweep: {' '.join(other.cmdline())}" for other in left]
        after = self.store.finished()
        lost = [key for key, entry in finished.items() if key not in after or after[key].sha256 != entry.sha256]
        self.problems += [f"finished run {key} was lost" for key in lost]
        return killed


def _grid(runs: int) -> Grid:
    return Grid("lin_room", seed=range(runs), **CONSTANTS)


def _family(pid: int) -> list[psutil.Process]:
    with suppress(psutil.NoSuchProcess):
        return psutil.Process(pid).children(recursive=True)
    return []


def _workers(pid: int) -> list[int]:
    return [child.pid for child in _family(pid) if _is(child, lambda command: "popen_loky" in command)]


def _is(process: psutil.Process, what: Callable[[str], bool]) -> bool:
    with suppress(psutil.Error):
        return what(" ".join(process.cmdline()))
    return False


def _killed(pid: int) -> bool:
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)
        return True
    return False


def _differences(one: Path, other: Path) -> list[str]:
    """What differs between two stores, in bytes and in values."""
    files = [{path.name: path.read_bytes() for path in (store / "runs").glob("*.nc")} for store in (one, other)]
    names = files[0].keys() | files[1].keys()
    found = [f"{name} is another after kills" for name in sorted(names) if files[0].get(name) != files[1].get(name)]
    values = [open_results(store) for store in (one, other)]
    try:
        xr.testing.assert_equal(*values)
    except AssertionError as error:
        found.append(f"values differ after kills: {error}")
    notes = [path.name for path in (other / "failed").glob("*")]
    return found + [f"failure {name} is still noted" for name in notes]
