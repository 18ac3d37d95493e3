"""Granular clusters, against hand-made contacts and union-find."""

from collections import Counter

import numpy as np
import pytest
import xarray as xr

from studies.measures import cluster_probability, contact_counts, granular_clusters
from tests.measures.recorded import FAR, LOWER, UPPER, recorded, scribbled

ELEVEN = [(k, k + 1) for k in range(10)]  # persons 0 to 10 in a row
ROOM = [(-1.0 - k, 0.0) for k in range(14)]


def clusters_by_union_find(run: xr.Dataset) -> list[Counter]:
    """Sizes of the clusters of each sample, one union at a time."""
    left = dict(zip(run.exit_person.values.tolist(), run.exit_time.values, strict=True))
    found, start = [], 0
    for time, rows in zip(run.time.values, run.row_size.values, strict=True):
        parent = list(range(run.sizes["person"]))

        def root(p, parent=parent):
            return p if parent[p] == p else root(parent[p])

        for k in range(start, start + rows):
            i, j = int(run.contact_i[k]), int(run.contact_j[k])
            if j >= 0 and left.get(i, np.inf) > time and left.get(j, np.inf) > time:
                parent[root(i)] = root(j)
        start += rows
        sizes = Counter(Counter(root(p) for p in range(len(parent))).values())
        found.append(Counter({size: n for size, n in sizes.items() if size > 1}))
    return found


def test_clusters_are_counted_by_hand():
    run = recorded([[], [(0, 1)], [(0, 1), (1, 2), (3, 4)]])
    found = granular_clusters(run)
    assert found.largest_cluster.values.tolist() == [0, 2, 3]
    assert found.clusters.values.tolist() == [0, 1, 2]
    assert found.cluster_count.sel(cluster_size=[2, 3, 4]).values.tolist() == [2, 1, 0]


def test_walls_join_nobody():
    found = granular_clusters(recorded([[(0, LOWER), (1, LOWER), (2, UPPER), (3, FAR)]] * 2))
    assert not found.largest_cluster.any()


def test_who_has_crossed_the_exit_is_in_no_cluster_though_still_in_touch():
    found = granular_clusters(recorded([[(0, 1), (1, 2)]] * 4, exits=[(0.5, 1)]))
    assert found.largest_cluster.values.tolist() == [3, 0, 0, 0]


@pytest.mark.parametrize("touch", [0.05, 0.15])
def test_clusters_are_those_of_union_find(touch):
    run = scribbled(80, 14, seed=3, touch=touch)
    found, expected = granular_clusters(run), clusters_by_union_find(run)
    assert found.largest_cluster.values.tolist() == [max(sizes, default=0) for sizes in expected]
    assert found.clusters.values.tolist() == [sizes.total() for sizes in expected]
    together = sum(expected, Counter())
    assert found.cluster_count.values.tolist() == [together[size] for size in range(2, 15)]


def test_only_samples_up_to_the_last_exit_and_clusters_of_more_than_ten_count():
    ten = ELEVEN[:-1]
    run = recorded([[], ELEVEN, ten, ELEVEN, ELEVEN, ELEVEN], ROOM, exits=[(0.2, 12), (1.5, 13)])
    found = contact_counts(run)
    assert (found.samples, found.large_cluster_samples) == (4, 2)  # at 0, 0.5, 1.0 and 1.5 s
    assert contact_counts(run, more_than=9).large_cluster_samples == 3


def side_by_side(*runs: xr.Dataset) -> xr.Dataset:
    return xr.concat([contact_counts(run) for run in runs], "seed").assign_coords(seed=range(len(runs)))


def test_the_probability_is_the_share_of_the_samples_of_all_runs():
    often = recorded([ELEVEN] * 4, ROOM, exits=[(1.5, 12)], outcome="blocked")  # 4 of 4 samples
    seldom = recorded([ELEVEN] + [[]] * 11, ROOM, exits=[(5.5, 12)])  # 1 of 12
    unstable = recorded([ELEVEN] * 9, ROOM, exits=[(4.0, 12)], outcome="unstable")
    found = cluster_probability(side_by_side(often, seldom, unstable))
    assert found.cluster_probability == 5 / 16
    assert (found.samples, found.runs, found.censored) == (16, 2, 2)
    assert found.cluster_probability_low < 5 / 16 < found.cluster_probability_high


