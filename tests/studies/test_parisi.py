"""Parisi & Dorso's studies: planted data decide the verdicts, a tiny sweep goes from runs to pictures."""

from importlib import import_module
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from engine import BadInput, rooms
from studies import measures
from studies.parisi import artefact, everything, fig1, fig4, fig5, fig6, fig8, fig9, fig10, sweeps, table1
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper
from sweep import Grid, Store, read_run, sweep
from sweep.cli import _studies
from sweep.schema import run_key
from tests.measures.planted import flagged

SEEDS = 6


def planted(times, along="v_d", N=200):
    """Runs whose N persons leave at even intervals until the given times, by the value of an axis."""
    rng = np.random.default_rng(2)
    last = np.array(list(times.values()))[:, None] * (1.0 + 0.01 * rng.standard_normal((len(times), SEEDS)))
    exit_time = last[..., None] * np.arange(1, N + 1) / N
    dims, shape = (along, "seed"), last.shape
    return xr.Dataset(
        {
            "exit_time": ((*dims, "exit"), exit_time, {"units": "s"}),
            "outcome": flagged(np.ones(shape), dims),
            "end_time": (dims, last, {"units": "s"}),
            "N_out": (dims, np.full(shape, N)),
            "persons": (dims, np.full(shape, N)),
        },
        coords={along: list(times), "seed": np.arange(SEEDS), "exit": np.arange(1, N + 1)},
    )


def counts(along="v_d", samples=1000, delays=20, **shares):
    """What the contacts of each run came to, the same for all seeds: shares by the value of an axis."""
    first = next(iter(shares.values()))
    cells, ones = list(first), np.ones((len(first), SEEDS))

    def number(name, of):
        return np.array([round(of * shares.get(name, first)[x]) for x in cells])[:, None] * ones

    dims, kinds = (along, "seed"), ["any", "clean"]
    clogged = np.stack([number(f"bin{k}", delays) if f"bin{k}" in shares else 0 * ones for k in range(4)], axis=-1)
    return xr.Dataset(
        {
            "samples": (dims, samples * ones),
            "large_cluster_samples": (dims, number("large", samples)),
            "blocked_samples": (("kind", *dims), np.stack([number("blocked", samples)] * 2)),
            "delay_count": ((*dims, "delay"), np.full((*ones.shape, 4), delays)),
            "clogged_count": (("kind", *dims, "delay"), np.stack([clogged] * 2)),
            "censored": (dims, ones == 0),
        },
        coords={along: cells, "kind": kinds, "delay": [0.1, 0.3, 1.0, 2.3], "delay_end": ("delay", [0.3, 1, 2.3, 9])},
    )


def held(artefact, **facts):
    verdicts = artefact.verdicts(artefact.measure(SimpleNamespace(**facts)))
    return {v.statement: v.holds for v in verdicts}


def test_the_published_ratios_are_those_of_the_published_times():
    for v_d, t in paper.EVACUATION_TIME.items():
        free = paper.N * paper.SHOULDERS / v_d
        assert t / free == pytest.approx(paper.RATIO[v_d], rel=0.03)  # 3.10 is printed for 3.01
    assert set(paper.EVACUATION_TIME) == set(paper.RATIO) <= set(paper.V_D)
    assert (len(paper.V_D), len(paper.DOORS_N), paper.DOORS_N[4.2]) == (13, 6, 500)


def test_times_as_published_reproduce_table_1_and_longer_ones_do_not():
    published = planted(paper.EVACUATION_TIME)
    long = planted({v: 1.15 * t for v, t in paper.EVACUATION_TIME.items()})
    assert set(held(table1, speeds=published, printed=published).values()) == {True}
    slow = held(table1, speeds=long, printed=published)
    assert [v for s, v in slow.items() if "A = 1000" not in s] == [False] * 17
    assert slow["t_e on average, A = 1000 N as printed"] is True


def test_the_minimum_must_lie_near_the_published_threshold():
    assert held(fig1, speeds=planted(paper.EVACUATION_TIME))["t_e of 200 least at"] is True
    late = {v: 300.0 - 40.0 * v + 4 * v**2 for v in paper.EVACUATION_TIME | {6.0: 0, 8.0: 0}}
    assert held(fig1, speeds=planted(late))["t_e of 200 least at"] is False
    assert held(fig4, speeds=planted(late))["mean delay least near 2 m/s"] is False
    assert held(fig1, speeds=planted({1.0: 3.0, 2.0: 2.0, 3.0: 1.0}))["t_e of 200 least at"] is None  # at the edge


def test_clusters_must_be_rare_below_and_frequent_above():
    rising = {0.8: 0.0, 1.5: 0.01, 3.0: 0.5}
    assert set(held(fig5, speed_counts=counts(large=rising)).values()) == {True}
    assert set(held(fig5, speed_counts=counts(large=dict.fromkeys(rising, 0.2))).values()) == {False}


def test_arches_must_go_with_long_delays_above_the_threshold_only():
    v_d = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0)
    step = {v: float(v >= 2.0) for v in v_d}
    short = {v: 0.45 if v == 6.0 else 0.1 for v in v_d}
    found = held(fig8, speed_counts=counts(bin3=step, bin0=short))
    assert list(found.values()) == [True, True, True, False]
    everywhere = held(fig8, speed_counts=counts(bin3=dict.fromkeys(v_d, 0.5), bin0=short))
    assert list(everywhere.values())[:2] == [False, False]


def test_blocking_must_increase_with_v_d():
    rising = {1.5: 0.0, 2.0: 0.1, 4.0: 0.5, 6.0: 0.7}
    assert set(held(fig9, speed_counts=counts(blocked=rising)).values()) == {True}
    assert set(held(fig9, speed_counts=counts(blocked=rising | {6.0: 0.4})).values()) == {False}


