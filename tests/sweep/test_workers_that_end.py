"""A worker that ends, or is ended, costs its own run and nothing else."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest
import xarray as xr

from engine import BadInput, rooms
from sweep import Grid, Store, SweepStopped, sweep
from sweep.running import slot
from sweep.running.attached import PINNED
from sweep.running.limits import Limits
from sweep.running.slot import Job, Slot
from sweep.running.worker import Done, Failed, Result, work
from sweep.schema import run_key
from tests.sweep import deadly
from tests.sweep.tiny import TINY, run_files


@pytest.fixture
def own() -> Iterator[Slot]:
    here = Slot()
    yield here
    here.close()


@pytest.fixture
def job(store: Path) -> Job:
    Store(store).make()
    scenario = rooms.lin_room(**TINY)
    return Job(run_key(scenario), scenario, str(store))


@pytest.fixture
def goes(monkeypatch: pytest.MonkeyPatch) -> Callable[[object], None]:
    return lambda how: monkeypatch.setattr(slot, "work", how)


def test_a_run_whose_worker_is_killed_is_tried_once_more(own: Slot, job: Job, goes: Callable) -> None:
    goes(deadly.killed_once)
    assert isinstance(own.run(job), Done)
    assert set(Store(job.store).finished()) == {job.key}


def test_a_run_that_was_kept_before_its_worker_died_is_not_run_again(own: Slot, job: Job, goes: Callable) -> None:
    goes(deadly.killed_after_keeping)
    assert isinstance(own.run(job), Done)
    assert (Path(job.store) / "attempts").read_text() == "x"


def test_a_crash_is_named_and_leaves_its_stack(own: Slot, job: Job, goes: Callable) -> None:
    goes(deadly.segfault)
    result = own.run(job)
    assert isinstance(result, Failed)
    assert result.error.startswith("set aside: 2 workers ended in this run, the last one by SIGSEGV")
    assert "string_at" in result.traceback
    goes(work)
    assert isinstance(own.run(job), Done), "the slot is of no use after a crash"


def test_a_time_out_ends_a_compiled_loop_and_says_where_it_was(own: Slot, job: Job, goes: Callable) -> None:
    goes(deadly.hang)
    result = own.run(job._replace(limits=Limits(timeout=4.0)))
    assert isinstance(result, Failed)
    assert result.error == "timed out after 4 s"
    assert "in hang" in result.traceback


def test_a_worker_beyond_its_memory_is_ended(own: Slot, job: Job, goes: Callable) -> None:
    goes(deadly.hog)
    result = own.run(job._replace(limits=Limits(memory=9e8)))
    assert isinstance(result, Failed)
    assert result.error.startswith("set aside: ")
    assert "for memory: " in result.error
    assert "above the limit of 900 MB" in result.error


def test_a_memory_limit_that_no_worker_keeps_is_refused(own: Slot, job: Job) -> None:
    with pytest.raises(BadInput, match=r"memory_limit 50 MB leaves no room for a worker, which takes \d+ MB"):
        own.run(job._replace(limits=Limits(memory=5e7)))


def test_a_worker_that_joins_later_and_does_not_see_the_store_says_so(own: Slot, job: Job) -> None:
    with pytest.raises(BadInput, match=r"store .* is not seen by the worker on \S+: put it on a file system that all"):
        own.run(job._replace(token="runs/.seen.elsewhere.1.abcd.tmp"))


def test_a_stopped_slot_starts_no_worker(own: Slot, job: Job) -> None:
    own.stop()
    with pytest.raises(SweepStopped):
        own.run(job)


def test_a_worker_has_one_thread(own: Slot, job: Job, goes: Callable) -> None:
    goes(environment)
    said = own.run(job)
    assert isinstance(said, Failed)
    assert said.error == str(dict.fromkeys(PINNED, "1"))
    assert said.traceback != str(os.getpid())


def environment(scenario: object, store: str, key: str) -> Result:
    """The environment of a worker, and its process id."""
    return Failed(key, str({name: os.environ[name] for name in PINNED}), str(os.getpid()))


def test_a_run_that_ends_its_workers_is_set_aside_until_it_is_asked_for(
    store: Path, tmp_path: Path, goes: Callable, capsys: pytest.CaptureFixture
) -> None:
    grid = Grid("lin_room", v_d=[1.0, 1.4], seed=range(3), **TINY)
    goes(deadly.killed_at_seed_one)
    ds = sweep(grid, store, jobs=2)
    said = capsys.readouterr().err
    assert (ds.outcome.sel(seed=1) == 0).all()
    assert (ds.outcome.sel(seed=[0, 2]) > 0).all()
    assert "by SIGKILL (killed; out of memory?)" in said
    assert "2 of 6 runs failed" in said
    key = run_key(grid.scenario({"v_d": 1.4, "seed": 1}))
    note = (store / "failed" / f"{key}.txt").read_text()
    assert note.startswith("set aside: 2 workers ended in this run")
    command = "again: jamsweep run lin_room --N 5 --size 4.0 --time-limit 2.0 --v-d 1.4 --seed 1"
    assert command in note.splitlines()
    assert command.removeprefix("again: ") in said

    again = sweep(grid, store, jobs=2)
    assert "2 of them set aside" in capsys.readouterr().err
    xr.testing.assert_identical(again, ds)

    goes(work)
    whole = sweep(grid, store, jobs=2, backend="loky", retry=True)
    xr.testing.assert_identical(whole, sweep(grid, tmp_path / "undisturbed", jobs=1))
    assert run_files(store) == run_files(tmp_path / "undisturbed")
    assert not list((store / "failed").iterdir())


def test_no_process_is_left_by_a_sweep(store: Path) -> None:
    before = set(psutil.Process().children(recursive=True))
    sweep(Grid("lin_room", seed=range(3), **TINY), store, jobs=2)
    left = set(psutil.Process().children(recursive=True)) - before
    assert not [process for process in left if "popen_loky" in " ".join(process.cmdline())]
