"""What holds for any number of workers, and when they fail or die."""

import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import rooms
from sweep import Grid, Store, SweepStopped, sweep
from sweep.running import worker
from sweep.running.worker import Done, Failed, Outdated, work
from sweep.schema import run_key
from tests.sweep.tiny import TINY, run_files

CROWDED = {"size": 2.2, "time_limit": 0.5}  # ten persons cover 59 % of it: not to be placed at random


def test_one_and_two_workers_give_the_same_bits(grid: Grid, tmp_path: Path) -> None:
    one, two = (sweep(grid, tmp_path / str(jobs), jobs=jobs) for jobs in (1, 2))
    xr.testing.assert_identical(one, two)
    assert one.exit_time.values.tobytes() == two.exit_time.values.tobytes()
    assert run_files(tmp_path / "1") == run_files(tmp_path / "2") != {}
    workers = {entry.pid for entry in Store(tmp_path / "2").finished().values()}
    assert os.getpid() not in workers


def test_the_order_of_the_runs_changes_nothing(tmp_path: Path) -> None:
    ordered = sweep(Grid("lin_room", v_d=[1.0, 1.4], seed=[0, 1, 2], **TINY), tmp_path / "ordered", jobs=1)
    shuffled = sweep(Grid("lin_room", seed=[2, 0, 1], v_d=[1.4, 1.0], **TINY), tmp_path / "shuffled", jobs=2)
    assert run_files(tmp_path / "ordered") == run_files(tmp_path / "shuffled")
    back = shuffled.sortby(["seed", "v_d"]).transpose(*ordered.dims)
    assert np.array_equal(back.exit_time, ordered.exit_time, equal_nan=True)


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_failing_run_is_named_and_the_others_go_on(store: Path, capsys: pytest.CaptureFixture, jobs: int) -> None:
    grid = Grid("lin_room", N=[10, 3], seed=range(2), **CROWDED)
    ds = sweep(grid, store, jobs=jobs)
    said = capsys.readouterr().err
    assert (ds.outcome.sel(N=10) == 0).all()
    assert (ds.outcome.sel(N=3) > 0).all()
    for seed in (0, 1):
        assert said.count(f"N = 10, seed = {seed}: BadInput: N 10 persons do not fit") == 1
    assert "2 of 4 runs failed" in said
    assert "Traceback" not in said
    note = store / "failed" / f"{run_key(grid.scenario({'N': 10, 'seed': 1}))}.txt"
    assert "N = 10, seed = 1" in note.read_text()
    assert "Traceback" in note.read_text()


def test_a_failure_overcome_is_forgotten(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    grid = Grid("lin_room", **TINY)
    with monkeypatch.context() as patch:
        patch.setattr(worker, "simulate", lambda scenario: 1 / 0)
        assert int(sweep(grid, store, jobs=1).outcome) == 0
    assert len(list((store / "failed").iterdir())) == 1
    assert int(sweep(grid, store, jobs=1).outcome) > 0
    assert list((store / "failed").iterdir()) == []


def test_an_error_comes_back_as_data(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = rooms.lin_room(**TINY)
    key = run_key(scenario)
    Store(store).make()
    assert isinstance(work(scenario, str(store), key), Done)
    monkeypatch.setattr(worker, "simulate", lambda scenario: 1 / 0)
    result = work(scenario, str(store), key)
    assert isinstance(result, Failed)
    assert result.error == "ZeroDivisionError: division by zero"


def test_an_engine_edited_meanwhile_stops_the_sweep(grid: Grid, store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "run_key", lambda scenario: "another")
    assert isinstance(work(rooms.lin_room(**TINY), str(store), "asked for"), Outdated)
    with pytest.raises(SweepStopped, match="engine's sources were edited meanwhile: 0 of 6 runs are kept"):
        sweep(grid, store, jobs=1)
