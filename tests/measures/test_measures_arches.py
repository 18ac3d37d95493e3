"""Blocking clusters, the log of arches and the arch-clogging correlation, against hand-made and brute-force answers."""

from itertools import pairwise

import numpy as np
import pytest
import xarray as xr

from studies.measures import (
    arch_clogging,
    arch_clogging_correlation,
    arches,
    blocking_clusters,
    blocking_probability,
    contact_counts,
)
from tests.measures.recorded import ARCH, DOORS, FAR, LOWER, PLACES, UPPER, WALLS, ragged, recorded, scribbled, without

# Squared distances to the door's centre: 0.45, 0.36, 0.45 m2 of the arch, 0.04 of person 3, 1.44 of person 4.
INNER = ((0, LOWER), (0, 3), (3, 2), (2, UPPER))


def log_of(run: xr.Dataset, clean: bool = True) -> list[tuple]:
    """Begin, end and members of each arch; None for no end."""
    log = arches(run, clean=clean)
    ends = [None if np.isnan(end) else round(float(end), 9) for end in log.end_time]
    begins = [round(float(begin), 9) for begin in log.begin_time]
    return list(zip(begins, ends, ragged(log.arch_person, log.arch_size), strict=True))


# --- Blocking clusters ---


def test_an_arch_shuts_the_door_when_its_last_contact_closes():
    run = recorded([without(ARCH, (2, UPPER)), without(ARCH, (1, 2)), ARCH, ARCH], PLACES[:3])
    found = blocking_clusters(run)
    assert found.blocking.values.tolist() == [False, False, True, True]
    assert found.clean.values.tolist() == [False, False, True, True]
    assert found.path_size.values.tolist() == [0, 0, 3, 3]
    assert found.path_person.values.tolist() == [0, 1, 2, 0, 1, 2]


def test_a_chain_that_leans_on_one_side_or_on_a_wall_elsewhere_is_no_arch():
    one_side = [(0, LOWER), (0, 1), (1, 2), (2, LOWER)]
    elsewhere = [(0, LOWER), (0, 1), (1, 2), (2, FAR)]
    assert not blocking_clusters(recorded([one_side, elsewhere])).blocking.any()


def test_one_person_who_touches_both_sides_is_an_arch():
    found = blocking_clusters(recorded([[(3, LOWER), (3, UPPER)], []]))
    assert found.path_person.values.tolist() == [3]
    assert found.clean.values.tolist() == [True, False]


def test_the_path_of_least_squared_distances_is_the_blocking_cluster():
    # 0-1-2 weighs 1.26 m2, 0-3-2 0.94 m2; 0-4-2 has as few persons and weighs 2.34 m2.
    behind = ((0, 4), (4, 2))
    found = blocking_clusters(recorded([ARCH + behind, ARCH + behind + INNER[1:3]]))
    assert found.path_person.values.tolist() == [0, 1, 2, 0, 3, 2]


def test_somebody_inside_the_arch_makes_it_not_clean():
    found = blocking_clusters(recorded([ARCH] * 3, exits=[(0.7, 3)]))
    assert found.blocking.values.tolist() == [True, True, True]
    assert found.clean.values.tolist() == [False, False, True]


def test_who_stands_behind_the_arch_is_not_inside_it():
    places = [*PLACES[:3], (-0.62, 0.0), (-0.3, 0.7), (-0.01, -0.61)]
    assert blocking_clusters(recorded([ARCH] * 2, places)).clean.all()


def test_an_arch_far_from_the_door_is_found():
    places = [(-0.3, -9.0), (-9.0, 0.0), (-0.3, 9.0)]
    assert blocking_clusters(recorded([ARCH] * 2, places)).path_person.values.tolist() == [0, 1, 2] * 2


