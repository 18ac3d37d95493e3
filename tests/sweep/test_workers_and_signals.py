"""Ctrl-C, and kill -9 of a whole sweep."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil
import pytest

from engine import rooms
from sweep import Store

ROOT = Path(rooms.__file__).parents[1]
SECONDS = {"time_limit": "[0.1, 0.2, 6.0, 6.1, 6.2]", "dt": "1e-5"}  # two of milliseconds, three of about a second
ENDLESS = {"time_limit": "[0.1, 0.2, 1e6, 2e6, 3e6]", "dt": "1e-5"}  # two of milliseconds, three of minutes


@contextmanager
def command(folder: Path, runs: dict[str, str]) -> Iterator[subprocess.Popen]:
    """A sweep on two workers, in a process group of its own."""
    toml = folder / "grid.toml"
    toml.write_text(
        f'room = "lin_room"\nstore = "{folder / "results"}"\n[axes]\ntime_limit = {runs["time_limit"]}\n'
        f"[constants]\nN = 5\nsize = 4\nv_d = 0.001\nblocked_after = 1e6\ndt = {runs['dt']}\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-m", "sweep.cli", "sweep", toml, "--jobs", "2"],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        start_new_session=True,
    )
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def eventually(what: str, holds: Callable[[], bool], seconds: float = 120.0) -> None:
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"{what}: not after {seconds:g} s"
        time.sleep(0.05)


def kept(folder: Path) -> int:
    return len(Store(folder / "results").finished())


def workers(process: subprocess.Popen) -> list[psutil.Process]:
    children = psutil.Process(process.pid).children(recursive=True)
    return [child for child in children if "popen_loky" in " ".join(_command(child))]


def _command(process: psutil.Process) -> list[str]:
    try:
        return process.cmdline()
    except psutil.Error:  # it has ended
        return []


def said_until(process: subprocess.Popen, words: str) -> str:
    """What a process says up to a line with these words, that included."""
    said = ""
    for line in process.stderr:
        said += line
        if words in line:
            return said
    raise AssertionError(f"never said '{words}' but {said}")


def test_the_first_ctrl_c_lets_the_runs_under_way_finish(tmp_path: Path) -> None:
    with command(tmp_path, SECONDS) as process:
        eventually("two runs kept", lambda: kept(tmp_path) == 2)
        os.killpg(process.pid, signal.SIGINT)
        said = process.communicate(timeout=120)[1]
    assert process.returncode == 130
    assert "stopping: runs under way are finished, Ctrl-C again ends them; then run again to resume" in said
    assert f"interrupted: {kept(tmp_path)} of 5 runs are kept, run again to resume" in said.splitlines()
    assert kept(tmp_path) in (3, 4), "nothing under way was finished, or more begun"
    assert "Traceback" not in said


def test_ctrl_c_while_workers_start_disturbs_none_of_them(tmp_path: Path) -> None:
    with command(tmp_path, SECONDS) as process:
        eventually("two workers", lambda: len(workers(process)) == 2)
        for _ in range(5):
            time.sleep(0.2)
            os.kill(workers(process)[0].pid, signal.SIGINT)
            os.kill(workers(process)[-1].pid, signal.SIGINT)
        said = process.communicate(timeout=120)[1]
    assert process.returncode == 0
    assert "Traceback" not in said
    assert kept(tmp_path) == 5


def test_the_second_ctrl_c_stops_at_once_and_keeps_finished_runs(tmp_path: Path) -> None:
    with command(tmp_path, ENDLESS) as process:
        eventually("two runs kept", lambda: kept(tmp_path) == 2)
        os.killpg(process.pid, signal.SIGINT)
        said = said_until(process, "stopping: ")
        os.killpg(process.pid, signal.SIGINT)
        said += process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert "interrupted: 2 of 5 runs are kept, run again to resume" in said.splitlines()
    assert kept(tmp_path) == 2
    assert "Traceback" not in said


def test_workers_end_with_a_killed_sweep(tmp_path: Path) -> None:
    with command(tmp_path, ENDLESS) as process:
        eventually("two runs kept", lambda: kept(tmp_path) == 2)
        eventually("two workers", lambda: len(workers(process)) == 2)
        family = psutil.Process(process.pid).children(recursive=True)
        process.kill()
        left = psutil.wait_procs(family, timeout=20)[1]
        assert not left
    assert kept(tmp_path) == 2


def test_a_killed_worker_costs_neither_the_other_runs_nor_the_sweep(tmp_path: Path) -> None:
    with command(tmp_path, ENDLESS) as process:
        eventually("two runs kept", lambda: kept(tmp_path) == 2)
        eventually("two workers", lambda: len(workers(process)) == 2)
        victim, other = workers(process)
        victim.kill()
        eventually("another worker", lambda: len(set(workers(process)) - {victim}) == 2)
        assert other.is_running()
        assert process.poll() is None


@pytest.mark.parametrize("platform", ["linux", "another"])
def test_a_worker_in_a_compiled_loop_notices_that_its_parent_is_gone(platform: str) -> None:
    """On Linux the kernel ends it; elsewhere, as if here, a thread of its own does."""
    child = (
        "import os, sys\n"
        "from sweep.running.attached import end_with\n"
        "from engine import rooms, simulate\n"
        f"sys.platform = '{platform}'; end_with(os.getppid())\n"
        "print(os.getpid(), flush=True)\n"
        "simulate(rooms.lin_room(N=5, size=4.0, v_d=0.001, blocked_after=1e6, time_limit=1e6, dt=1e-5))\n"
    )
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    process = subprocess.Popen([sys.executable, "-c", parent], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    worker = psutil.Process(int(process.stdout.readline()))
    try:
        eventually("at work", lambda: worker.cpu_times().user > 1.0)
        process.kill()
        process.communicate()
        assert not psutil.wait_procs([worker], timeout=20)[1]
    finally:
        with suppress(psutil.NoSuchProcess):
            worker.kill()
