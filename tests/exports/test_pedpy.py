"""PedPy reads every form of an export, and counts as we do."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import rooms, simulate
from studies import measures
from sweep import to_dataset
from sweep.exports import to_pedpy, write_hdf5, write_sqlite, write_text
from tests.exports.walks import walked

pedpy = pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")

FORMS = {
    "m.txt": (write_text, "load_trajectory_from_txt"),
    "cm.txt": (lambda run, path: write_text(run, path, "cm"), "load_trajectory_from_txt"),
    "h5": (write_hdf5, "load_trajectory_from_ped_data_archive_hdf5"),
    "sqlite": (write_sqlite, "load_trajectory_from_jupedsim_sqlite"),
}
AREAS = {
    "h5": pedpy.load_walkable_area_from_ped_data_archive_hdf5,
    "sqlite": pedpy.load_walkable_area_from_jupedsim_sqlite,
}
OBLIQUE = {"doors": ((0.0, 0.0, 0.7, 0.7), (5.0, -3.123, 5.0, -2.0)), "outward": ((-1, 1), (1, 0)), "walls": ()}
WALKS = {
    "straight": {},
    "on a frame": {"times": (0.5, 1.0, 1.7)},
    "in one frame": {"times": (0.51, 0.55, 0.59)},
    "creeping, to 1 mm": {"speed": 0.002, "rounded": 3},
    "creeping, rounded to beyond": {"speed": 0.002, "rounded": 3, "doors": ((3.9996, 1.0, 3.9996, 3.0),)},
    "creeping on, to 1 mm": {"speed": 0.002, "rounded": 3, "walk_on": 1.0},
    "walking on": {"walk_on": 0.35},
    "two doors, one oblique": OBLIQUE,
    "25.3 frames a second": {"rate": 25.3},
}


def curve(trajectories: object, line: object) -> tuple[np.ndarray, np.ndarray]:
    """Times and persons out by PedPy."""
    found, _ = pedpy.compute_n_t(traj_data=trajectories, measurement_line=line)
    return found.time.to_numpy(), found.cumulative_pedestrians.to_numpy()


def assert_same_curves(run: xr.Dataset, trajectories: object, lines: tuple[object, ...]) -> None:
    for door, line in enumerate(lines):
        time, out = curve(trajectories, line)
        when = run.exit_time.values[run.exit_door.values == door]
        assert out.tolist() == [(when <= t).sum() for t in time]
        assert out[-1] == when.size


RATES = {"lin": 25.0, "lin, between steps": 30.0, "parisi": 25.0}  # frames a second; the step of lin is 4 ms


@pytest.fixture(scope="module", params=RATES)
def run(request: pytest.FixtureRequest) -> xr.Dataset:
    sampled = {"N": 30, "size": 6.0, "record_every": 1.0 / RATES[request.param], "time_limit": 200.0}
    if request.param == "parisi":
        return to_dataset(simulate(rooms.parisi_room(v_d=2.0, record="positions", **sampled)))
    return to_dataset(simulate(rooms.lin_room(v_d=1.2, **sampled)))


def rate_of(run: xr.Dataset) -> float:
    return float(np.round(1.0 / run.time.diff("sample").mean(), 1))


@pytest.mark.parametrize("name", WALKS)
@pytest.mark.parametrize("form", FORMS)
def test_every_form_has_each_person_cross_in_the_first_frame_after_leaving(
    name: str, form: str, tmp_path: Path
) -> None:
    random = np.sort(np.random.default_rng(5).uniform(0.3, 3.9, 20))
    run = walked(**{"times": random} | WALKS[name])
    write, load = FORMS[form]
    path = tmp_path / f"run.{form}"
    write(run, path)
    assert_same_curves(run, getattr(pedpy, load)(trajectory_file=path), to_pedpy(run).lines)


def test_the_n_t_curve_of_a_simulated_run_is_ours(run: xr.Dataset, tmp_path: Path) -> None:
    shown = to_pedpy(run)
    assert_same_curves(run, shown.trajectories, shown.lines)
    time, out = curve(shown.trajectories, shown.lines[0])
    assert out.tolist() == measures.discharge(run, time).discharge.values.tolist()
    for form, (write, load) in FORMS.items():
        write(run, tmp_path / form)
        read = getattr(pedpy, load)(trajectory_file=tmp_path / form)
        assert np.array_equal(curve(read, shown.lines[0])[1], out), form
        assert read.frame_rate == shown.trajectories.frame_rate == rate_of(run)


def test_the_flow_of_pedpy_is_ours(run: xr.Dataset) -> None:
    shown = to_pedpy(run)
    nt, frames = pedpy.compute_n_t(traj_data=shown.trajectories, measurement_line=shown.lines[0])
    last = nt[nt.cumulative_pedestrians == nt.cumulative_pedestrians.max()].time.min()
    ours = float(measures.mean_flow(run).mean_flow)
    assert nt.cumulative_pedestrians.max() / last == pytest.approx(ours, rel=0.01)

    speed = pedpy.compute_individual_speed(
        traj_data=shown.trajectories, frame_step=5, speed_calculation=pedpy.SpeedCalculation.BORDER_SINGLE_SIDED
    )
    over_all = int(frames.frame.max() - frames.frame.min())  # compute_flow counts from the first crossing
    theirs = pedpy.compute_flow(
        nt=nt, crossing_frames=frames, individual_speed=speed, delta_frame=over_all, frame_rate=rate_of(run)
    )
    since_first = int(run.persons) / float(run.exit_time[-1] - run.exit_time[0])
    assert theirs.flow.to_list() == pytest.approx([since_first], rel=0.01)


def test_pedpy_measures_density_in_the_area(run: xr.Dataset) -> None:
    shown = to_pedpy(run)
    assert pedpy.is_trajectory_valid(traj_data=shown.trajectories, walkable_area=shown.area)
    x0, y0, x1, y1 = (
        run.wall.values.min(),
        run.wall.values.min(),
        6.0 + 1e-9,
        6.0,
    )  # whoever stands on the line is inside
    whole = pedpy.MeasurementArea([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    density = pedpy.compute_classic_density(traj_data=shown.trajectories, measurement_area=whole)
    times = np.arange(run.sizes["sample"]) / rate_of(run)
    inside = int(run.persons) - measures.discharge(run, times).discharge.values
    assert density.density.to_numpy()[: inside.size] * 36.0 == pytest.approx(inside)
    few = shown.trajectories[0:3]
    cells = pedpy.compute_individual_voronoi_polygons(traj_data=few, walkable_area=shown.area)
    first = cells[cells.frame == 0]
    assert sum(cell.area for cell in first.polygon) == pytest.approx(shown.area.area)


@pytest.mark.parametrize("form", AREAS)
def test_files_carry_the_room_and_a_porch(form: str, tmp_path: Path) -> None:
    run = walked([0.5, 1.0])
    write, _ = FORMS[form]
    write(run, tmp_path / form)
    area = AREAS[form](trajectory_file=tmp_path / form).polygon
    assert area.equals(to_pedpy(run).area.polygon)
    assert area.area == pytest.approx(4.0 * 4.0 + 2.0 * 1.0)  # the door is 2 m wide, the porch 1 m deep
    assert not area.covers(area.envelope)


def test_an_obstacle_is_a_hole_and_an_open_room_a_rectangle() -> None:
    run = walked([0.5, 3.0])
    box = [(1, 1, 1.5, 1), (1.5, 1, 1.5, 1.5), (1.5, 1.5, 1, 1.5), (1, 1.5, 1, 1)]
    with_box = run.drop_vars("wall").assign(wall=(("wall", "end"), np.vstack([run.wall.values, box])))
    assert to_pedpy(with_box).area.area == pytest.approx(18.0 - 0.25)
    from_outside = to_pedpy(walked([0.5, 5.5]))
    assert pedpy.is_trajectory_valid(traj_data=from_outside.trajectories, walkable_area=from_outside.area)
    open_room = to_pedpy(run.isel(wall=slice(1, None)))
    assert open_room.area.polygon.equals(open_room.area.polygon.envelope)
    assert pedpy.is_trajectory_valid(traj_data=open_room.trajectories, walkable_area=open_room.area)


def test_jupedsim_finds_its_tables(tmp_path: Path) -> None:
    jupedsim = pytest.importorskip("jupedsim", reason="JuPedSim is not installed: pip install '.[bench]'")
    run = walked([0.5, 1.0])
    write_sqlite(run, tmp_path / "run.sqlite")
    recording = jupedsim.Recording(str(tmp_path / "run.sqlite"))
    assert (recording.fps, recording.num_frames) == (10.0, 12)
    assert recording.geometry().area == pytest.approx(18.0)
    assert (recording.bounds().xmin, recording.bounds().xmax) == (0.0, 5.0)
    first = recording.frame(0).agents[0]
    assert first.position == pytest.approx((3.5, 2.0))
    assert first.orientation == pytest.approx((1.0, 0.0))
