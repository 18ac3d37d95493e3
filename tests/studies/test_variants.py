"""The score of the variants on planted runs: the planted truth wins, equals are not told apart."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from engine import BadInput, rooms
from studies.presentation import figures
from studies.published import lin2016 as paper
from studies.variants import page, score, sweeps, targets
from studies.variants.figure import plot
from studies.variants.room import DEFAULT, VARIANTS, variant_room
from studies.variants.sweeps import CELLS, Cell
from studies.variants.targets import TARGETS
from sweep.schema import run_key
from tests.measures.planted import gathered

PUBLISHED = {Cell(200, 0.6): 340, Cell(200, 1.0): 210, Cell(100, 1.0): 120, Cell(100, 1.0, 200.0): 170}
NAMES = ["good", "same", "slow", "jams"]


def planted(seeds: int = 10, slow: float = 1.4, noise: float = 0.03, root: int = 2) -> xr.Dataset:
    """Variants with the published numbers (twice, with other seeds' noise), too slow, and blocked from 1 m/s on."""
    rng = np.random.default_rng(root)
    shape = (len(CELLS), len(NAMES), seeds)
    time = np.array([PUBLISHED.get(cell, 220.0 if cell.N == 200 else 122.0) for cell in CELLS])[:, None, None]
    time = time * (1.0 + noise * rng.standard_normal(shape))
    time[:, NAMES.index("slow")] *= slow
    blocked = np.zeros(shape, bool)
    for k, cell in enumerate(CELLS):
        blocked[k, NAMES.index("jams")] = cell.v_d >= 1.0
        blocked[k] |= cell == Cell(200, 1.8) or (cell.v_d == 2.0 and not cell.rotation)
    dims = ("cell", "variant", "seed")
    return xr.Dataset(
        {
            "known": (dims, np.ones(shape, bool)),
            "blocked": (dims, blocked),
            "clearance_time": (dims, np.where(blocked, np.nan, time)),
            "least": (dims, np.full(shape, 0.3)),
            "most": (dims, np.full(shape, 1.2)),
        },
        coords={"cell": [str(cell) for cell in CELLS], "variant": NAMES, "seed": np.arange(seeds)},
    )


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return score.scored(planted(), resamples=300)


def test_the_planted_truth_wins_and_false_variants_are_ruled_out(found):
    words = score.verdicts(found)
    assert {words["good"], words["same"]} == {"best", "not told apart"}
    assert words["slow"] == words["jams"] == "ruled out"
    assert page.ranked(found)[:2] in (["good", "same"], ["same", "good"])


def test_with_few_noisy_seeds_nothing_close_is_ruled_out():
    few = score.scored(planted(seeds=6, slow=1.06, noise=0.2), resamples=300)
    words = score.verdicts(few)
    best = next(name for name, word in words.items() if word == "best")
    assert float(few.difference.sel(group="all", variant="slow", other=best)) > 0.0
    assert words["slow"] == "not told apart"


def test_three_seeds_rule_nothing_out(monkeypatch):
    monkeypatch.setattr(page, "DEFAULT", "slow")
    found = score.scored(planted(seeds=3), resamples=300)
    assert sorted(score.verdicts(found).values()) == ["best", *["too few seeds"] * 3]
    assert "ruled out" not in page.text(found)


def test_one_seed_has_no_interval():
    with pytest.raises(ValueError, match="too few"):
        score.scored(planted(seeds=1))


def test_equal_variants_are_seldom_told_apart():
    """Nominally in 1 of 20 pairs; "good" and "same" differ by the noise of their seeds."""
    told = 0
    for root in range(25):
        pair = score.scored(planted(seeds=12, noise=0.1, root=root), resamples=150)
        apart = pair.sel(group="all", variant="good", other="same")
        told += not float(apart.difference_low) <= 0.0 <= float(apart.difference_high)
    assert told <= 4


def test_differences_are_paired_by_seed():
    ds = planted()
    shifted = ds.copy(deep=True)
    shifted.clearance_time.loc[{"variant": "same"}] = ds.clearance_time.sel(variant="good") * 1.02
    for name in ("blocked", "least", "most"):
        shifted[name].loc[{"variant": "same"}] = ds[name].sel(variant="good")
    apart = score.scored(shifted, resamples=300).sel(group="all", variant="same", other="good")
    alone = score.scored(shifted, resamples=300).sel(group="all", variant="same")
    assert float(apart.difference_high - apart.difference_low) < 0.6 * float(alone.score_high - alone.score_low)


def test_groups_add_up_and_each_statement_stands_in_one(found):
    total = found.score.sel(group=list(score.GROUPS[1:])).sum("group")
    np.testing.assert_allclose(found.score.sel(group="all"), total)
    assert {target.group for target in TARGETS} == set(score.GROUPS[1:])
    np.testing.assert_allclose(found.term.sum("target"), found.score.sel(group="all"))


def test_every_term_is_least_where_the_statement_is_met(found):
    """The planted truth meets each clearance time and blocking statement; the others miss what was planted."""
    term = found.term.to_pandas()
    for row in (row for row in term.index if row.startswith("clearance time")):
        assert term.loc[row, "good"] < 1.0 < term.loc[row, "slow"], row
    for row in (row for row in term.index if row.startswith("no run blocked") and "0.6" not in row):
        assert term.loc[row, "good"] < 1.0 < term.loc[row, "jams"], row
    assert term.loc["every run blocked, N=200 v_d=1.8: 1", "good"] < 1.0


def test_a_deviation_of_one_tolerance_adds_one_and_far_or_no_run_out_the_most():
    found = np.array([210.0, 231.0, 900.0, np.nan])
    assert targets.deviation(found, 210.0, 21.0).tolist() == [0.0, pytest.approx(1.0), 25.0, 25.0]


def test_the_predictive_of_blocking_is_the_beta_binomial():
    """With Jeffreys' prior, one run all blocked: P(next is blocked) = 1.5/2."""
    hits, runs = np.array([1.0, 0.0, 10.0]), np.array([1.0, 1.0, 10.0])
    once = np.exp(-0.5 * targets.predictive(hits, runs, shown=1))
    np.testing.assert_allclose(once, [0.75, 0.25, 10.5 / 11.0])
    five = targets.predictive(np.array([10.0, 9.0, 5.0, 0.0]), np.full(4, 10.0))
    assert (np.diff(five) > 0).all()


def test_more_often_is_even_for_equal_counts_and_certain_for_opposite_ones():
    equal = targets.more_often((np.array([3]), np.array([10])), (np.array([3]), np.array([10])))
    np.testing.assert_allclose(equal, 2.0 * np.log(2.0), rtol=1e-2)
    sure = targets.more_often((np.array([10]), np.array([10])), (np.array([0]), np.array([10])))
    assert sure[0] < 0.01


def test_blocked_runs_are_never_averaged_in():
    values = np.array([[100.0, np.nan, 140.0], [np.nan, np.nan, np.nan]])
    assert targets.mean_out(values)[0] == 120.0
    assert np.isnan(targets.mean_out(values)[1])


@pytest.mark.parametrize("q", [0.0, 0.05, 0.5, 0.95, 1.0])
def test_the_quantile_of_those_out_is_numpys_without_the_others(q):
    values = np.random.default_rng(0).standard_normal((3, 20))
    values[1, 5:] = np.nan
    np.testing.assert_allclose(targets.quantile_out(q)(values), np.nanquantile(values, q, axis=1))
    assert np.isnan(targets.quantile_out(q)(np.full((1, 4), np.nan)))


def test_facts_of_blocked_missing_and_finished_runs():
    times = [12.0, 14.0, 25.0, 31.0, 45.0]
    runs = [("all_out", times, 45.0, 5), ("frozen", times[:4], 55.0, 5), ("missing", [], np.nan, 0)]
    facts = sweeps.facts(gathered(runs))
    assert facts.known.values.tolist() == [True, True, False]
    assert facts.blocked.values.tolist() == [False, True, False]
    np.testing.assert_array_equal(facts.clearance_time, [45.0, np.nan, np.nan])
    np.testing.assert_allclose(facts.most[:2], [0.2, 0.2])
    np.testing.assert_allclose(facts.least[:2], [0.1, 0.0])


def test_the_default_variant_is_the_rooms_own_run():
    assert run_key(variant_room(DEFAULT, 1.2, 10, 3)) == run_key(rooms.lin_room(v_d=1.2, N=10, seed=3))


def test_every_variant_is_a_model_of_its_own_under_all_that_is_compared():
    cells = (Cell(10, 1.0), Cell(10, 1.0, 200.0), Cell(10, 1.0, rotation=False))
    keys = {name: [run_key(variant_room(name, c.v_d, c.N, 0, c.A, c.rotation)) for c in cells] for name in VARIANTS}
    assert len({tuple(of) for of in keys.values()}) == len(VARIANTS)


def test_an_unknown_variant_is_refused():
    with pytest.raises(BadInput, match="'XX' is not known"):
        variant_room("XX", 1.0, 10, 0)


def test_every_cell_that_a_statement_needs_is_in_a_grid_and_all_published_numbers_are_used():
    held = {Cell(*(p.get(n, g.constants.get(n)) for n in Cell._fields)) for g in sweeps.grids(2) for p in g.points()}
    assert set(CELLS) == held
    statements = " ".join(target.statement for target in TARGETS)
    for number in (
        *paper.FIG7_CLEARANCE_TIME.values(),
        *paper.FIG4_CLEARANCE_TIME.values(),
        paper.TRANSITION_MEAN_FLOW,
    ):
        assert f"{number:g}" in statements


def test_table_page_and_figure_name_every_variant(found, tmp_path, monkeypatch):
    monkeypatch.setattr(page, "DEFAULT", "good")
    for words in (page.text(found), page.page(found)):
        assert all(name in words for name in NAMES)
        assert "ruled out" in words
    assert page.why_default(found).startswith("The default, good")
    monkeypatch.setattr(page, "DEFAULT", "slow")
    assert "RULED OUT" in page.why_default(found)
    figures.draw(plot, found, tmp_path / "figure.png")
    assert (tmp_path / "figure.png").stat().st_size > 10_000
    with mpl.rc_context(figures.STYLE):
        above, below, _ = plot(found).axes
    assert "score less that of" in above.get_xlabel()
    assert {label.get_text() for label in above.get_yticklabels()} == set(NAMES)
    assert len(below.get_yticks()) == len(TARGETS)