def test_one_person_farther_off_may_weigh_less_than_three_nearer_ones():
    near = [(-1.0, -2.07), (-2.3, 0.0), (-1.0, 2.07)]  # 5.3 m2 each, within two widths of the door
    run = recorded([[*ARCH, (3, LOWER), (3, UPPER)]] * 2, [*near, (-2.5, 0.0)])  # 6.25 m2, beyond
    assert blocking_clusters(run).path_person.values.tolist() == [3, 3]


def test_somebody_in_the_very_centre_of_the_door_weighs_nothing_and_is_still_in_touch():
    found = blocking_clusters(recorded([ARCH + INNER[1:3]] * 2, [*PLACES[:3], (0.0, 0.0)]))
    assert found.path_person.values.tolist() == [0, 3, 2] * 2


def test_a_contact_listed_twice_weighs_no_more_than_once():
    behind = ((0, 4), (4, 2))
    found = blocking_clusters(recorded([(*ARCH, (0, LOWER), *[(0, 1)] * 4, *behind)] * 2))
    assert found.path_person.values.tolist() == [0, 1, 2] * 2


def test_nobody_in_touch_is_no_arch():
    run = recorded([[], []])
    assert not blocking_clusters(run).blocking.any()
    assert arches(run).sizes["arch"] == 0
    assert arch_clogging(recorded([[]] * 9, exits=[(1.0, 0), (2.0, 1)])).clogged.values.tolist() == [0.0]


def all_paths(run: xr.Dataset, sample: int) -> list[list[int]]:
    """Every simple path of persons inside from the lower to the upper side at a sample."""
    rows = slice(int(run.row_size[:sample].sum()), int(run.row_size[: sample + 1].sum()))
    gone = set(run.exit_person.values[run.exit_time.values <= run.time.values[sample]].tolist())
    contacts = [tuple(pair) for pair in np.column_stack([run.contact_i[rows], run.contact_j[rows]]).tolist()]
    contacts = [(i, j) for i, j in contacts if i not in gone and j not in gone]
    neighbours = {p: {j for i, j in contacts if i == p} | {i for i, j in contacts if j == p} for p in range(99)}

    def grown(path):
        if UPPER in neighbours[path[-1]]:
            yield path
        for other in neighbours[path[-1]]:
            if other >= 0 and other not in path:
                yield from grown([*path, other])

    return [path for start, wall in contacts if wall == LOWER for path in grown([start])]


def weight(run: xr.Dataset, sample: int, path: list[int]) -> float:
    return sum(float(run.x[sample, p]) ** 2 + float(run.y[sample, p]) ** 2 for p in path)


def encloses(run: xr.Dataset, sample: int, path: list[int]) -> bool:
    """Whether anybody else inside is in the polygon, by rays upwards."""
    x, y = run.x.values[sample].astype(float), run.y.values[sample].astype(float)
    gone = set(run.exit_person.values[run.exit_time.values <= run.time.values[sample]].tolist())
    corners = [(0.0, -0.6), *((x[p], y[p]) for p in path), (0.0, 0.6), (0.0, -0.6)]
    for p in set(range(x.size)) - gone - set(path):
        crossings = 0
        for (ax, ay), (bx, by) in pairwise(corners):
            if (ax > x[p]) != (bx > x[p]):
                crossings += ay + (by - ay) * (x[p] - ax) / (bx - ax) > y[p]
        if crossings % 2:
            return True
    return False


@pytest.mark.parametrize(
    ("touch", "lean", "wide"), [(0.15, 0.4, 0.9), (0.3, 0.2, 2.0), (0.3, 0.2, 8.0), (0.5, 0.1, 3.0)]
)
def test_paths_are_the_lightest_of_all_and_clean_if_they_enclose_nobody(touch, lean, wide):
    run = scribbled(120, 7, seed=11, touch=touch, lean=lean, wide=wide)
    found = blocking_clusters(run)
    rows = ragged(found.path_person, found.path_size)
    several = 0
    for sample in range(120):
        paths = all_paths(run, sample)
        several += len(paths) > 1
        assert bool(found.blocking[sample]) == bool(paths)
        if paths:
            best = min(paths, key=lambda path: weight(run, sample, path))
            assert rows[sample] == best
            assert bool(found.clean[sample]) == (not encloses(run, sample, best))
    assert several > 15
    assert 0 < found.clean.sum() < found.blocking.sum()


