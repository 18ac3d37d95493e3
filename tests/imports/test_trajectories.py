"""Trajectories from files: what they say is what one gets, and what they lack is named."""

from pathlib import Path

import numpy as np
import pytest

from engine import BadInput
from sweep.exports import write_hdf5, write_sqlite, write_text
from sweep.imports import read_trajectories
from tests.exports.walks import walked
from tests.imports.crowd_files import HEAD, walkers, written

ROWS = [(7, 0, 1.0, 2.0), (7, 1, 1.1, 1.9), (9, 1, -3.0, 0.5)]


def test_a_text_gives_places_in_metres_by_frame_and_person(tmp_path: Path) -> None:
    found = read_trajectories(written(tmp_path / "a.txt", ROWS))
    assert found.person_id.values.tolist() == [7, 9]
    assert found.time.values.tolist() == [0.0, 0.04]
    assert found.x.values[:, 0].tolist() == [1.0, 1.1]
    assert np.isnan(found.x.values[0, 1])
    assert found.y.values[1].tolist() == [1.9, 0.5]


def test_centimetres_tabs_and_a_byte_order_mark_change_nothing(tmp_path: Path) -> None:
    plain = read_trajectories(written(tmp_path / "a.txt", ROWS))
    head = ["\ufeff# framerate: 25 fps", "# id frame x/cm y/cm z/cm"]
    rows = [(i, frame, 100 * x, 100 * y) for i, frame, x, y in ROWS]
    other = read_trajectories(written(tmp_path / "b.txt", rows, head, "\t"))
    assert other.drop_attrs().equals(plain.drop_attrs()) or np.allclose(other.x, plain.x, equal_nan=True)
    assert other.attrs["frame_rate"] == 25.0


def test_what_a_head_lacks_can_be_given(tmp_path: Path) -> None:
    path = written(tmp_path / "a.txt", ROWS, [])
    with pytest.raises(BadInput, match="do not say their frame rate: give it, such as frame_rate=25"):
        read_trajectories(path)
    with pytest.raises(BadInput, match="do not say their unit"):
        read_trajectories(path, frame_rate=10.0)
    assert read_trajectories(path, frame_rate=10.0, unit="cm").time.values[1] == 0.1
    with pytest.raises(BadInput, match=r"is not the 25.0 that the file says"):
        read_trajectories(written(tmp_path / "b.txt", ROWS), frame_rate=10.0)


@pytest.mark.parametrize(
    ("lines", "complaint"),
    [
        ([*HEAD], "are empty"),
        ([*HEAD, "1 0 2.0 3.0", "1 1 here 3.0"], "in numbers, first in line 5"),
        ([*HEAD, "1 0 2.0"], "in numbers, first in line 4"),
        ([*HEAD, "1 0.5 2.0 3.0"], "no finite numbers from frame 0"),
        ([*HEAD, "1 -1 2.0 3.0"], "no finite numbers from frame 0"),
        ([*HEAD, "1 3 2.0 nan"], "no finite numbers from frame 0"),
        ([*HEAD, "4 3 2.0 1.0", "4 3 2.5 1.0"], "person 4 in frame 3, have two places"),
        (["# framerate: fast", "# x/m"], "frame rate of .* fast is not a finite number"),
        (["# framerate: -25 fps", "# x/m", "1 0 2.0 3.0"], "frame rate -25.0 is not above 0"),
        (["# framerate: 25 fps", "# x/inch", "1 0 2.0 3.0"], "do not say their unit"),
    ],
)
def test_a_bad_text_is_named_in_one_line(tmp_path: Path, lines: list[str], complaint: str) -> None:
    path = tmp_path / "bad.txt"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(BadInput, match=complaint) as caught:
        read_trajectories(path)
    assert "\n" not in str(caught.value)


def test_other_files_and_formats_are_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"nowhere.txt' do not exist"):
        read_trajectories(tmp_path / "nowhere.txt")
    (tmp_path / "a.doc").touch()
    with pytest.raises(BadInput, match=r"format of 'a.doc' is not known: choose one of text, hdf5"):
        read_trajectories(tmp_path / "a.doc")
    with pytest.raises(BadInput, match="format 'word' is not known"):
        read_trajectories(tmp_path / "a.doc", form="word")


def test_without_pedpy_its_formats_name_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pedpy", None)
    (tmp_path / "a.sqlite").touch()
    with pytest.raises(BadInput, match=r"needs pedpy, which is not installed: pip install 'jamsweep\[pedpy\]'"):
        read_trajectories(tmp_path / "a.sqlite")


def test_pedpy_reads_the_same_from_a_text(tmp_path: Path) -> None:
    pedpy = pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")
    path = written(tmp_path / "a.txt", walkers([1.3, 2.0, 2.7]))
    ours, theirs = read_trajectories(path), pedpy.load_trajectory_from_txt(trajectory_file=path)
    assert ours.attrs["frame_rate"] == theirs.frame_rate
    for row in theirs.data.itertuples():
        person = ours.person_id.values.tolist().index(row.id)
        assert (ours.x.values[row.frame, person], ours.y.values[row.frame, person]) == (row.x, row.y)


def test_what_is_exported_can_be_read_again(tmp_path: Path) -> None:
    pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")
    run = walked([0.53, 1.23])
    for name, write in (("a.txt", write_text), ("a.h5", write_hdf5), ("a.sqlite", write_sqlite)):
        write(run, tmp_path / name)
        found = read_trajectories(tmp_path / name)
        inside = slice(0, run.sizes["sample"])
        known = np.isfinite(run.x.values)
        assert found.x.values[inside][known] == pytest.approx(run.x.values[known], abs=1e-6), name
        assert found.attrs["frame_rate"] == 10.0


def test_a_broken_file_of_another_format_is_named_in_one_line(tmp_path: Path) -> None:
    pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")
    for name in ("a.h5", "a.sqlite", "a.traj", "a.pp"):
        (tmp_path / name).write_text("no such thing\n")
        with pytest.raises(BadInput, match="cannot be read as") as caught:
            read_trajectories(tmp_path / name, frame_rate=10.0)
        assert "\n" not in str(caught.value)
