"""The gathered dataset."""

import errno
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import OUTCOMES, BadInput, simulate
from sweep import DamagedFile, Grid, gather, open_results, sweep
from tests.sweep.tiny import TINY


def test_dimensions_are_the_axes_in_order_and_then_the_exits(store: Path) -> None:
    grid = Grid("lin_room", v_d=[1.4, 1.0], N=[5, 3], seed=[7, 2], size=4, time_limit=3.0, inertia="disc")
    ds = sweep(grid, store, jobs=1)
    assert ds.exit_time.dims == ("v_d", "N", "seed", "exit")
    assert ds.outcome.dims == ("v_d", "N", "seed")
    assert ds.v_d.values.tolist() == [1.4, 1.0]
    assert ds.seed.values.tolist() == [7, 2]
    assert ds.exit.values.tolist() == list(range(1, ds.sizes["exit"] + 1))
    assert ds.sizes["exit"] == ds.N_out.max()
    assert ds.v_d.units == "m s-1"
    assert float(ds.size) == 4.0
    assert str(ds.inertia.values) == "disc"
    assert ds.attrs["room"] == "lin_room"
    assert "Common random numbers" in ds.random_numbers


def test_every_run_stands_at_its_place(grid: Grid, store: Path) -> None:
    ds = sweep(grid, store, jobs=1)
    for point in grid.points():
        run, row = simulate(grid.scenario(point)), ds.sel(point)
        assert row.exit_time.values[: run.N_out].tolist() == run.exit_time.tolist()
        assert row.exit_y.values[: run.N_out].tolist() == run.exit_y.tolist()
        assert OUTCOMES[int(row.outcome)] == run.outcome
        assert (float(row.end_time), int(row.persons), int(row.steps)) == (run.end_time, run.N, run.steps)


def test_exits_that_did_not_happen_are_padded(grid: Grid, store: Path) -> None:
    ds = sweep(grid, store, jobs=1)
    there = ds.exit <= ds.N_out
    assert not there.all()
    assert there.any()
    assert (ds.exit_time.notnull() == there).all()
    assert ((ds.exit_person >= 0) == there).all()
    assert ds.exit_person.dtype == np.int32
    assert ds.exit_time.dtype == np.float64


def test_missing_runs_are_flagged_and_not_guessed(grid: Grid, store: Path) -> None:
    sweep(Grid("lin_room", v_d=[1.0], seed=range(3), **TINY), store, jobs=1)
    ds = gather(grid, store)
    assert ds.outcome.dtype == np.int8
    assert ds.outcome.flag_meanings.split()[0] == "missing"
    assert (ds.outcome.sel(v_d=1.4) == 0).all()
    assert (ds.outcome.sel(v_d=1.0) > 0).all()
    lost = ds.sel(v_d=1.4)
    assert lost.end_time.isnull().all()
    assert (lost.N_out == 0).all()
    assert (lost.persons == 0).all()


def test_gathering_nothing_gives_a_dataset_of_missing_runs(grid: Grid, store: Path) -> None:
    store.mkdir()
    ds = gather(grid, store)
    assert (ds.outcome == 0).all()
    assert ds.exit_time.isnull().all()
    assert ds.exit_time.size > 0


def test_a_grid_without_axes_is_one_run(store: Path) -> None:
    ds = sweep(Grid("lin_room", **TINY), store, jobs=1)
    assert ds.outcome.dims == ()
    assert ds.exit_time.dims == ("exit",)


def test_axes_of_words_and_of_truth_values_survive_the_file(store: Path) -> None:
    grid = Grid("lin_room", inertia=["disc", "sphere"], contacts=[False, True], record_every=0.5, **TINY)
    ds = sweep(grid, store, jobs=1)
    assert ds.inertia.values.tolist() == ["disc", "sphere"]
    assert ds.contacts.values.tolist() == [False, True]
    assert ds.contacts.dtype == bool


def test_opening_gives_what_the_sweep_returned(grid: Grid, store: Path) -> None:
    ds = sweep(grid, store, jobs=1)
    xr.testing.assert_identical(open_results(store), ds)


def test_results_may_stay_on_disk_until_they_are_needed(grid: Grid, store: Path) -> None:
    pytest.importorskip("dask")
    ds = sweep(grid, store, jobs=1)
    with open_results(store, chunks={}) as lazy:
        assert lazy.exit_time.chunks is not None
        xr.testing.assert_identical(lazy.compute(), ds)


def test_chunks_without_dask_are_one_line(grid: Grid, store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sweep(grid, store, jobs=1)
    monkeypatch.setattr("sweep.results.find_spec", lambda name: None)
    with pytest.raises(BadInput, match=r"take dask, which is not installed: pip install 'jamsweep\[dask\]'"):
        open_results(store, chunks={"seed": 1})
    assert open_results(store).sizes["seed"] == 3


def test_a_store_that_takes_no_more_still_gives_its_dataset(
    grid: Grid, store: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    ds = sweep(grid, store, jobs=1)
    (store / "dataset.nc").unlink()

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("sweep.results.replace_durably", full)
    xr.testing.assert_identical(gather(grid, store), ds)
    assert "is not kept in" in capsys.readouterr().err


def test_another_grid_over_the_same_store_is_gathered_anew(grid: Grid, store: Path) -> None:
    sweep(grid, store, jobs=1)
    ds = gather(Grid("lin_room", seed=[2, 0], v_d=[1.0], **TINY), store)
    assert ds.outcome.dims == ("seed", "v_d")
    assert (ds.outcome > 0).all()


def test_a_store_without_results_is_named(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="holds no gathered dataset: run its sweep"):
        open_results(tmp_path / "nowhere")


def test_a_damaged_dataset_is_made_again_from_its_runs(grid: Grid, store: Path) -> None:
    whole = sweep(grid, store, jobs=1)
    path = store / "dataset.nc"
    content = bytearray(path.read_bytes())
    content[len(content) // 2 :] = bytes(len(content) - len(content) // 2)
    path.write_bytes(content)
    xr.testing.assert_identical(sweep(grid, store, jobs=1), whole)


def test_a_room_that_makes_no_scenario_is_refused() -> None:
    with pytest.raises(BadInput, match="returns int: return a Scenario"):
        Grid(_no_room, size=[1, 2])


def _no_room(size: int = 1) -> int:
    return size


def test_a_damaged_dataset_is_named(tmp_path: Path) -> None:
    (tmp_path / "dataset.nc").write_bytes(b"no netCDF")
    with pytest.raises(DamagedFile, match=r"dataset.nc' is damaged"):
        open_results(tmp_path)


def test_a_sweep_of_another_grid_into_the_store_meanwhile_is_not_taken_for_ones_own(
    grid: Grid, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own, other = sweep(grid, store, jobs=1), Grid("lin_room", v_d=[1.0], seed=[0], **TINY)
    theirs = gather(other, store)
    monkeypatch.setattr("sweep.gathering.open_results", lambda path: theirs)
    assert gather(grid, store).sizes == own.sizes
    assert gather(grid, store).sizes == own.sizes