# --- Arches ---


def test_an_arch_lives_until_it_breaks():
    assert log_of(recorded([[], ARCH, ARCH, []], PLACES[:3])) == [(0.5, 1.5, [0, 1, 2])]


@pytest.mark.parametrize("lost", ARCH)
def test_an_arch_that_loses_a_contact_or_a_side_and_finds_it_again_is_another(lost):
    run = recorded([ARCH, ARCH, without(ARCH, lost), ARCH, ARCH], PLACES[:3])
    assert log_of(run) == [(0.0, 1.0, [0, 1, 2]), (1.5, None, [0, 1, 2])]


def test_an_arch_breaks_when_a_member_has_crossed_the_exit_though_still_in_touch():
    assert log_of(recorded([ARCH] * 5, PLACES[:3], exits=[(1.2, 1)])) == [(0.0, 1.5, [0, 1, 2])]


def test_an_arch_alive_at_the_last_sample_is_censored():
    log = arches(recorded([[], ARCH, ARCH], PLACES[:3]))
    assert log.begin_time.values.tolist() == [0.5]
    assert log.end_time.isnull().all()
    assert log.lifetime.isnull().all()


def test_an_arch_behind_a_nearer_one_lives_on_and_is_not_new_when_it_is_the_nearest_again():
    both = ARCH + INNER[1:3]
    run = recorded([ARCH, both, ARCH, without(ARCH, (1, 2))])
    assert log_of(run, clean=False) == [(0.0, 1.5, [0, 1, 2]), (0.5, 1.0, [0, 3, 2])]


def test_a_clean_arch_begins_when_it_is_first_seen_clean():
    run = recorded([ARCH] * 4 + [[]], exits=[(0.7, 3)])
    assert log_of(run, clean=False) == [(0.0, 2.0, [0, 1, 2])]
    assert log_of(run) == [(1.0, 2.0, [0, 1, 2])]


def test_a_clean_arch_lives_on_when_somebody_gets_inside():
    places = np.array([PLACES] * 5)
    places[[0, 1], 3] = (-3.0, 0.0)
    assert log_of(recorded([ARCH] * 4 + [[]], places)) == [(0.0, 2.0, [0, 1, 2])]


def test_a_side_is_touched_through_any_of_its_walls():
    walls = [*WALLS, (0.0, 0.6, 5.0, 0.6)]
    corner = (2, -4)
    turned = [*without(ARCH, (2, UPPER)), corner]
    run = recorded([ARCH, turned, turned, without(turned, corner)], PLACES[:3], walls=walls)
    assert log_of(run) == [(0.0, 1.5, [0, 1, 2])]


def arches_sample_by_sample(run: xr.Dataset, clean: bool) -> list[tuple]:
    """The log as statistics.md words it: live arches, sample by sample."""
    found = blocking_clusters(run)
    rows = iter(ragged(found.path_person, found.path_size))
    rows = {s: next(rows) for s in range(run.sizes["sample"])}
    live, log, start = [], [], 0
    for sample, time in enumerate(run.time.values):
        gone = set(run.exit_person.values[run.exit_time.values <= time].tolist())
        stop = start + int(run.row_size[sample])
        now = {frozenset(pair) for pair in np.column_stack([run.contact_i, run.contact_j])[start:stop].tolist()}
        now = {pair for pair in now if not pair & gone}
        start = stop
        for arch in list(live):
            if not all(frozenset(pair) in now for pair in pairwise([LOWER, *arch[1], UPPER])):
                live.remove(arch)
                log.append((arch[0], round(float(time), 9), arch[1]))
        path = rows[sample]
        if path and (found.clean[sample] or not clean) and path not in [arch[1] for arch in live]:
            live.append((round(float(time), 9), path))
    return log + [(begin, None, path) for begin, path in live]


