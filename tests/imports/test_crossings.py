"""Crossings of a line: when a straight walker gets there, and who does not."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import BadInput
from studies import measures
from sweep.imports import crossings, read_trajectories
from tests.imports.crowd_files import walkers, written

LINE, DOWN = ((-0.5, -0.5), (0.5, -0.5)), (0.0, -1.0)


def seen(*ways: list[tuple[float, float]], rate: float = 1.0) -> xr.Dataset:
    """Persons at these places, frame by frame; None: not seen."""
    longest = max(map(len, ways))
    nowhere = (np.nan, np.nan)
    at = np.array([[way[k] if k < len(way) and way[k] else nowhere for way in ways] for k in range(longest)], float)
    dims = ("sample", "person")
    return xr.Dataset(
        {"x": (dims, at[..., 0]), "y": (dims, at[..., 1])}, coords={"time": ("sample", np.arange(longest) / rate)}
    )


def test_walkers_cross_when_they_get_there_whatever_the_frames(tmp_path: Path) -> None:
    times = [1.013, 3.37, 2.2, 4.0]
    ds = crossings(read_trajectories(written(tmp_path / "a.txt", walkers(times))), LINE, DOWN)
    assert ds.exit_time.values == pytest.approx(sorted(times), abs=1e-4)
    assert ds.exit_person.values.tolist() == [0, 2, 1, 3]
    assert ds.exit_y.values == pytest.approx([-0.5] * 4)
    assert ds.exit_x.values == pytest.approx(0.3 * np.sin([0, 2, 1, 3]), abs=1e-5)
    assert measures.clearance(ds).clearance_time.item() == pytest.approx(4.0, abs=1e-4)


def test_only_the_first_way_out_counts() -> None:
    back_and_forth = [(0, 0), (0, -1), (0, 0), (0, -1)]
    coming_in = [(0, -1), (0, 0), (0, 0), (0, -2)]
    ds = crossings(seen(back_and_forth, coming_in), LINE, DOWN)
    assert ds.exit_time.values.tolist() == [0.5, 2.25]


def test_whoever_passes_beside_the_line_is_inside_until_it_crosses() -> None:
    beside = [(0.6, 0), (0.6, -1), (0.6, 0), (0.4, -1)]  # crosses at x = 0.5 in the end
    never = [(2, 0), (2, -1), (2, -2), (2, -3)]
    ds = crossings(seen(beside, never), LINE, DOWN)
    assert ds.exit_time.values.tolist() == [2.5]
    assert (int(ds.N_out), int(ds.persons), float(ds.end_time)) == (1, 2, 3.0)
    assert bool(measures.outcome_is(ds, "time_limit"))
    assert np.isnan(measures.mean_flow(ds).mean_flow)  # no number is made of an unfinished run


def test_a_gap_in_what_was_seen_is_bridged() -> None:
    ds = crossings(seen([(0, 0.5), None, None, (0, -1.0)]), LINE, DOWN)
    assert ds.exit_time.values.tolist() == [2.0]


def test_a_step_that_ends_on_the_line_crosses_with_the_next() -> None:
    ds = crossings(seen([(0, 0), (0, -0.5), (0, -0.5), (0, -1)]), LINE, DOWN)
    assert ds.exit_time.values.tolist() == [2.0]
    assert int(crossings(seen([(0, 0), (0, -0.5)]), LINE, DOWN).N_out) == 0


def test_the_other_direction_is_another_exit() -> None:
    both = seen([(0, 0), (0, -1)], [(0, -1), (0, 0)])
    assert crossings(both, LINE, DOWN).exit_person.values.tolist() == [0]
    assert crossings(both, LINE, (0.3, 1.0)).exit_person.values.tolist() == [1]


def test_measures_take_it_as_a_run(tmp_path: Path) -> None:
    ds = crossings(read_trajectories(written(tmp_path / "a.txt", walkers([1.0, 1.5, 3.0]))), LINE, DOWN)
    assert measures.delays(ds).delay.values == pytest.approx([0.5, 1.5], abs=1e-4)
    assert measures.mean_flow(ds).mean_flow.item() == pytest.approx(1.0, abs=1e-4)
    assert measures.discharge(ds, [0.0, 1.2, 9.0]).discharge.values.tolist() == [0, 1, 3]


def test_pedpy_counts_the_same_within_a_frame(tmp_path: Path) -> None:
    pedpy = pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")
    rng = np.random.default_rng(3)
    path = written(tmp_path / "a.txt", walkers(np.cumsum(rng.exponential(0.8, 60)) + 1.0))
    ours = crossings(read_trajectories(path), LINE, DOWN).exit_time.values
    trajectories = pedpy.load_trajectory_from_txt(trajectory_file=path)
    _, frames = pedpy.compute_n_t(traj_data=trajectories, measurement_line=pedpy.MeasurementLine(LINE))
    theirs = np.sort(frames.frame.to_numpy()) / 25.0
    assert theirs.size == ours.size == 60
    assert ((theirs - ours >= -1e-4) & (theirs - ours <= 0.04 + 1e-4)).all()


@pytest.mark.parametrize(
    ("line", "towards", "complaint"),
    [
        (((0, 0), (0, 0)), DOWN, "has no length"),
        (((0, 0), (1, 0)), (1, 0), "does not lead across the line"),
        (((0, 0), (1, 0)), (0, 0), "does not lead across the line"),
        (((0, 0), (1, float("nan"))), DOWN, "is not 4 finite numbers"),
        (((0, 0),), DOWN, "is not 4 finite numbers"),
        (LINE, (0, 1, 2), "is not 2 finite numbers"),
    ],
)
def test_a_bad_line_is_refused(line: tuple, towards: tuple, complaint: str) -> None:
    with pytest.raises(BadInput, match=complaint):
        crossings(seen([(0, 0), (0, -1)]), line, towards)


def test_a_dataset_without_places_is_refused() -> None:
    with pytest.raises(BadInput, match="dataset without x has no trajectories"):
        crossings(seen([(0, 0), (0, -1)]).drop_vars("x"), LINE, DOWN)
