"""jamsweep view and jamsweep report: what they write, and how they refuse."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.animation import FFMpegWriter
from PIL import Image

from engine import rooms, simulate
from sweep import Grid, sweep, write_run
from sweep.cli import main
from sweep.pages.film import Drawing

SMALL = {"N": 5, "size": 4.0, "time_limit": 2.0}


def jamsweep(*arguments: object) -> int:
    """Exit code of the command."""
    with pytest.raises(SystemExit) as caught:
        main(list(map(str, arguments)))
    return int(caught.value.code or 0)


def refused(capsys: pytest.CaptureFixture, *arguments: object) -> str:
    """The one line of a refusal with exit code 2."""
    assert jamsweep(*arguments) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    return said.err


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "run.nc"
    write_run(simulate(rooms.lin_room(record_every=0.1, contacts=True, record="positions", **SMALL)), path)
    return path


def test_view_writes_one_page_beside_the_run(file: Path, capsys: pytest.CaptureFixture) -> None:
    assert jamsweep("view", file) == 0
    assert capsys.readouterr().out == f"{file.with_suffix('.html')}\n"
    assert file.with_suffix(".html").read_text("utf-8").startswith("<!DOCTYPE html>")
    assert sorted(path.name for path in file.parent.iterdir()) == ["run.html", "run.nc"]


def test_view_refuses_what_it_cannot_play(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    bare, cut, words = (tmp_path / name for name in ("bare.nc", "cut.nc", "words.nc"))
    write_run(simulate(rooms.lin_room(**SMALL)), bare)
    whole = file.read_bytes()
    cut.write_bytes(whole[: len(whole) // 2])
    words.write_text("no run")
    assert "has no samples to play: run it again with `--record-every 0.1`" in refused(capsys, "view", bare)
    for path in (cut, words):
        assert f"run file '{path}' cannot be read: it is damaged, or none of a run" in refused(capsys, "view", path)
    assert "does not exist" in refused(capsys, "view", tmp_path / "none.nc")
    assert "is a folder: name a run file, such as one of those in " in refused(capsys, "view", tmp_path)
    assert "every 0 is not a whole number above 0" in refused(capsys, "view", file, "--every", 0)
    assert "output folder" in refused(capsys, "view", file, "-o", tmp_path / "no" / "run.html")
    assert not list(tmp_path.glob("*.html"))


def test_view_refuses_a_file_whose_values_are_damaged(file: Path, capsys: pytest.CaptureFixture) -> None:
    whole = bytearray(file.read_bytes())
    for k in range(len(whole) // 3, len(whole) - 200, 97):
        whole[k] ^= 0xFF
    file.write_bytes(whole)
    assert re.search("is damaged|cannot be read", refused(capsys, "view", file))


def test_view_refuses_a_gathered_dataset(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    sweep(Grid("lin_room", seed=[0], **SMALL), store=tmp_path / "results", jobs=1)
    capsys.readouterr()
    assert "holds no run" in refused(capsys, "view", tmp_path / "results" / "dataset.nc")


def test_a_gif_shows_the_run_from_begin_to_end(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    film = tmp_path / "run.gif"
    assert jamsweep("view", file, "--gif", film, "--rate", 4) == 0
    assert capsys.readouterr().out == f"{film}\n"
    with Image.open(film) as picture:
        assert picture.n_frames == 7  # 2 s at 4 s a second and 12 frames a second, and the end
        first = np.asarray(picture.convert("RGB")).astype(int)
        picture.seek(6)
        last = np.asarray(picture.convert("RGB")).astype(int)
    assert (np.abs(first - last).max(axis=-1) > 60).sum() > 200
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.gif", "run.nc"]


def test_a_film_shows_those_who_are_there_between_their_positions(walk: xr.Dataset) -> None:
    drawing = Drawing(walk, "speed")
    for k, part in ((20, 0.04), (int(walk.sizes["sample"] * 0.7), 0.06)):
        time = float(walk.time[k]) + part
        drawing.show(time)
        x = np.ma.filled(drawing.discs.get_offsets().astype(float), np.nan)[:, 0]
        left = walk.exit_person.values[walk.exit_time.values <= time]
        assert np.flatnonzero(np.isnan(x)).tolist() == sorted(left.tolist())
        before, after = walk.x.values[k], walk.x.values[k + 1]
        both = np.isfinite(before) & np.isfinite(after)
        assert x[both] == pytest.approx((before + part / 0.1 * (after - before))[both])
    assert left.size > 0
    drawing.show(float(walk.end_time))
    assert np.isnan(np.ma.filled(drawing.discs.get_offsets().astype(float), np.nan)).all()


@pytest.mark.skipif(not FFMpegWriter.isAvailable(), reason="no ffmpeg on this machine: apt-get install ffmpeg")
def test_an_mp4_is_one(tmp_path: Path) -> None:
    path, film = tmp_path / "run.nc", tmp_path / "run.mp4"
    write_run(simulate(rooms.lin_room(record_every=0.1, contacts=True, **SMALL)), path)
    assert jamsweep("view", path, "--mp4", film, "--rate", 10, "--colour", "force") == 0
    assert film.read_bytes()[4:8] == b"ftyp"


def test_a_film_that_cannot_be_is_refused(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda _: False))
    film = tmp_path / "run.mp4"
    assert "needs ffmpeg, which is not installed: install it, or write a .gif" in refused(
        capsys, "view", file, "--mp4", film
    )
    assert "colour 'force' needs contact forces, which this run lacks" in refused(
        capsys, "view", file, "--gif", tmp_path / "x.gif", "--colour", "force"
    )
    assert "does not end in .gif" in refused(capsys, "view", file, "--gif", film)
    assert "rate 0.0 is not above 0" in refused(capsys, "view", file, "--gif", tmp_path / "x.gif", "--rate", 0)


def test_report_writes_a_page_into_the_store(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    store = tmp_path / "results"
    sweep(Grid("lin_room", seed=[0, 1], **SMALL), store=store, jobs=1)
    before = {path.name for path in store.iterdir()}
    capsys.readouterr()
    assert jamsweep("report", store) == 0
    assert capsys.readouterr().out == f"{store / 'report.html'}\n"
    assert {path.name for path in store.iterdir()} == before | {"report.html"}


def test_report_refuses_a_folder_without_a_sweep(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    assert "holds no gathered dataset" in refused(capsys, "report", tmp_path)
