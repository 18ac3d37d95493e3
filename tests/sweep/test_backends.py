"""No value depends on where runs are run, in which order, or after how many interruptions."""

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from engine import BadInput
from sweep import Grid, Store, sweep
from sweep.running import cluster
from tests.sweep.tiny import TINY, run_files


@pytest.fixture(scope="module")
def two_machines() -> Iterator[Any]:
    """A dask cluster of two worker processes."""
    pytest.importorskip("distributed")
    with cluster.own_cluster(2) as two:
        yield two


def test_serial_loky_dask_shuffled_and_resumed_sweeps_are_equal_byte_for_byte(
    tmp_path: Path, two_machines: Any
) -> None:
    grid = Grid("lin_room", v_d=[1.0, 1.4], seed=range(3), **TINY)
    shuffled = Grid("lin_room", v_d=[1.4, 1.0], seed=[2, 0, 1], **TINY)
    whole = {
        "serial": sweep(grid, tmp_path / "serial", backend="serial"),
        "loky": sweep(grid, tmp_path / "loky", backend="loky"),
        "dask": sweep(grid, tmp_path / "dask", scheduler=two_machines.scheduler_address),
        "shuffled": sweep(shuffled, tmp_path / "shuffled", backend="loky"),
    }
    sweep(Grid("lin_room", v_d=[1.4], seed=[1, 2], **TINY), tmp_path / "resumed", backend="loky")
    whole["resumed"] = sweep(grid, tmp_path / "resumed", scheduler=two_machines.scheduler_address)
    files = {name: run_files(tmp_path / name) for name in whole}
    assert len(files["serial"]) == 6
    for name, ds in whole.items():
        assert files[name] == files["serial"], name
        back = ds.sortby(["v_d", "seed"])
        assert back.exit_time.values.tobytes() == whole["serial"].exit_time.values.tobytes(), name
        xr.testing.assert_equal(back, whole["serial"])
    writers = {entry.pid for entry in Store(tmp_path / "dask").finished().values()}
    assert os.getpid() not in writers


def test_a_killed_dask_worker_costs_no_run(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    grid, store = (
        Grid("lin_room", seed=range(8), N=5, size=4.0, accuracy="0.1mm", time_limit=8.0),
        Store(tmp_path / "d"),
    )

    def kill_one(two: Any) -> None:
        while not store.finished():
            time.sleep(0.05)
        os.kill(next(iter(two.workers.values())).pid, signal.SIGKILL)

    with cluster.own_cluster(2) as two:
        killer = threading.Thread(target=kill_one, args=(two,))
        killer.start()
        ds = sweep(grid, store, scheduler=two.scheduler_address)
        killer.join()
    xr.testing.assert_equal(ds, sweep(grid, tmp_path / "serial", backend="serial"))
    assert run_files(tmp_path / "d") == run_files(tmp_path / "serial")


def test_a_time_out_ends_a_run_on_a_dask_worker_too(tmp_path: Path, two_machines: Any) -> None:
    grid = Grid("lin_room", time_limit=[0.1, 1e6], N=5, size=4.0, v_d=0.001, dt=1e-5, blocked_after=1e6)
    ds = sweep(grid, tmp_path / "d", scheduler=two_machines.scheduler_address, timeout=2.0)
    assert ds.outcome.values.tolist()[1] == 0
    assert ds.outcome.values.tolist()[0] > 0
    assert np.isnan(ds.end_time.values[1]), "a run that timed out has a time"
    assert "timed out after 2 s" in next((tmp_path / "d" / "failed").iterdir()).read_text()


def test_a_store_that_workers_do_not_see_is_refused_before_any_run(
    tmp_path: Path, two_machines: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    token = cluster._Token
    monkeypatch.setattr(token, "__enter__", lambda self: self)  # as on a machine that has another folder there
    with pytest.raises(BadInput, match=r"store .* is not seen by the worker on \S+: put it on a file system that all"):
        sweep(Grid("lin_room", **TINY), tmp_path / "d", scheduler=two_machines.scheduler_address)
    assert not run_files(tmp_path / "d")


def test_a_scheduler_that_does_not_answer_is_one_line(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "CONNECTING", "0.5s")
    with pytest.raises(BadInput, match=r"^scheduler 'tcp://127.0.0.1:1' does not answer .*: start one with"):
        sweep(Grid("lin_room", **TINY), store, scheduler="tcp://127.0.0.1:1")


def test_dask_that_is_not_installed_is_one_line(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(
        BadInput, match=r"backend 'dask' needs distributed, which is not installed: pip install 'jamsweep\[dask\]'"
    ):
        sweep(Grid("lin_room", **TINY), store, backend="dask")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"backend": "threads"}, "backend 'threads' is not known: choose one of serial, loky, dask"),
        ({"backend": "loky", "scheduler": "tcp://host:1"}, "is of no use to backend loky"),
        ({"backend": "serial", "timeout": 1.0}, "cannot end a run"),
        ({"timeout": 0}, "timeout 0 is not a time above 0"),
        ({"timeout": float("nan")}, "timeout nan is not a time above 0"),
        ({"memory_limit": "much"}, "memory_limit 'much' is not an amount of memory"),
        ({"memory_limit": 0}, "memory_limit 0 is not"),
        ({"memory_limit": "1.2.3 GB"}, "memory_limit '1.2.3 GB' is not"),
    ],
)
def test_options_that_make_no_sense_are_refused_before_the_store_is_made(
    store: Path, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(BadInput) as error:
        sweep(Grid("lin_room", **TINY), store, **options)
    assert words in str(error.value)
    assert not store.exists()
