"""What is recorded is what was there, and recording changes nothing."""

import numpy as np
import pytest

from engine import BadInput, Options, rooms, simulate
from engine.kernel import simulation
from engine.scene import from_closest_points
from studies import measures
from sweep import read_run, write_run

PARISI = rooms.parisi_room(v_d=4.0, N=60, seed=3, size=8.0, dt=0.01)
LIN = rooms.lin_room(v_d=1.4, N=40, seed=3, size=6.0, time_limit=15.0, numerics="paper")
BOTH = pytest.mark.parametrize("scenario", [PARISI, LIN], ids=["theta", "velocity_verlet"])


def recorded(scenario, **wanted):
    return simulate(scenario.with_options(record_every=0.02, **wanted))


@BOTH
def test_recording_changes_no_run(scenario):
    plain = simulate(scenario)
    assert plain.N_out > 0
    for run in (recorded(scenario, contacts=True), recorded(scenario, contacts=True, record="positions")):
        assert run.exit_time.tobytes() == plain.exit_time.tobytes()
        assert run.exit_person.tobytes() == plain.exit_person.tobytes()
        assert (run.steps, run.rebuilds, run.max_overlap) == (plain.steps, plain.rebuilds, plain.max_overlap)


def brute_contacts(run, k):
    """Pairs in touch at sample k, and persons at walls, over all pairs of stored positions."""
    x, y, r = run.samples.x[k], run.samples.y[k], run.start.radius
    apart = np.hypot(x[:, None] - x, y[:, None] - y)
    found = {(i, j) for i, j in zip(*np.nonzero(apart < r[:, None] + r), strict=True) if i < j}
    for w, (x0, y0, x1, y1) in enumerate(run.scenario.scene.walls):
        along = np.clip(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2), 0, 1)
        gap = np.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0)) - r
        found |= {(i, -1 - w) for i in np.flatnonzero(gap < 0)}
    return found


@BOTH
def test_contacts_are_those_of_all_pairs(scenario):
    run = recorded(scenario, contacts=True)
    ends = np.cumsum(run.samples.row_size)
    kinds = {"pair": 0, "wall": 0}
    for k, end in enumerate(ends):
        rows = slice(end - run.samples.row_size[k], end)
        i, j = run.samples.contact_i[rows], run.samples.contact_j[rows]
        listed = {(min(a, b), max(a, b)) if b >= 0 else (a, b) for a, b in zip(i.tolist(), j.tolist(), strict=True)}
        assert len(listed) == i.size, "a contact is listed twice"
        assert listed == brute_contacts(run, k), f"sample {k}"
        kinds["pair"] += (j >= 0).sum()
        kinds["wall"] += (j < 0).sum()
    assert min(kinds.values()) > 100
    assert run.samples.tangential_displacement.size == run.samples.contact_i.size


def test_samples_stand_at_whole_multiples_of_the_interval():
    run = recorded(PARISI)
    assert run.samples.time == pytest.approx(0.02 * np.arange(run.samples.time.size))
    assert run.end_time - 0.02 <= run.samples.time[-1] <= run.end_time + PARISI.numerics.dt


@pytest.mark.parametrize("every", [1 / 16, 1 / 30, 0.1, 0.0137])
def test_the_exits_are_equal_bit_by_bit_for_any_interval(every):
    """1/16 and 1/30 s are no multiples of the step of 2 ms."""
    scenario = rooms.lin_room(v_d=1.4, N=40, seed=3, size=6.0, time_limit=15.0)
    plain, run = simulate(scenario), simulate(scenario, record_every=every, contacts=True)
    assert run.exit_time.tobytes() == plain.exit_time.tobytes()
    times = every * np.arange(run.samples.time.size)
    assert np.abs(run.samples.time - times).max() <= 0.5 * scenario.numerics.dt + 1e-12
    assert run.samples.time[-1] > run.end_time - every - scenario.numerics.dt


def test_a_list_that_runs_out_of_room_grows_and_changes_nothing(monkeypatch):
    plain = recorded(LIN, contacts=True)
    for name in ("PAIRS_EACH", "WALLS_EACH"):
        monkeypatch.setattr(simulation, name, 1)
    grown = recorded(LIN, contacts=True)
    assert grown.rebuilds == plain.rebuilds
    for name, values in plain.samples._asdict().items():
        assert np.array_equal(getattr(grown.samples, name), values, equal_nan=True), name


def contacts_of(run):
    """Overlap, reduced radius and mass, parting and slip velocity of all recorded contacts, from the samples."""
    s, start, walls = run.samples, run.start, np.array(run.scenario.scene.walls)
    k, i, j = np.repeat(np.arange(s.time.size), s.row_size), s.contact_i, s.contact_j
    between = j >= 0
    dx, dy = from_closest_points(walls[np.where(between, 0, -1 - j)], s.x[k, i], s.y[k, i])
    dx, dy = np.where(between, s.x[k, i] - s.x[k, j], dx), np.where(between, s.y[k, i] - s.y[k, j], dy)
    distance = np.hypot(dx, dy)
    nx, ny = dx / distance, dy / distance
    ux, uy = (v[k, i] - np.where(between, v[k, j], 0.0) for v in (s.vx, s.vy))
    of_spin = start.radius[i] * s.spin[k, i] + np.where(between, start.radius[j] * s.spin[k, j], 0.0)
    overlap = start.radius[i] + np.where(between, start.radius[j], 0.0) - distance
    reduced = [np.where(between, v[i] * v[j] / (v[i] + v[j]), v[i]) for v in (start.radius, start.mass)]
    return between, overlap, *reduced, ux * nx + uy * ny, uy * nx - ux * ny - of_spin


