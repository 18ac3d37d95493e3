"""Folding runs into shards changes where they are, and nothing else."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

from engine import BadInput
from sweep import Grid, Store, gather, open_results, read_run, sweep
from sweep.cli import main
from sweep.storage import shard
from sweep.storage.compact import compact
from sweep.storage.verify import verify
from tests.sweep.tiny import TINY, run_files

GRID = Grid("lin_room", record_every=[0.0, 0.5], record=["full", "positions"], seed=range(2), **TINY)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("swept") / "store"
    sweep(GRID, path, jobs=1, progress=False)
    return path


@pytest.fixture
def store(swept: Path, tmp_path: Path) -> Store:
    shutil.copytree(swept, tmp_path / "store")
    return Store(tmp_path / "store")


def test_runs_with_and_without_samples_fold_and_unfold_to_the_same_bytes(store: Store, tmp_path: Path) -> None:
    files = run_files(store.path)
    done = compact(store)
    assert (done.runs, done.shards) == (len(files), 3) == (8, 3)
    assert not list(store.runs.iterdir())
    for path in store.shards.glob("*.nc"):
        for row, entry in enumerate(shard.entries(path)):
            shard.unfold_to(path, row, tmp_path / "one.nc")
            assert (tmp_path / "one.nc").read_bytes() == files[f"{entry.key}.nc"]
            (tmp_path / "one.nc").unlink()


def test_folded_runs_count_are_verified_gathered_and_read(store: Store, capsys: pytest.CaptureFixture) -> None:
    before, entries, ds = (
        {k: read_run(store.file(k)) for k in store.finished()},
        store.finished(),
        open_results(store.path),
    )
    compact(store)
    after = store.finished()
    assert {k: (e.sha256, e.duration, e.engine) for k, e in after.items()} == {
        k: (e.sha256, e.duration, e.engine) for k, e in entries.items()
    }
    assert verify(store) == []
    store.dataset.unlink()
    xr.testing.assert_identical(gather(GRID, store), ds)
    for key, run in before.items():
        xr.testing.assert_identical(read_run(store.file(key)), run)
    sweep(GRID, store, jobs=1)
    assert "nothing to run" in capsys.readouterr().err


def test_what_comes_later_is_folded_later(store: Store) -> None:
    compact(store)
    shards = {path.name: path.read_bytes() for path in store.shards.glob("*.nc")}
    sweep(Grid("lin_room", v_d=1.3, seed=range(3), **TINY), store, jobs=1, progress=False)
    assert compact(store).runs == 3
    assert compact(store).runs == 0
    assert shards.items() <= {path.name: path.read_bytes() for path in store.shards.glob("*.nc")}.items()
    assert len(store.finished()) == 11
    assert not (store.path / "manifest.jsonl").read_text(), "lines of folded runs remain"


def test_a_damaged_run_is_not_folded(store: Store, capsys: pytest.CaptureFixture) -> None:
    path = sorted(store.runs.glob("*.nc"))[0]
    content = bytearray(path.read_bytes())
    content[-20] ^= 4
    path.write_bytes(content)
    assert compact(store).runs == 7
    assert "is damaged; set aside" in capsys.readouterr().err
    assert path.with_name(path.name + ".corrupt").is_file()
    assert path.stem not in store.finished()


def test_a_compaction_that_is_killed_at_any_moment_loses_nothing(store: Store) -> None:
    ds, command = (
        open_results(store.path),
        "from sweep.storage.compact import compact; import sys; compact(sys.argv[1], 1)",
    )
    for moment in range(40):
        process = subprocess.Popen([sys.executable, "-c", _stopping_at(moment) + command, str(store.path)])
        code = process.wait()
        assert len(store.finished()) == 8
        if code == 0:
            break
        assert code == -signal.SIGKILL
        if moment % 5 == 0:
            store.dataset.unlink()
            xr.testing.assert_identical(gather(GRID, store), ds)
    assert moment > 8, "it was not killed often enough to tell"
    compact(store)
    store.sweep_leftovers()
    assert verify(store) == []
    assert not list(store.runs.glob("*.nc"))
    xr.testing.assert_identical(gather(GRID, store), ds)


def _stopping_at(moment: int) -> str:
    """Code that kills its process at the n-th time that anything on the disk changes its name, is synced or goes."""
    return f"""
import os, signal
left = [{moment} % 13 + 1]
def killing(function):
    def call(*arguments, **keywords):
        left[0] -= 1
        if left[0] == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return function(*arguments, **keywords)
    return call
os.replace, os.fsync, os.unlink = killing(os.replace), killing(os.fsync), killing(os.unlink)
"""


def test_two_compactions_do_not_meet(store: Store) -> None:
    hold = "import sys, time\nfrom sweep.storage.durable import locked\nfrom pathlib import Path\n"
    hold += "with locked(Path(sys.argv[1])):\n    print('held', flush=True)\n    time.sleep(600)"
    holder = subprocess.Popen([sys.executable, "-c", hold, str(store.lock)], stdout=subprocess.PIPE, text=True)
    try:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(SystemExit) as caught:
            main(["compact", str(store.path)])
        assert caught.value.code == 1
    finally:
        holder.kill()
        holder.wait()
        if holder.stdout:
            holder.stdout.close()
    assert compact(store).runs == 8, "the lock of a dead process was still held"


def test_compacting_nothing_and_nowhere(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(BadInput, match="does not exist"):
        compact(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(SystemExit):
        main(["compact", str(tmp_path / "empty")])
    assert "nothing to fold" in capsys.readouterr().out


def test_a_sweep_that_goes_on_while_its_runs_are_folded_misses_none(tmp_path: Path) -> None:
    store, grid = Store(tmp_path / "store"), Grid("lin_room", v_d=[1.0, 1.2], seed=range(40), **TINY)
    alone = sweep(grid, tmp_path / "alone", jobs=1, progress=False)
    code = "from sweep import *; import sys; sweep(Grid.from_json(sys.argv[2]), sys.argv[1], jobs=1, progress=False)"
    process = subprocess.Popen([sys.executable, "-c", code, str(store.path), grid.to_json()])
    folds = 0
    while process.poll() is None:
        if store.path.is_dir():
            folds += compact(store, 7).runs > 0
        time.sleep(0.02)
    assert process.returncode == 0
    assert folds > 1, "nothing was folded meanwhile"
    compact(store)
    xr.testing.assert_identical(open_results(store.path), alone)
    assert verify(store) == []
    assert os.listdir(store.runs) == []
