"""Verification finds whatever is not as it was written, and nothing else."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

from engine import BadInput
from studies.torture import damage
from sweep import DamagedFile, Grid, Store, gather, open_results, read_run, sweep
from sweep.cli import main
from sweep.storage.compact import compact
from sweep.storage.durable import replace_durably
from sweep.storage.verify import verify
from tests.sweep.tiny import TINY, run_files

GRID = Grid("lin_room", v_d=[1.0, 1.4], seed=range(2), **TINY)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("swept") / "store"
    sweep(GRID, path, jobs=1, progress=False)
    return path


@pytest.fixture
def whole(swept: Path, tmp_path: Path) -> Store:
    """A whole store of four runs."""
    shutil.copytree(swept, tmp_path / "store")
    return Store(tmp_path / "store")


def a_run(store: Store) -> Path:
    return sorted(store.runs.glob("*.nc"))[1]


def of(store: Store, path: Path) -> list[str]:
    """What verification says of a path, after saying nothing of all others."""
    findings = verify(store)
    assert {finding.path for finding in findings} <= {path}
    return [str(finding) for finding in findings]


def test_a_whole_store_gives_no_finding(whole: Store) -> None:
    assert verify(whole) == []
    compact(whole)
    assert verify(whole) == []


def test_no_truncation_and_no_flipped_bit_is_missed_or_served() -> None:
    assert damage.main(quick=True) == []


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-1])


def flip(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 1
    path.write_bytes(content)


def replace_by_another(path: Path) -> None:
    shutil.copy(next(other for other in path.parent.glob("*.nc") if other != path), path)


@pytest.mark.parametrize("spoil", [cut, flip, replace_by_another])
def test_a_damaged_run_is_found_set_aside_and_run_again(whole: Store, spoil: Callable[[Path], None]) -> None:
    before, path = run_files(whole.path), a_run(whole)
    spoil(path)
    assert "--repair sets it aside, then sweep again" in of(whole, path)[0]
    assert verify(whole, repair=True)
    assert path.with_name(path.name + ".corrupt").is_file()
    sweep(GRID, whole, jobs=1, progress=False)
    assert run_files(whole.path) == before
    assert verify(whole) == []


def test_a_missing_run_is_found(whole: Store) -> None:
    path = a_run(whole)
    path.unlink()
    assert "is missing: sweep again" in of(whole, path)[0]
    verify(whole, repair=True)
    assert verify(whole) == [], "it is forgotten"
    assert len(whole.finished()) == 3


@pytest.mark.parametrize("tear", [lambda line: line[:40], lambda line: ""])
def test_a_run_whose_line_is_torn_or_lost_is_entered_again(whole: Store, tear: Callable[[str], str]) -> None:
    manifest = whole.path / "manifest.jsonl"
    lines = [line for line in manifest.read_text().splitlines() if line]
    key, entries = json.loads(lines[2])["key"], whole.finished()
    manifest.write_text("\n".join([*lines[:2], tear(lines[2]), *lines[3:]]))
    assert key not in whole.finished()
    assert "is whole, but not in the manifest" in of(whole, whole.file(key))[0]
    verify(whole, repair=True)
    again = whole.finished()[key]
    assert (again.sha256, again.scenario, again.engine) == (
        entries[key].sha256,
        entries[key].scenario,
        entries[key].engine,
    )
    assert verify(whole) == []


def test_an_unlisted_run_with_one_altered_value_is_not_entered(whole: Store) -> None:
    path = a_run(whole)
    with netCDF4.Dataset(path, "a") as file:
        file["end_time"][:] = file["end_time"][:] + 1.0
    (whole.path / "manifest.jsonl").write_text(
        "\n".join(line for line in (whole.path / "manifest.jsonl").read_text().splitlines() if path.stem not in line)
    )
    assert "not in the manifest, and not whole" in of(whole, path)[0]


def test_a_foreign_file_is_named_and_left_alone(whole: Store) -> None:
    path = whole.runs / "notes.txt"
    path.write_text("mine")
    assert "is no file of jamsweep: move it elsewhere" in of(whole, path)[0]
    verify(whole, repair=True)
    assert path.read_text() == "mine"


def test_a_run_of_another_schema_is_found(whole: Store) -> None:
    manifest, path = whole.path / "manifest.jsonl", a_run(whole)
    lines = [json.loads(line) for line in manifest.read_text().splitlines() if line]
    old = [line | ({"schema": 1} if line["key"] == path.stem else {}) for line in lines]
    manifest.write_text("\n".join(map(json.dumps, old)) + "\n")
    assert "is of schema 1" in of(whole, path)[0]


@pytest.mark.parametrize("spoil", [cut, flip])
def test_a_damaged_dataset_is_found_not_opened_and_made_again(whole: Store, spoil: Callable[[Path], None]) -> None:
    good = open_results(whole.path)
    spoil(whole.dataset)
    assert "is not what was written" in of(whole, whole.dataset)[0]
    with pytest.raises(DamagedFile, match="is damaged: delete it and gather again"):
        open_results(whole.path)
    xr.testing.assert_identical(gather(GRID, whole), good)
    assert verify(whole) == []


@pytest.mark.parametrize("spoil", [cut, flip])
def test_a_damaged_shard_is_found_set_aside_and_its_runs_run_again(whole: Store, spoil: Callable[[Path], None]) -> None:
    good = open_results(whole.path)
    compact(whole)
    path = next(whole.shards.glob("*.nc"))
    spoil(path)
    assert "with 4 runs: --repair sets it aside" in of(whole, path)[0]
    verify(whole, repair=True)
    assert whole.finished() == {}
    xr.testing.assert_identical(sweep(GRID, whole, jobs=1, progress=False), good)


def test_a_shard_whose_line_is_lost_is_entered_again(whole: Store) -> None:
    good = open_results(whole.path)
    compact(whole)
    (whole.path / "shards.jsonl").unlink()
    path = next(whole.shards.glob("*.nc"))
    assert "is whole, with 4 runs, but not listed" in "".join(str(f) for f in verify(whole) if f.path == path)
    verify(whole, repair=True)
    assert len(whole.finished()) == 4
    xr.testing.assert_identical(gather(GRID, whole), good)


def test_only_temporaries_of_dead_processes_are_swept(whole: Store) -> None:
    left: dict[str, Path] = {}

    def stop(path: Path) -> None:
        left["alive"] = path.with_name(path.name)
        path.write_text("half")
        shutil.copy(path, whole.runs / path.name.replace(f"~{os.getpid()}~", "~4194304~"))
        shutil.copy(path, whole.runs / path.name.replace("~", "~elsewhere-", 1))
        whole.sweep_leftovers()
        left["there"] = path if path.exists() else Path()

    replace_durably(whole.runs / f"{'0' * 64}.nc", stop)
    assert left["there"] == left["alive"], "the temporary of a living process was removed"
    assert [path.name.split("~")[1].startswith("elsewhere-") for path in whole.temporaries()] == [True]


def test_a_process_that_has_the_number_of_a_dead_one_is_not_its_owner(whole: Store) -> None:
    def stop(path: Path) -> None:
        parts = path.name.split("~")
        stale = whole.runs / "~".join([*parts[:3], str(int(parts[3]) - 1), parts[4]])
        stale.write_text("half")
        assert whole.sweep_leftovers() == [stale]
        path.touch()

    replace_durably(whole.runs / f"{'0' * 64}.nc", stop)


def test_a_run_read_alone_is_held_against_its_hash(whole: Store) -> None:
    path = a_run(whole)
    assert np.isfinite(read_run(path).end_time)
    flip(path)
    with pytest.raises(DamagedFile, match="is damaged: sweep again"):
        read_run(path)


def test_the_command_says_a_line_each_and_exits_with_1(whole: Store, capsys: pytest.CaptureFixture) -> None:
    flip(a_run(whole))
    for arguments, code, words in (
        ([], 1, "3 runs"),
        (["--repair"], 0, "repaired: "),
        ([], 1, "is missing"),
    ):
        with pytest.raises(SystemExit) as caught:
            main(["verify", str(whole.path), *arguments])
        said = capsys.readouterr().out
        assert (caught.value.code, len(said.splitlines())) == (code, 2)
        assert words in said or words == "3 runs"


@pytest.mark.parametrize("name", ["notes.txt", "runs/model.pt"])
def test_a_foreign_folder_is_refused_and_nothing_is_written(tmp_path: Path, name: str) -> None:
    path = tmp_path / "mine" / name
    path.parent.mkdir(parents=True)
    path.write_text("mine")
    for use in (lambda: sweep(GRID, tmp_path / "mine", jobs=1), lambda: gather(GRID, tmp_path / "mine")):
        with pytest.raises(BadInput, match="is a folder of something else"):
            use()
    assert [p for p in (tmp_path / "mine").rglob("*") if p.is_file()] == [path]


def test_a_store_of_a_newer_jamsweep_is_refused_and_nothing_is_written(whole: Store) -> None:
    about = json.loads((whole.path / "store.json").read_text())
    (whole.path / "store.json").write_text(json.dumps(about | {"schema_version": about["schema_version"] + 1}))
    before = {path: path.stat().st_mtime_ns for path in whole.path.rglob("*")}
    uses = (
        lambda: sweep(GRID, whole, jobs=1),
        lambda: gather(GRID, whole),
        lambda: open_results(whole.path),
        lambda: verify(whole),
        lambda: compact(whole),
    )
    for use in uses:
        with pytest.raises(BadInput, match="written by a newer jamsweep"):
            use()
    assert {path: path.stat().st_mtime_ns for path in whole.path.rglob("*")} == before