def test_runs_that_all_agree_leave_room_for_those_that_would_not():
    never = recorded([[]] * 4, ROOM, exits=[(1.5, 12)])
    found = cluster_probability(side_by_side(*[never] * 10))
    assert found.cluster_probability == found.cluster_probability_low == 0
    assert found.cluster_probability_high == pytest.approx(0.2775, abs=1e-3)  # Wilson, 0 of 10
    always = cluster_probability(side_by_side(*[recorded([ELEVEN] * 4, ROOM, exits=[(1.5, 12)])] * 10))
    assert always.cluster_probability_low == pytest.approx(1 - 0.2775, abs=1e-3)
    assert always.cluster_probability_high == 1


def test_one_run_has_a_probability_but_no_limits():
    found = cluster_probability(side_by_side(recorded([[]] * 4, ROOM, exits=[(1.5, 12)])))
    assert found.cluster_probability == 0
    assert found.cluster_probability_low.isnull()
    assert found.cluster_probability_high.isnull()


def test_a_run_that_nobody_left_has_no_samples():
    found = cluster_probability(side_by_side(*[recorded([ELEVEN] * 4, ROOM, outcome="blocked")] * 2))
    assert (found.samples, found.runs, found.censored) == (0, 0, 2)
    assert found.cluster_probability.isnull()


def test_the_interval_holds_the_planted_probability_about_as_often_as_it_says():
    rng = np.random.default_rng(8)
    share = np.clip(rng.normal(0.4, 0.1, (300, 14)), 0, 1)
    counts = xr.Dataset(
        {
            "samples": (("copy", "seed"), np.full(share.shape, 4000)),
            "large_cluster_samples": (("copy", "seed"), rng.binomial(4000, share)),
            "censored": (("copy", "seed"), np.zeros(share.shape, dtype=bool)),
        }
    )
    found = cluster_probability(counts, resamples=500)
    inside = (found.cluster_probability_low <= 0.4) & (found.cluster_probability_high >= 0.4)
    assert 0.91 <= inside.mean() <= 0.985


def test_bad_runs_are_refused_in_one_line():
    run = recorded([[(0, 1)], []])
    for name in ("contact_i", "row_size", "exit_person", "x"):
        with pytest.raises(ValueError, match=f"run has no variable {name}: .* record_every=0.02, contacts=True"):
            granular_clusters(run.drop_vars(name))
    with pytest.raises(ValueError, match=r"time has the dimensions \(seed, sample\).*one by one"):
        granular_clusters(run.assign_coords(time=run.time.expand_dims(seed=2)))
    with pytest.raises(ValueError, match="row_size adds up to 1 contacts, but there are 0"):
        granular_clusters(run.isel(contact=[]))
    with pytest.raises(ValueError, match="contact 0 is of persons 0 and 1, but the run has persons 0 to 0"):
        granular_clusters(run.isel(person=[0]))
    with pytest.raises(ValueError, match="contact 0 is of persons 0 and 0"):
        granular_clusters(recorded([[(0, 0)], []]))
    with pytest.raises(ValueError, match="run has 1 samples"):
        granular_clusters(run.isel(sample=[0], contact=[0]))
    with pytest.raises(ValueError, match=r"spaced by 0\.5 to 1 s, but lifetimes need equal steps"):
        granular_clusters(recorded([[]] * 4).isel(sample=[0, 1, 3]))
    with pytest.raises(ValueError, match="exit_person goes from 7 to 7, but the run has persons 0 to 4"):
        granular_clusters(recorded([[]] * 2, exits=[(0.1, 7)]))
    with pytest.raises(ValueError, match="no variable samples"):
        cluster_probability(side_by_side(run).drop_vars("samples"))
    with pytest.raises(ValueError, match="over='v_d'"):
        cluster_probability(side_by_side(run), over="v_d")