@pytest.mark.parametrize("clean", [True, False])
@pytest.mark.parametrize("seed", range(6))
def test_the_log_is_that_of_keeping_live_arches_sample_by_sample(clean, seed):
    run = scribbled(200, 7, seed, touch=0.4, lean=0.5, change=0.06, wide=1.0)
    expected = arches_sample_by_sample(run, clean)
    assert len(expected) > 5
    assert sorted(map(repr, log_of(run, clean))) == sorted(map(repr, expected))


def test_paths_found_before_are_taken_and_those_of_another_run_refused():
    run = scribbled(60, 7, 1, touch=0.4, lean=0.5, change=0.1, wide=1.0)
    xr.testing.assert_identical(arches(run, paths_of=blocking_clusters(run)), arches(run))
    with pytest.raises(ValueError, match="paths_of has contacts that the run does not have"):
        arches(run, paths_of=blocking_clusters(recorded([ARCH] * 60, PLACES[:3])))


# --- Arch-clogging correlation ---

# Samples every 0.1 s; 0 leaves after the arch 0-1-2 held from 0.5 s on.
TWICE = [[]] * 5 + [ARCH] * 15 + [[]] * 40
CROWD = [*PLACES[:3], (-3.0, 0.0), (-4.0, 0.0)]


def f_of(run: xr.Dataset, **options) -> list[float]:
    return arch_clogging(run, **options).clogged.values.tolist()


def test_a_delay_ended_by_a_member_of_the_arch_that_broke_is_clogged():
    run = recorded(TWICE, CROWD, exits=[(1.0, 3), (2.3, 0), (3.0, 4)], step=0.1)  # it breaks at 2.0 s
    found = arch_clogging(run)
    np.testing.assert_allclose(found.delay_time, [1.3, 0.7])
    assert found.clogged.values.tolist() == [1.0, 0.0]
    assert found.delay_count.values.tolist() == [0, 1, 1, 0]
    assert found.clogged_count.values.tolist() == [0, 0, 1, 0]


def test_an_arch_that_broke_clogged_nobody_but_its_members():
    assert f_of(recorded(TWICE, CROWD, exits=[(1.0, 3), (2.3, 4)], step=0.1)) == [0.0]


def test_an_arch_that_broke_before_the_delay_began_did_not_clog_it():
    assert f_of(recorded(TWICE, CROWD, exits=[(2.05, 3), (2.3, 0)], step=0.1)) == [0.0]
    assert f_of(recorded(TWICE, CROWD, exits=[(1.95, 3), (2.3, 0)], step=0.1)) == [1.0]
    assert f_of(recorded(TWICE, CROWD, exits=[(2.0, 3), (2.3, 0)], step=0.1)) == [1.0]


def test_a_break_seen_within_one_sampling_interval_of_the_exit_counts():
    # 0 leaves at 1.42 s, which breaks its arch; that is seen at 1.5 s.
    stays = [[]] * 5 + [ARCH] * 60
    assert f_of(recorded(stays, CROWD, exits=[(1.0, 3), (1.42, 0)], step=0.1)) == [1.0]
    assert f_of(recorded(stays, CROWD, exits=[(1.0, 3), (1.42, 4)], step=0.1)) == [0.0]


def test_an_arch_that_is_not_clean_counts_only_among_any():
    places = [*CROWD[:4], (-0.2, 0.0)]
    run = recorded(TWICE, places, exits=[(1.0, 3), (2.3, 0)], step=0.1)
    assert f_of(run) == [0.0]
    assert f_of(run, clean=False) == [1.0]


