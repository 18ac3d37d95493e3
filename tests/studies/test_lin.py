"""Lin's studies: planted data decide the verdicts, a tiny sweep goes from runs to pictures."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from engine import BadInput, Scenario, models, rooms
from studies import faster_to_frozen
from studies.lin import everything, fig4, fig5, fig6, fig7, fig8, fig9, hazard, sweeps
from studies.parisi import sweeps as parisi_sweeps
from studies.presentation.artefact import make
from studies.presentation.verdicts import Verdict
from studies.published import lin2016 as paper
from sweep import Grid
from sweep.cli import _studies
from tests.measures.planted import flagged

SEEDS = 10


def leaving(times, blocked=None, N=100, seeds=SEEDS, noise=0.01, root=2):
    """Runs over axes whose N persons leave at even intervals until the given times, (axes...) s.

    Of each cell so many runs as `blocked`, (axes...), block after a tenth of the crowd.
    """
    rng = np.random.default_rng(root)
    times = np.asarray(times, dtype=float)
    blocked = np.zeros(times.shape) if blocked is None else np.asarray(blocked)
    last = times[..., None] * (1.0 + noise * rng.standard_normal((*times.shape, seeds)))
    stuck = np.arange(seeds) < blocked[..., None]
    exit_time = last[..., None] * np.arange(1, N + 1) / N
    exit_time[stuck, N // 10 :] = np.nan
    return exit_time, stuck, np.nanmax(exit_time, axis=-1) + 120.0 * stuck, N


def over(coords, exit_time, stuck, end_time, N):
    """The same as a gathered dataset."""
    dims = (*coords, "seed")
    persons = np.broadcast_to(np.asarray(N), stuck.shape)
    return xr.Dataset(
        {
            "exit_time": ((*dims, "exit"), exit_time, {"units": "s"}),
            "outcome": flagged(np.where(stuck, 2, 1), dims),
            "end_time": (dims, end_time, {"units": "s"}),
            "N_out": (dims, np.isfinite(exit_time).sum(axis=-1)),
            "persons": (dims, persons.copy()),
        },
        coords={**coords, "seed": np.arange(stuck.shape[-1]), "exit": np.arange(1, exit_time.shape[-1] + 1)},
    )


def held(artefact, **facts):
    verdicts = artefact.verdicts(artefact.measure(SimpleNamespace(**facts)))
    return {v.statement: v.holds for v in verdicts}


def strengths(times, blocked=None):
    both = np.stack([times, times], axis=1)
    return over({"A": list(paper.FIG4_A), "walls": list(sweeps.WALLS)}, *leaving(both, blocked))


def test_leaving_times_as_published_reproduce_figure_4_and_others_do_not():
    assert set(held(fig4, strengths=strengths([170.0, 120.0, 120.0, 120.0])).values()) == {True}
    flat = held(fig4, strengths=strengths([120.0, 120.0, 140.0, 160.0]))
    assert flat["clearance time, A = 200 N"] is False
    assert flat["clearance time, A = 300 N"] is True
    assert flat["time at 200 N over that at 300 N"] is False
    assert flat["300 to 500 N changes the time barely, walls held at 300 N"] is False


def rotation(times, blocked):
    coords = {"v_d": [1.0, 2.0], "inertia": list(sweeps.ROTATION)}
    return over(coords, *leaving(times, blocked, seeds=40))


def test_rotation_must_change_nothing_at_1_and_keep_from_clogging_at_2_metres_a_second():
    as_published = held(fig5, rotation=rotation([[120, 121], [110, 150]], [[0, 0], [8, 30]]))
    assert list(as_published.values()) == [True, True, True]
    other = held(fig5, rotation=rotation([[120, 160], [110, 150]], [[0, 12], [30, 8]]))
    assert list(other.values()) == [False, False, False]
    alike = held(fig5, rotation=rotation([[120, 121], [110, 150]], [[0, 0], [8, 10]]))
    assert list(alike.values())[2] is None


def speeds(clearance, blocked, seeds=SEEDS, sizes=(100, 200, 300), root=2):
    """Over v_d, N and seed: clearance times of 200 persons (v_d,), in proportion for other N; blocked (N, v_d)."""
    columns = []
    for k, N in enumerate(sizes):
        made = leaving(np.array(list(clearance.values())) * N / 200, blocked[k], N, seeds, root=root + k)
        columns.append(over({"v_d": list(clearance)}, *made).expand_dims(N=[N]))
    ds = xr.concat(columns, "N", coords="minimal", compat="override", join="outer")
    ds.outcome.attrs = columns[0].outcome.attrs
    return ds


PUBLISHED = {0.6: 340, 0.8: 270, 1.0: 215, 1.2: 220, 1.4: 220, 1.6: 220, 1.8: 220, 2.0: 220}
FREE = [0, 0, 0, 0, 0]
BLOCKED = [[*FREE, 0, 1, 3], [*FREE, 2, 10, 10], [*FREE, 7, 10, 10]]


def test_times_as_published_reproduce_figures_7_and_8_and_others_do_not():
    ds = speeds(PUBLISHED, BLOCKED)
    assert set(held(fig7, speeds=ds).values()) == {True}
    assert set(held(fig8, speeds=ds).values()) == {True}
    slow = speeds({v: 1.4 * t + 60 * (v == 0.8) for v, t in PUBLISHED.items()}, [[0] * 8] * 3)
    found = held(fig7, speeds=slow)
    assert [found[f"clearance time at {v} m/s"] for v in (0.6, 1.0, 1.2)] == [False] * 3
    assert found["every run blocks from 1.8 m/s"] is False
    assert held(fig8, speeds=slow)["runs both blocked and free at one v_d from 1.6 m/s"] is False
    rising = held(fig8, speeds=speeds({0.6: 300, 0.8: 320, 1.0: 330, 1.2: 280, 1.4: 220}, [[0] * 5] * 3))
    assert list(rising.values())[:2] == [False, False]


def test_blocked_runs_have_no_clearance_time_and_are_counted():
    found = fig7.measure(SimpleNamespace(speeds=speeds(PUBLISHED, BLOCKED)))
    cell = found.sel(v_d=1.6)
    assert (cell.out, cell.blocked, cell.runs) == (8, 2, 10)
    assert cell.clearance_time == pytest.approx(220, rel=0.03)
    assert np.isinf(cell.time_of_run[:2]).all()
    assert np.isnan(found.clearance_time.sel(v_d=2.0))


def test_ten_second_flows_are_held_against_pictures_with_one_run_of_each_cell():
    cells = [np.array([[0.4, 0.6], [0.5, 0.9]]), np.array([[0.3, np.nan], [np.nan, np.nan]])]
    least, most = fig9.redrawn(cells)
    assert set(least) == {0.3}
    assert set(most) == {0.6, 0.9}
    assert 0.45 < (most == 0.9).mean() < 0.55


def test_ten_second_flows_outside_the_published_range_are_told():
    steady = speeds({0.6: 400.0, 1.0: 240.0, 1.6: 220.0}, [[0] * 3] * 3)
    found = held(fig9, speeds=steady)
    assert found["least flow in 10 s, 0.6 m/s"] is True
    assert found["greatest flow in 10 s, 0.6 m/s"] is True
    assert found["least flow in 10 s, from 1.6 m/s"] is False  # nothing ever stops
    fast = held(fig9, speeds=speeds({0.6: 100.0, 1.0: 240.0, 1.6: 220.0}, [[0] * 3] * 3))
    assert fast["greatest flow in 10 s, 0.6 m/s"] is False


def crowds(power, root, seeds=20):
    """Blocked runs over v_d and N by a hazard per exit that grows with a power of the persons inside."""
    rng = np.random.default_rng(root)
    v_d, sizes = [1.4, 1.6, 1.8, 2.0], (100, 200, 300)
    out = np.empty((3, 4, seeds), dtype=int)
    for a, N in enumerate(sizes):
        for b, rate in enumerate((3e-4, 1e-3, 3e-3, 8e-3)):
            failed = rng.random((seeds, N)) < rate * (np.arange(N, 0, -1) / 100) ** power
            out[a, b] = np.where(failed.any(axis=1), failed.argmax(axis=1), N)
    persons = np.broadcast_to(np.array(sizes)[:, None, None], out.shape).copy()
    dims = ("N", "v_d", "seed")
    return xr.Dataset(
        {
            "N_out": (dims, out),
            "persons": (dims, persons),
            "outcome": flagged(np.where(out < persons, 2, 1), dims),
        },
        coords={"N": list(sizes), "v_d": v_d, "seed": np.arange(seeds)},
    )


def ruled_out(power, statement):
    """How many of five sets of runs rule a law out: one in twenty does so by chance."""
    verdicts = [held(hazard, speeds=crowds(power, root)) for root in range(100, 105)]
    return sum(found[statement] is False for found in verdicts)


def test_a_growing_hazard_is_told_from_a_constant_one():
    constant = "constant hazard, from N = 100, tells N = 300"
    growing = "hazard that grows with the crowd, from N = 200, tells N = 300"
    assert ruled_out(2.5, constant) >= 4
    assert ruled_out(0.0, constant) <= 1
    assert ruled_out(2.5, growing) <= 1
    power = "hazard per exit grows with the persons inside"
    assert held(hazard, speeds=crowds(2.5, 100))[power] is True
    assert held(hazard, speeds=crowds(0.0, 100))[power] is None


# --- The force of a contact ---------------------------------------------------------------------------------


def test_a_contact_is_drawn_from_centre_to_centre_or_to_the_wall_with_the_force_of_hertz():
    now = xr.Dataset(
        {
            "x": (("sample", "person"), [[1.0, 1.59], [14.71, 5.0]]),
            "y": (("sample", "person"), [[2.0, 2.0], [3.0, 5.0]]),
            "radius": ("person", [0.3, 0.3]),
            "wall": (("wall", "end"), [[0.0, 0.0, 15.0, 0.0], [15.0, 0.0, 15.0, 7.0]]),
        }
    )
    shot, i, j = np.array([0, 1]), np.array([0, 0]), np.array([1, -2])
    ax, ay, bx, by, force = fig6.contact_lines(now, shot, i, j)
    np.testing.assert_allclose([ax, ay], [[1.0, 14.71], [2.0, 3.0]])
    np.testing.assert_allclose([bx, by], [[1.59, 15.0], [2.0, 3.0]])
    k_n = 2 * 5e6 / (3 * 1.25 * 0.75)
    np.testing.assert_allclose(force, [k_n * 0.15**0.5 * 0.01**1.5, k_n * 0.3**0.5 * 0.01**1.5], rtol=1e-6)


# --- Rooms, grids and the command ---------------------------------------------------------------------------


def test_walls_that_are_held_push_with_300_newton():
    held_walls, followed = (sweeps.strength_room(500.0, walls) for walls in ("held", "as persons"))
    assert (held_walls.model.social.A, held_walls.model.wall_social.A) == (500.0, 300.0)
    assert (followed.model.social.A, followed.model.wall_social.A) == (500.0, 500.0)
    assert sweeps.strength_room(300.0, "held") == sweeps.strength_room(300.0, "as persons")  # is run once
    with pytest.raises(BadInput, match="walls 'soft' is not known: choose one of as persons, held"):
        sweeps.strength_room(300.0, "soft")


@pytest.mark.parametrize("room", ["lin", "parisi"])
def test_either_model_stands_in_either_room_with_the_rooms_crowd(room):
    own = {"lin": rooms.lin_room, "parisi": rooms.parisi_room}[room](v_d=1.5, N=200, seed=3)
    for model, laws in (("lin", models.lin_dem()), ("parisi", models.parisi_dorso())):
        scenario = faster_to_frozen.either_room(model, room, 1.5, 3)
        assert isinstance(scenario, Scenario)
        assert (scenario.scene, scenario.crowd) == (own.scene, own.crowd)
        assert scenario.model == laws
    assert faster_to_frozen.either_room(room, room, 1.5, 3) == own
    with pytest.raises(BadInput, match="room 'square' is not known"):
        faster_to_frozen.either_room("lin", "square", 1.0)


def test_the_command_finds_lins_figures_by_their_plain_names():
    names = _studies()
    assert names["lin"] == "studies.lin.everything"
    for name in everything.ARTEFACTS:
        assert names[name] == f"studies.lin.{name}"
        assert callable(import_module(names[name]).main)
    assert names["faster-to-frozen"] == "studies.faster_to_frozen"
    assert "parisi-fig4" in names
    assert "lin-fig4" not in names


@pytest.mark.parametrize("of", [sweeps, parisi_sweeps])
def test_the_quick_sweeps_are_part_of_the_full_ones(of):
    whole = of.grids(quick=False)
    for name, quick in of.grids(quick=True).items():
        assert all(set(values) <= set(whole[name].axes[axis]) for axis, values in quick.axes.items())
        assert quick.constants == whole[name].constants


def test_the_quick_grid_of_both_models_is_part_of_the_full_one():
    for axis, values in faster_to_frozen.QUICK.axes.items():
        assert set(values) <= set(faster_to_frozen.GRID.axes[axis])


def test_one_grid_serves_figures_7_to_10():
    ds = speeds(PUBLISHED, BLOCKED)
    for name in ("fig7", "fig8", "fig9", "fig10", "hazard"):
        artefact = import_module(f"studies.lin.{name}")
        found = artefact.measure(SimpleNamespace(speeds=ds, quick=False))  # no other sweep is asked for
        assert all(isinstance(v, Verdict) for v in artefact.verdicts(found))


# --- Faster to frozen ---------------------------------------------------------------------------------------


def columns(times, blocked):
    """The same column for both models and rooms."""
    v_d = [0.6, 1.0, 1.5, 2.0, 3.0, 4.0]
    kinds = {"model": ["lin", "parisi"], "room": ["lin", "parisi"]}
    made = leaving(np.broadcast_to(times, (2, 2, 6)), np.broadcast_to(blocked, (2, 2, 6)), 200, 8)
    return over({**kinds, "v_d": v_d}, *made)


def effects(times, blocked):
    found = faster_to_frozen.verdicts(faster_to_frozen.measure(columns(times, blocked)))
    slower, frozen = ({v.holds for v in found if v.statement.startswith(word)} for word in ("faster is", "faster to"))
    (first,), (second,) = slower, frozen
    return first, second


def test_each_effect_is_told_from_the_other():
    assert effects([300, 200, 150, 120, 150, 190], [0] * 6) == (True, False)
    assert effects([300, 200, 150, 150, 150, 150], [0, 0, 0, 4, 8, 8])[1] is True
    assert effects([300, 250, 200, 150, 120, 100], [0] * 6) == (None, False)  # least at the edge
    assert effects([300, 250, 200, 150, 160, 180], [8, 5, 2, 0, 0, 0])[1] is False  # blocks at low speeds


def test_a_crowd_that_blocks_is_never_the_soonest_out():
    found = faster_to_frozen.measure(columns([300, 200, 150, 160, 100, 100], [0, 0, 0, 0, 8, 8]))
    assert (found.v_dt == 1.5).all()


# --- From runs to pictures ----------------------------------------------------------------------------------


@pytest.fixture
def tiny(monkeypatch):
    """The sweeps with a few persons in a small room."""

    def grids(quick):
        small = {"N": 30, "size": 6.0}
        recorded = {"record_every": 30.0, "contacts": True}
        return {
            "speeds": Grid(rooms.lin_room, v_d=[0.6, 1.0, 1.4, 2.0], N=[100, 200, 300], seed=[0], time_limit=2.0),
            "strengths": Grid(sweeps.strength_room, A=list(paper.FIG4_A), walls=sweeps.WALLS, seed=[0]),
            "rotation": Grid(rooms.lin_room, v_d=[1.0, 2.0], inertia=sweeps.ROTATION, seed=range(2), **small),
            "snapshots": Grid(rooms.lin_room, seed=[0], v_d=1.0, **small, **recorded),
        }

    monkeypatch.setattr(sweeps, "grids", grids)


def test_a_tiny_sweep_goes_from_runs_to_pictures(tiny, tmp_path):
    made = sweeps.Sweeps(True, 1, tmp_path)
    for name in everything.ARTEFACTS:
        verdicts = make(import_module(f"studies.lin.{name}"), made)
        assert all(isinstance(v, Verdict) for v in verdicts)
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000


def test_the_page_has_all_verdicts_and_its_pictures():
    found = {"fig4": [Verdict("a", "1", "1", True)], "hazard": [Verdict("b", "2", "3", False)]}
    text = everything.page(found)
    assert "- b: published 2; found 3." in text
    assert "| fig4 | a | 1 | 1 | yes |" in text
    assert all(f"({picture})" in text for picture in everything.PICTURES.values())
