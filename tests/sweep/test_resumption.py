"""A second sweep runs what is missing, and nothing else."""

import json
from collections.abc import Callable
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

from engine import BadInput
from sweep import Grid, Store, gather, sweep
from sweep.schema import run_key
from tests.sweep.tiny import TINY, run_files


def manifest(store: Path) -> list[str]:
    return [json.loads(line)["key"] for line in (store / "manifest.jsonl").read_text().splitlines() if line]


def test_a_second_sweep_runs_nothing_and_says_so(grid: Grid, store: Path, capsys: pytest.CaptureFixture) -> None:
    first = sweep(grid, store, jobs=1)
    assert "6 runs: 0 done, 6 to do" in capsys.readouterr().err
    lines, dataset = manifest(store), (store / "dataset.nc").stat()
    second = sweep(grid, store, jobs=1)
    assert "6 runs: 6 done, 0 to do; nothing to run" in capsys.readouterr().err
    assert manifest(store) == lines
    assert len(lines) == 6
    assert (store / "dataset.nc").stat().st_ino == dataset.st_ino, "the dataset was written again"
    xr.testing.assert_identical(first, second)


def test_a_deleted_file_is_the_one_that_is_run_again(grid: Grid, store: Path) -> None:
    before = sweep(grid, store, jobs=1)
    files, lines = run_files(store), manifest(store)
    victim = store / "runs" / f"{lines[2]}.nc"
    victim.unlink()
    after = sweep(grid, store, jobs=1)
    assert manifest(store) == [*lines, lines[2]]
    assert run_files(store) == files
    xr.testing.assert_identical(before, after)


def test_a_file_that_the_manifest_does_not_vouch_for_is_run_again(grid: Grid, store: Path) -> None:
    sweep(grid, store, jobs=1)
    files, lines = run_files(store), manifest(store)
    truncated = store / "runs" / f"{lines[0]}.nc"
    truncated.write_bytes(files[truncated.name][:-1])
    kept = (store / "manifest.jsonl").read_text().splitlines()
    kept = [*(line for line in kept if line), '{"key": [1], "size": 2}']
    kept.insert(0, kept.pop())
    (store / "manifest.jsonl").write_text(
        "\n".join([kept[0], *kept[2:-1], kept[-1][:20]])
    )  # the last line torn by a crash
    assert set(Store(store).finished()) == set(lines[1:-1])
    sweep(grid, store, jobs=1)
    assert run_files(store) == files
    assert set(Store(store).finished()) == set(lines)


def test_a_half_written_temporary_never_counts(grid: Grid, store: Path) -> None:
    whole = sweep(grid, store, jobs=1)
    key = manifest(store)[0]
    path = store / "runs" / f"{key}.nc"
    path.rename(path.with_name(f".{path.name}.elsewhere.1.abcd.tmp"))
    assert key not in Store(store).finished()
    assert int((gather(grid, store).outcome == 0).sum()) == 1
    xr.testing.assert_identical(sweep(grid, store, jobs=1), whole)


def test_an_extended_grid_runs_only_what_is_new(store: Path) -> None:
    small = sweep(Grid("lin_room", v_d=[1.0], seed=range(2), **TINY), store, jobs=1)
    lines = manifest(store)
    large = sweep(Grid("lin_room", mu=[0.3, 0.7], v_d=[1.4, 1.0], seed=range(3), **TINY), store, jobs=1)
    assert manifest(store)[:2] == lines
    assert len(manifest(store)) == 12
    part = large.sel(mu=0.3, v_d=[1.0], seed=[0, 1])
    assert part.max_speed.values.tolist() == small.max_speed.values.tolist()


def emptied(path: Path) -> None:
    path.write_bytes(bytes(path.stat().st_size))


def without_end_mark(path: Path) -> None:
    with netCDF4.Dataset(path, "a") as file:
        file.complete = np.int32(0)


def with_another_key(path: Path) -> None:
    with netCDF4.Dataset(path, "a") as file:
        file.run_key = file.run_key[::-1]


@pytest.mark.parametrize("spoil", [emptied, without_end_mark, with_another_key])
def test_a_spoilt_file_is_set_aside_at_gather_and_run_again(
    grid: Grid, store: Path, spoil: Callable[[Path], None], capsys: pytest.CaptureFixture
) -> None:
    whole = sweep(grid, store, jobs=1)
    files = run_files(store)
    (store / "dataset.nc").unlink()
    victim = store / "runs" / f"{manifest(store)[0]}.nc"
    spoil(victim)
    assert victim.stat().st_size == len(files[victim.name]), "the manifest would have told"
    spoilt = victim.read_bytes()
    assert int((gather(grid, store).outcome == 0).sum()) == 1
    said = capsys.readouterr().err
    assert f"run file '{victim}' is damaged" in said
    assert "a sweep runs it again" in said
    assert victim.with_name(f"{victim.name}.corrupt").read_bytes() == spoilt
    xr.testing.assert_identical(sweep(grid, store, jobs=1), whole)
    assert run_files(store) == files


def test_damage_that_a_sweep_meets_is_mended_by_the_same_sweep(
    grid: Grid, store: Path, capsys: pytest.CaptureFixture
) -> None:
    whole = sweep(grid, store, jobs=1)
    (store / "dataset.nc").unlink()
    emptied(store / "runs" / f"{manifest(store)[3]}.nc")
    capsys.readouterr()
    xr.testing.assert_identical(sweep(grid, store, jobs=1), whole)
    assert "6 runs: 5 done, 1 to do" in capsys.readouterr().err


def test_a_file_of_another_size_is_set_aside_and_said(grid: Grid, store: Path, capsys: pytest.CaptureFixture) -> None:
    whole = sweep(grid, store, jobs=1)
    victim = store / "runs" / f"{manifest(store)[1]}.nc"
    victim.write_bytes(victim.read_bytes()[:-7])
    xr.testing.assert_identical(sweep(grid, store, jobs=1), whole)
    assert "1 run file is damaged" in capsys.readouterr().err
    assert victim.with_name(f"{victim.name}.corrupt").is_file()


def test_the_manifest_holds_what_differs_between_machines(grid: Grid, store: Path) -> None:
    sweep(grid, store, jobs=1)
    entries = Store(store).finished()
    assert set(entries) == {run_key(grid.scenario(point)) for point in grid.points()}
    assert all(entry.duration > 0 and entry.host and entry.pid for entry in entries.values())


@pytest.mark.parametrize("place", ["file", "file/below", "/proc/nowhere/results"])
def test_a_store_that_cannot_be_is_refused_before_any_run(grid: Grid, tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_text("kept")
    with pytest.raises(BadInput, match=r"store .* (is not a folder|cannot be written to)"):
        sweep(grid, tmp_path / place, jobs=1)
    assert (tmp_path / "file").read_text() == "kept"


def test_jobs_must_be_a_number_of_workers(grid: Grid, store: Path) -> None:
    with pytest.raises(BadInput, match="jobs 0 is not"):
        sweep(grid, store, jobs=0)