def test_recorded_forces_of_solved_contacts_are_the_laws_at_what_is_recorded_beside_them():
    run = recorded(PARISI, contacts=True)
    between, overlap, _radius, _mass, v_n, v_t = contacts_of(run)
    p, kappa = run.scenario.model.normal, run.scenario.model.friction.kappa
    assert min(between.sum(), (~between).sum()) > 100
    assert run.samples.contact_F_n == pytest.approx(p.k_n * overlap - p.g_n * v_n, abs=1e-6)
    assert run.samples.contact_F_t == pytest.approx(-kappa * overlap * v_t, abs=1e-6)


def test_recorded_forces_of_springs_are_the_laws_at_the_recorded_overlap_and_displacement():
    """Up to damping, which acted at the velocities of half a step before."""
    run = recorded(LIN, contacts=True)
    between, overlap, radius, mass, _v_n, _v_t = contacts_of(run)
    F_n, F_t, displacement = (
        getattr(run.samples, name) for name in ("contact_F_n", "contact_F_t", "tangential_displacement")
    )
    normal, friction, kinetic = run.scenario.model.normal, run.scenario.model.friction, run.scenario.model.wall_friction
    alpha = np.sqrt(radius * overlap)
    damping = normal.g_n * mass * alpha * 2.0 * run.max_speed
    assert (np.abs(F_n - normal.k_n * alpha * overlap) <= damping + 1e-6).all()
    holds = displacement != 0.0
    assert (holds & between).sum() > 100
    assert (np.abs(F_t + friction.k_t * alpha * displacement) <= damping + 1e-6)[holds].all()
    slips = between & ~holds
    assert np.abs(F_t[slips]) == pytest.approx(friction.mu * np.abs(F_n[slips]), rel=1e-9)
    assert (np.abs(F_t[~between]) <= kinetic.mu * np.abs(F_n[~between]) * (1 + 1e-12)).all()


def test_nothing_but_what_is_asked_for_is_recorded():
    run = recorded(PARISI, contacts=True, record="positions")
    whole = recorded(PARISI, contacts=True)
    assert np.array_equal(run.samples.x, whole.samples.x, equal_nan=True)
    assert np.array_equal(run.samples.contact_j, whole.samples.contact_j)
    for name in ("vx", "vy", "spin", "tangential_displacement", "contact_F_n", "contact_F_t"):
        assert getattr(run.samples, name).size == 0
        assert getattr(whole.samples, name).size > 0
    assert recorded(PARISI, record="positions").samples.contact_i.size == 0


def test_an_unknown_record_is_refused():
    with pytest.raises(BadInput, match="record 'all' is not known: choose one of full, positions"):
        Options(record_every=0.1, record="all")


@pytest.fixture(scope="module")
def clogged():
    scenario = rooms.parisi_room(v_d=4.0, seed=1, record_every=0.02, contacts=True, record="positions")
    return simulate(scenario)


def test_a_run_of_200_persons_makes_a_file_below_3_megabytes(clogged, tmp_path):
    write_run(clogged, tmp_path / "run.nc")
    assert clogged.samples.time.size > 3000
    assert (tmp_path / "run.nc").stat().st_size < 3e6
    ds = read_run(tmp_path / "run.nc")
    assert np.array_equal(np.isnan(ds.x), np.isnan(clogged.samples.x))
    assert np.nanmax(np.abs(ds.y.values - clogged.samples.y)) <= 0.5e-3 + 1e-9
    assert not {"vx", "spin", "tangential_displacement", "contact_F_n"} & set(ds.variables)
    assert ds.wall.values.tolist() == [list(wall) for wall in clogged.scenario.scene.walls]
    assert ds.door.values.tolist() == [[20.0, 9.4, 20.0, 10.6]]


def test_measures_find_the_clusters_that_positions_at_full_precision_make(clogged, tmp_path):
    """The largest cluster at every hundredth sample, by flooding the brute-force contacts of those inside."""
    write_run(clogged, tmp_path / "run.nc")
    largest = measures.granular_clusters(read_run(tmp_path / "run.nc")).largest_cluster.values
    left = np.full(clogged.N, np.inf)
    left[clogged.exit_person] = clogged.exit_time
    for k in range(0, largest.size, 100):
        inside = left > clogged.samples.time[k]
        pairs = [(i, j) for i, j in brute_contacts(clogged, k) if j >= 0 and inside[i] and inside[j]]
        assert largest[k] == largest_flooded(pairs)
    assert largest.max() > 10


def largest_flooded(pairs):
    group = {person: {person} for pair in pairs for person in pair}
    for i, j in pairs:
        if group[i] is not group[j]:
            joined = group[i] | group[j]
            for person in joined:
                group[person] = joined
    return max(map(len, group.values()), default=0)


def test_a_crowd_that_presses_somebody_deep_into_the_edge_of_the_door_is_no_unstable_run():
    runs = [simulate(rooms.parisi_room(v_d=8.0, seed=seed)) for seed in (5, 6, 7)]
    deep = [run for run in runs if run.max_overlap > 0.75 * min(run.start.radius)]
    assert deep
    assert all(run.outcome == "all_out" for run in deep)