def test_delays_and_arches_are_those_of_one_door():
    doors = [*DOORS, (-20.0, 10.0, -20.0, 12.0)]
    walls = [*WALLS, (-20.0, 12.0, -20.0, 20.0)]
    run = recorded(TWICE, CROWD, [(1.0, 3), (2.0, 4), (2.3, 0)], 0.1, walls=walls, doors=doors, exit_door=[0, 1, 0])
    np.testing.assert_allclose(arch_clogging(run).delay_time, [1.3])
    assert f_of(run) == [1.0]
    assert f_of(run, door=1) == []
    assert not blocking_clusters(run, door=1).blocking.any()


def test_an_unstable_run_counts_nothing():
    found = contact_counts(recorded(TWICE, CROWD, [(1.0, 3), (2.3, 0)], 0.1, outcome="unstable"))
    for name in ("samples", "blocked_samples", "delay_count", "clogged_count", "arch_count"):
        assert found[name].sum() == 0
    assert not found.censored


def test_arches_are_counted_by_size_with_the_longest_life_of_those_that_broke():
    later = [*TWICE, [(4, LOWER), (4, UPPER)]]  # alive at the end
    found = contact_counts(recorded(later, CROWD, [(1.0, 3), (2.3, 0)], 0.1)).sel(kind="any")
    assert found.arch_count.values.tolist() == [1, 0, 1] + [0] * 27
    np.testing.assert_allclose(found.longest_lifetime, [np.nan, np.nan, 1.5] + [np.nan] * 27)


def test_arches_of_thirty_persons_and_more_are_counted_together():
    def chain(size):
        return [(0, LOWER), *[(k, k + 1) for k in range(size - 1)], (size - 1, UPPER)]

    crowd = [(-3.0, 0.1 * k) for k in range(33)]
    found = contact_counts(recorded([chain(29), chain(30), chain(33)], crowd)).sel(kind="any")
    assert found.arch_count.values.tolist() == [0] * 28 + [1, 2]


def side_by_side(*runs: xr.Dataset) -> xr.Dataset:
    return xr.concat([contact_counts(run) for run in runs], "seed").assign_coords(seed=range(len(runs)))


def runs_of_three_kinds() -> xr.Dataset:
    clogged = recorded(TWICE, CROWD, [(1.0, 3), (2.3, 0), (3.0, 4)], 0.1, outcome="all_out")  # 1.3 s: 1, 0.7 s: 0
    free = recorded([[]] * 60, [*CROWD, (-5.0, 0.0)], [(1.0, 3), (2.3, 0)], 0.1, outcome="blocked")  # 1.3 s: 0
    inside = [*CROWD[:4], (-0.2, 0.0)]
    unclean = recorded(TWICE, inside, [(1.0, 3), (2.3, 0)], 0.1)  # 1.3 s: 1 of any, 0 of clean
    return side_by_side(clogged, free, unclean)


def test_delays_of_all_runs_are_pooled_bin_by_bin():
    found = arch_clogging_correlation(runs_of_three_kinds())
    nan = np.nan
    np.testing.assert_allclose(found.c_ac.sel(kind="any"), [nan, 0.0, 2 / 3, nan])
    np.testing.assert_allclose(found.c_ac.sel(kind="clean"), [nan, 0.0, 1 / 3, nan])
    assert found.delays.values.tolist() == [0, 1, 3, 0]
    assert found.runs.values.tolist() == [0, 1, 3, 0]
    assert found.censored == 2
    assert found.c_ac_high.sel(kind="any", delay=0.3).isnull()
    assert found.c_ac_low.sel(kind="any", delay=1.0) < 2 / 3 < found.c_ac_high.sel(kind="any", delay=1.0)