@pytest.mark.parametrize(("law", "holds"), [(lambda L: 150 * np.exp(-0.6 * L), True), (lambda L: 90 / L, False)])
def test_blocking_must_vanish_and_the_law_of_the_time_is_told(law, holds):
    doors = planted({L: law(L) for L in paper.DOORS_N}, "L")
    steep = dict(zip(paper.DOORS_N, (0.5, 0.3, 0.15, 0.07, 0.04, 0.02), strict=True))
    found = held(fig10, doors=doors, door_counts=counts("L", blocked=steep))
    assert list(found.values()) == [True, True, holds]
    flat = held(fig10, doors=doors, door_counts=counts("L", blocked={L: p + 0.3 for L, p in steep.items()}))
    assert list(flat.values())[:2] == [False, False]


def test_the_command_knows_every_figure_and_nothing_else_of_the_paper():
    names = [name for name in _studies() if name.startswith("parisi")]
    assert set(names) == {"parisi", *(f"parisi-{name}" for name in everything.ARTEFACTS)}
    assert _studies()["fig10"] == "studies.lin.fig10"
    for module in map(_studies().get, names):
        assert callable(import_module(module).main)


def test_the_full_sweeps_have_the_runs_of_the_paper():
    assert [len(grid) for grid in sweeps.grids(False).values()] == [182, 84, 112]


def test_doors_that_the_paper_does_not_have_are_refused():
    with pytest.raises(BadInput, match=r"L 2\.0 m is no door of the paper"):
        sweeps.wide_room(2.0)


@pytest.fixture
def tiny(monkeypatch):
    """The sweeps with a few persons in a small room."""

    def grids(quick):
        recorded = {"record_every": 0.02, "contacts": True, "record": "positions", "N": 80, "size": 8.0}
        return {"speeds": Grid(rooms.parisi_room, v_d=[0.8, 1.5, 2.0, 3.0, 4.0, 6.0], seed=range(2), **recorded)}

    monkeypatch.setattr(sweeps, "grids", grids)


def test_a_tiny_sweep_goes_from_runs_to_pictures_and_is_counted_once(tiny, tmp_path, monkeypatch):
    first = sweeps.Sweeps(True, 1, tmp_path)
    for name in ("fig2", "fig3", "fig5", "fig6", "fig7", "fig8", "fig9"):
        verdicts = everything.make_one(name, first)
        assert all(isinstance(v, Verdict) for v in verdicts)
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000
    assert dict(first.speed_counts.samples.sizes) == {"v_d": 6, "seed": 2}
    row = sweeps.counts_of(Store(tmp_path / "speeds").file(run_key(run_of(first, 3.0, 1))))
    xr.testing.assert_equal(first.speed_counts.sel(v_d=3.0, seed=1, drop=True).transpose(*row.dims), row)
    monkeypatch.setattr(sweeps, "counts_of", None)
    again = sweeps.Sweeps(True, 1, tmp_path)
    xr.testing.assert_identical(again.speed_counts, first.speed_counts)


def test_contacts_are_counted_where_the_interval_is_no_multiple_of_the_step(tmp_path):
    """Samples are those of the nearest steps, 0.015 or 0.02 s apart; one that is missing is still noticed."""
    grid = Grid(rooms.parisi_room, seed=[0], N=30, size=5.0, dt=0.005, record_every=0.018, contacts=True)
    sweep(grid, tmp_path, jobs=1, progress=False)
    run = read_run(next((tmp_path / "runs").glob("*.nc")))
    assert {f"{step:.3f}" for step in np.diff(run.time)} == {"0.015", "0.020"}
    counts = measures.contact_counts(run)
    assert float(counts.interval) == pytest.approx(0.02)
    assert int(counts.samples) == int((run.time <= run.exit_time.max()).sum())
    rows = run.row_size.values.cumsum()
    without = run.drop_isel(sample=9, contact=np.arange(rows[8], rows[9]))
    with pytest.raises(ValueError, match="lifetimes need equal steps"):
        measures.contact_counts(without)


def run_of(of, v_d, seed):
    return of.grids["speeds"].grid.scenario({"v_d": v_d, "seed": seed})


def test_the_arch_that_is_drawn_leads_from_wall_to_wall(tiny, tmp_path):
    found = fig6.measure(sweeps.Sweeps(True, 1, tmp_path))
    arch = found.arch.values
    touching = list(zip(found.contact_i.values.tolist(), found.contact_j.values.tolist(), strict=True))
    for a, b in pairwise(arch):
        assert (a, b) in touching or (b, a) in touching
    at_walls = {person for person, wall in touching if wall < 0}
    assert {arch[0], arch[-1]} <= at_walls


def test_overlapping_intervals_leave_a_comparison_open():
    low, middle, high = (xr.Dataset({"a": x, "a_low": x - 1.0, "a_high": x + 1.0}) for x in (0.0, 1.5, 3.0))
    assert artefact.larger(high, low, "a") is True
    assert artefact.larger(low, high, "a") is False
    assert artefact.larger(middle, low, "a") is None


def test_the_page_lists_what_is_not_reproduced():
    found = {"fig1": [Verdict("a", "1", "1", True), Verdict("b", "2", "3", False), Verdict("c", "4", "?", None)]}
    text = everything.page(found, "| table |")
    assert "- b: published 2; found 3." in text.partition("## Not reproduced")[2].partition("## Open")[0]
    assert "- c: published 4; found ?." in text
    assert "| fig1 | a | 1 | 1 | yes |" in text
