"""`jamsweep export`: the suffix names the form, and what cannot be exported is one line."""

import sys
from pathlib import Path

import pandas as pd
import pytest

from engine import rooms, simulate
from sweep import Grid, open_results, read_run, sweep, write_run
from sweep.cli import main
from sweep.exports import forces_on_walls, to_dataframe

SMALL = {"N": 8, "size": 4.0, "time_limit": 3.0}


def jamsweep(*arguments: object) -> int:
    """Exit code of the command."""
    with pytest.raises(SystemExit) as caught:
        main(list(map(str, arguments)))
    return int(caught.value.code or 0)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("runs") / "run.nc"
    write_run(simulate(rooms.lin_room(v_d=2.0, record_every=0.1, contacts=True, **SMALL)), path)
    return path


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("store")
    sweep(Grid("lin_room", v_d=[1.0, 2.0], seed=range(2), **SMALL), path, jobs=1)
    return path


def test_a_text_needs_no_extra(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("pedpy", "shapely", "h5py"):
        monkeypatch.setitem(sys.modules, name, None)
    path = tmp_path / "run.txt"
    assert jamsweep("export", run, "--to", path, "--unit", "cm") == 0
    assert capsys.readouterr().out == f"{path}\n"
    head, names, first = path.read_text().splitlines()[:3]
    assert (head, names) == ("# framerate: 10.0 fps", "# id frame x/cm y/cm z/cm")
    assert first.split()[:2] == ["0", "0"]
    assert float(first.split()[2]) == pytest.approx(100 * float(read_run(run).x[0, 0]), abs=1e-3)


@pytest.mark.parametrize("suffix", ["h5", "hdf5", "sqlite"])
def test_trajectories_go_to_the_form_of_the_suffix(run: Path, tmp_path: Path, suffix: str) -> None:
    pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")
    path = tmp_path / f"run.{suffix}"
    assert jamsweep("export", run, "--to", path) == 0
    assert path.read_bytes()[:4] == {"h": b"\x89HDF", "s": b"SQLi"}[suffix[0]]


def test_a_sweep_goes_to_tables_of_exits_and_runs(store: Path, tmp_path: Path) -> None:
    ds = open_results(store)
    for rows in ("exits", "runs"):
        path = tmp_path / f"{rows}.csv"
        assert jamsweep("export", store, "--to", path, "--rows", rows) == 0
        table = pd.read_csv(path)
        pd.testing.assert_frame_equal(table, to_dataframe(ds, rows), check_dtype=False)


def test_forces_go_to_a_table_of_times_and_walls(run: Path, tmp_path: Path) -> None:
    path = tmp_path / "forces.csv"
    assert jamsweep("export", run, "--to", path, "--rows", "forces-on-walls") == 0
    table, found = pd.read_csv(path), forces_on_walls(read_run(run))
    assert list(table)[:3] == ["time", "sample", "wall"]
    assert len(table) == found.wall_force.size
    assert table.wall_force.sum() == pytest.approx(found.wall_force.sum().item())


def test_parquet_is_written_or_named_as_an_extra(
    store: Path, tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "exits.parquet"
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "pyarrow", None)
        assert jamsweep("export", store, "--to", path) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "pip install 'jamsweep[parquet]'" in said
    pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install '.[parquet]'")
    assert jamsweep("export", store, "--to", path) == 0
    assert len(pd.read_parquet(path)) > 0


def test_what_cannot_be_exported_is_one_line(
    run: Path, store: Path, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    plain, broken = tmp_path / "plain.nc", tmp_path / "broken.nc"
    write_run(simulate(rooms.lin_room(**SMALL)), plain)
    broken.write_bytes(run.read_bytes()[:5000])
    (tmp_path / "empty").mkdir()
    for source, target, rows, complaint in (
        (run, "run.docx", "exits", "has no suffix of an export: choose one of .txt"),
        (run, "nowhere/run.txt", "exits", "output folder"),
        (tmp_path / "none.nc", "run.txt", "exits", "none.nc' does not exist"),
        (broken, "run.txt", "exits", "cannot be read: it is damaged, or none of a run"),
        (
            plain,
            "run.txt",
            "exits",
            "has no trajectories: record it with record_every=0.1 (in a shell: --record-every 0.1)",
        ),
        (plain, "f.csv", "forces-on-persons", "does not tell its contact forces"),
        (store, "run.txt", "exits", "holds many runs, of which this export takes one"),
        (store, "f.csv", "forces-on-walls", "holds many runs"),
        (tmp_path / "empty", "exits.csv", "exits", "holds no gathered dataset"),
    ):
        assert jamsweep("export", source, "--to", tmp_path / target, "--rows", rows) in (1, 2)
        said = capsys.readouterr().err
        assert complaint in said
        assert said.count("\n") == 1
        assert not (tmp_path / target).exists()