def test_blocking_probability_is_the_share_of_samples_up_to_the_last_exits():
    found = blocking_probability(runs_of_three_kinds())
    # 31, 24 and 24 samples up to 3.0, 2.3 and 2.3 s; 15 with an arch in the first and the last run.
    assert found.samples == 79
    np.testing.assert_allclose(found.blocking_probability, [30 / 79, 15 / 79])
    assert found.blocking_probability.kind.values.tolist() == ["any", "clean"]
    assert (found.runs, found.censored) == (3, 2)


def test_axes_of_a_grid_stay_and_constants_too():
    rows = [runs_of_three_kinds(), runs_of_three_kinds()]
    wide = xr.concat(rows, "v_d").assign_coords(v_d=[1.0, 2.0], A=2000.0)
    found = arch_clogging_correlation(wide)
    assert dict(found.c_ac.sizes) == {"v_d": 2, "kind": 2, "delay": 4}
    assert found.A == 2000.0
    xr.testing.assert_equal(
        found.c_ac.isel(v_d=1, drop=True), arch_clogging_correlation(rows[0]).c_ac.assign_coords(A=2000.0)
    )


def test_runs_of_a_grid_are_combined_by_their_coordinates_and_holes_count_nothing():
    run = recorded(TWICE, CROWD, [(1.0, 3), (2.3, 0)], 0.1)
    larger = recorded(TWICE, [*CROWD, (-5.0, 0.0)], [(1.0, 3), (2.3, 0)], 0.1)
    cells = [(1.0, 0, run), (1.0, 1, run), (2.0, 0, larger), (2.0, 1, larger)]
    counts = [contact_counts(run).expand_dims(v_d=[v_d], seed=[seed]) for v_d, seed, run in cells]
    grid = xr.combine_by_coords(counts, data_vars="all")
    found = arch_clogging_correlation(grid.where((grid.v_d < 2.0) | (grid.seed < 1)).reindex(seed=[0, 1, 2]))
    assert found.delays.sel(delay=1.0).values.tolist() == [2, 1]
    assert found.runs.sel(delay=1.0).values.tolist() == [2, 1]
    assert found.censored.values.tolist() == [2, 1]
    assert found.c_ac.sel(delay=1.0, kind="clean").values.tolist() == [1.0, 1.0]


def test_every_variable_carries_units_and_a_name():
    run, runs = recorded(TWICE, CROWD, [(1.0, 3), (2.3, 0)], 0.1), runs_of_three_kinds()
    each = [blocking_clusters(run), arches(run), arch_clogging(run), contact_counts(run)]
    for found in (*each, blocking_probability(runs), arch_clogging_correlation(runs)):
        assert all({"units", "long_name"} <= set(v.attrs) for v in found.data_vars.values())


def test_bad_runs_are_refused_in_one_line():
    run = recorded(TWICE, CROWD, exits=[(1.0, 3), (2.3, 0)], step=0.1)
    with pytest.raises(ValueError, match=r"run has no variable wall, door: .* pass what sweep\.read_run gives"):
        blocking_clusters(run.drop_vars(["wall", "door"]))
    with pytest.raises(ValueError, match="door=1 is none of the run's 1 doors"):
        arches(run, door=1)
    apart = recorded(TWICE, CROWD, step=0.1, walls=[(0.0, -10.0, 0.0, -0.6), (0.0, 0.61, 0.0, 10.0), WALLS[2]])
    with pytest.raises(ValueError, match=r"door 0 ends at \(0, 0\.6\) m, where no wall ends"):
        blocking_clusters(apart)
    with pytest.raises(ValueError, match="do not ascend"):
        arch_clogging(run, edges=(1.0, 0.3))
    with pytest.raises(ValueError, match="no variable exit_door"):
        arch_clogging(run.drop_vars("exit_door"))
    with pytest.raises(ValueError, match=r"no variable clogged_count .* put results of contact_counts side by side"):
        arch_clogging_correlation(runs_of_three_kinds().drop_vars("clogged_count"))
    with pytest.raises(ValueError, match="over='kind' is not"):
        arch_clogging_correlation(runs_of_three_kinds(), over="kind")
