"""Sweeps that add seeds where they are needed: fixed order, nothing invalidated, budget kept, nothing run twice."""

import numpy as np
import pytest
import xarray as xr

from engine import BadInput
from sweep import Grid, Until, gather, open_results, sweep
from sweep.cli import main
from sweep.status import status_of
from sweep.storage.store import Store
from sweep.until import account
from tests.sweep.tiny import TINY, run_files

V_D = (0.8, 1.1, 1.4)


def grid(seeds=12, v_d=V_D, **more) -> Grid:
    return Grid("lin_room", v_d=list(v_d), seed=range(seeds), **{**TINY, **more})


def sweep_until(grid: Grid, store, until, jobs: int) -> xr.Dataset:
    return sweep(grid, store, jobs, progress=False, until=until)


def spread(wanted: float):
    """Standard error of the greatest speed over the wanted one: it differs between cells and falls with seeds."""

    def excess(ds: xr.Dataset) -> xr.DataArray:
        runs = (ds.outcome > 0).sum("seed")
        return ds.max_speed.std("seed", ddof=1) / np.sqrt(runs) / wanted

    return excess


def fixed(seeds_of: dict[float, int]):
    """A rule that is content when a cell has so many seeds."""

    def excess(ds: xr.Dataset) -> xr.DataArray:
        wanted = xr.DataArray([seeds_of.get(float(v), 0) for v in ds.v_d], {"v_d": ds.v_d}, ["v_d"])
        return wanted / (ds.outcome > 0).sum("seed")

    return excess


def seeds_run(ds: xr.Dataset) -> dict[float, list[int]]:
    return {float(v): ds.seed.values[ds.outcome.sel(v_d=v) > 0].tolist() for v in ds.v_d}


def test_each_cell_gets_the_first_seeds_of_the_axis_until_its_rule_is_content(store):
    ds = sweep_until(grid(), store, Until(fixed({0.8: 2, 1.1: 5, 1.4: 9}), least=2, batch=3), 1)
    assert seeds_run(ds) == {0.8: [0, 1], 1.1: [0, 1, 2, 3, 4], 1.4: list(range(11))}
    assert ds.seeds_given.values.tolist() == [2, 5, 11]
    assert len(run_files(store)) == 18 == ds.attrs["runs_given"]
    assert (ds.attrs["runs_uniform"], ds.attrs["cells_open"]) == (33, 0)
    assert "18 runs, 2 to 11 seeds a cell; 11 seeds in each of 3 cells are 33 runs: 55 %" in account(ds).replace(
        "%", " %"
    )


def test_runs_that_were_not_asked_for_are_missing_in_every_variable(store):
    ds = sweep_until(grid(), store, Until(fixed({1.4: 6}), least=2, batch=4), 1)
    not_run = ds.sel(v_d=0.8, seed=[2, 3, 4, 5])
    assert (not_run.outcome == 0).all()
    assert not_run.exit_time.isnull().all()
    assert not_run.end_time.isnull().all()
    assert (not_run.N_out == 0).all()
    assert (ds.outcome.sel(v_d=1.4) > 0).all()
    assert ds.outcome.dtype == np.int8
    assert "flag_meanings" in ds.outcome.attrs


def test_the_result_does_not_depend_on_what_the_store_held_nor_on_the_number_of_workers(store, tmp_path):
    until = Until(spread(0.01), least=3, batch=4)
    once = sweep_until(grid(), store, until, 1)
    assert 3 < once.seeds_given.max() > once.seeds_given.min()
    full = tmp_path / "full"
    sweep(grid(), full, jobs=1, progress=False)
    again = {"resumed": (store, 1), "more held": (full, 1), "parallel": (tmp_path / "parallel", 2)}
    for name, (folder, jobs) in again.items():
        (
            xr.testing.assert_identical(_plain(once), _plain(sweep_until(grid(), folder, until, jobs))),
            name,
        )


def _plain(ds: xr.Dataset) -> xr.Dataset:
    return ds.drop_attrs(deep=False)  # the hash of the files stands there


def test_an_interrupted_sweep_goes_on_to_the_same_result(store, tmp_path, monkeypatch):
    until, asked = Until(spread(0.01), least=3, batch=4), []

    def interrupted(ds):
        asked.append(1)
        if len(asked) == 2:
            raise KeyboardInterrupt
        return spread(0.01)(ds)

    with pytest.raises(KeyboardInterrupt):
        sweep_until(grid(), store, Until(interrupted, least=3, batch=4), 1)
    kept = run_files(store)
    assert Grid.from_json(Store(store).grid.read_text()).axes["v_d"] == V_D  # status and gather still know it
    ds = sweep_until(grid(), store, until, 1)
    assert kept.items() <= run_files(store).items()
    xr.testing.assert_identical(_plain(ds), _plain(sweep_until(grid(), tmp_path / "b", until, 1)))


def test_a_higher_goal_adds_runs_and_leaves_all_files_as_they_were(store):
    sweep_until(grid(), store, Until(fixed({1.4: 4}), least=2, batch=2), 1)
    before = run_files(store)
    sweep_until(grid(), store, Until(fixed({1.4: 8}), least=2, batch=2), 1)
    assert before.items() < run_files(store).items()
    assert len(run_files(store)) - len(before) == 4


def test_the_budget_goes_to_the_least_certain_cells_and_is_not_exceeded(store):
    until = Until(fixed({0.8: 8, 1.1: 12, 1.4: 10}), least=2, batch=2, budget=9)
    ds = sweep_until(grid(), store, until, 1)
    assert ds.seeds_given.values.tolist() == [2, 4, 3]
    assert ds.attrs["runs_given"] == 9 == len(run_files(store))
    assert ds.attrs["cells_open"] == 3
    assert "3 cells are short of the goal" in account(ds)


def test_the_supply_of_seeds_ends_a_cell_that_is_never_content(store):
    ds = sweep_until(grid(5), store, Until(fixed({1.1: 99}), least=2, batch=2), 1)
    assert ds.seeds_given.values.tolist() == [2, 5, 2]
    assert ds.attrs["cells_open"] == 1


def test_a_cell_of_which_nothing_is_known_is_the_least_certain(store):
    def unknown(ds):
        return fixed({0.8: 4, 1.1: 4, 1.4: 4})(ds).where(ds.v_d != 1.4)

    ds = sweep_until(grid(), store, Until(unknown, least=2, batch=2, budget=8), 1)
    assert ds.seeds_given.values.tolist() == [2, 2, 4]


def test_refinement_adds_cells_in_the_columns_that_ask_and_in_no_other(store):
    def refine(ds):
        return [{"v_d": 1.25, "N": 6}] if 1.25 not in ds.v_d.values else []

    more = {**TINY, "N": [5, 6]}
    both = Grid("lin_room", v_d=list(V_D), seed=range(4), **more)
    until = Until(lambda ds: (ds.outcome > 0).sum("seed") * 0.0, least=2, refine=refine)
    ds = sweep_until(both, store, until, 1)
    assert ds.v_d.values.tolist() == [0.8, 1.1, 1.25, 1.4]
    assert ds.seeds_given.sel(v_d=1.25).values.tolist() == [0, 2]
    assert (ds.outcome.sel(v_d=1.25, N=5) == 0).all()
    assert ds.attrs["runs_given"] == 14 == len(run_files(store))
    assert ds.attrs["runs_uniform"] == 14  # a column that did not ask is not held against the uniform grid
    xr.testing.assert_identical(_plain(ds), _plain(sweep_until(both, store, until, 1)))


def test_refinement_stays_within_the_budget(store):
    def refine(ds):
        return [{"v_d": round(v, 3)} for v in (0.9, 1.0, 1.2) if v not in ds.v_d.values]

    until = Until(fixed({}), least=2, budget=9, refine=refine)
    ds = sweep_until(grid(), store, until, 1)
    assert ds.attrs["runs_given"] == 8
    assert ds.v_d.values.tolist() == [0.8, 0.9, 1.1, 1.4]


def test_the_gathered_dataset_of_the_store_holds_the_same_runs(store):
    ds = sweep_until(grid(), store, Until(fixed({1.4: 6}), least=2, batch=4), 1)
    kept = gather(Grid.from_json(Store(store).grid.read_text()), store)
    xr.testing.assert_identical(_plain(ds)[list(kept.data_vars)], _plain(kept))


def test_status_counts_the_runs_that_were_asked_for_and_no_others(store):
    ds = sweep_until(grid(), store, Until(fixed({0.8: 2, 1.1: 5, 1.4: 9}), least=2, batch=3), 1)
    again = Grid.from_json(Store(store).grid.read_text())
    found = status_of(again, Store(store))
    assert (found.counts()["done"], len(found.runs)) == (18, 18)
    assert seeds_run(ds) == seeds_run(open_results(store))


def test_cells_with_random_numbers_of_their_own_keep_them(store):
    own = Grid("lin_room", common_random_numbers=False, v_d=list(V_D), seed=range(8), **TINY)
    ds = sweep_until(own, store, Until(fixed({1.4: 5}), least=2, batch=3), 1)
    assert seeds_run(ds) == {0.8: [0, 1], 1.1: [0, 1], 1.4: [0, 1, 2, 3, 4]}
    uniform = sweep(own, store, 1, progress=False)
    xr.testing.assert_equal(ds.end_time.sel(v_d=1.4), uniform.end_time.sel(v_d=1.4, seed=ds.seed))
    assert len(run_files(store)) == 24


@pytest.mark.parametrize(
    ("until", "words"),
    [
        ({"clearance_time": 0.0}, "clearance_time 0.0 is not above 0"),
        ({"clearance": 0.1}, "'clearance' is not known"),
        ({"least": 10}, "has no goal"),
        ({"blocked_share": 0.1, "least": 1}, "least 1 is not a whole number of 2 or more"),
        ({"blocked_share": 0.1, "budget": 0}, "budget 0 is not"),
        ({"blocked_share": "wide"}, "blocked_share wide is not a finite number"),
        ({"blocked_share": 0.1, "budget": 29}, "below the first round of 30 runs"),
        ({"blocked_share": 0.1, "least": 13}, "fewer than until's least, 13"),
        ("blocked_share", "is not understood"),
        ("blocked_share=wide", "'wide' is not a number"),
        ("blocked_share=1%, blocked_share=2%", "is not understood"),
    ],
)
def test_a_rule_without_sense_is_refused_before_anything_runs(until, words, store):
    with pytest.raises(BadInput, match=words):
        sweep_until(grid(), store, until, 1)
    assert not store.exists()


def test_a_grid_without_seeds_is_refused(store):
    with pytest.raises(BadInput, match="no axis seed"):
        sweep_until(Grid("lin_room", v_d=[1.0], **TINY), store, "blocked_share=0.1", 1)


TOML = """room = "lin_room"
store = "{store}"
[axes]
v_d = [0.8, 1.4]
seed = {{ first = 0, last = 39, step = 1 }}
[constants]
N = 5
size = 4.0
time_limit = 2.0
[until]
blocked_share = 0.12
least = 5
batch = 5
"""


def said(capsys, *arguments: object) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as end:
        main([str(a) for a in arguments])
    return int(end.value.code or 0), *capsys.readouterr()


def test_a_grid_file_says_until_and_runs_not_asked_for_are_no_failure(store, tmp_path, capsys):
    file = tmp_path / "grid.toml"
    file.write_text(TOML.format(store=store))
    code, out, _ = said(capsys, "sweep", file, "--jobs", 1)
    assert code == 0
    assert "30 runs, 15 to 15 seeds a cell" in out  # none of 15 blocked: Wilson's interval is 0.20 wide
    assert "missing" not in out


def test_a_grid_file_with_a_wrong_until_is_one_line(tmp_path, capsys):
    file = tmp_path / "grid.toml"
    file.write_text(TOML.format(store=tmp_path / "s").replace("blocked_share", "blocked_shares"))
    code, _, err = said(capsys, "sweep", file, "--jobs", 1)
    assert code == 2
    assert err.strip().count("\n") == 0
    assert "blocked_shares" in err


def test_words_and_table_say_the_same(tmp_path):
    words, table = "blocked_share=12%, least=5, batch=5", {"blocked_share": 0.12, "least": 5, "batch": 5}
    a, b = (sweep_until(grid(15, V_D[:1]), tmp_path / k, u, 1) for k, u in (("a", words), ("b", table)))
    xr.testing.assert_identical(_plain(a), _plain(b))


def test_a_failing_run_is_named_by_its_parameters_and_the_rounds_go_on(store, capsys):
    crowded = Grid("lin_room", N=[5, 10], seed=range(4), size=2.2, time_limit=0.5)
    counted = Until(lambda ds: 4.0 / ds.seeds_given if "seeds_given" in ds else fixed_of_N(ds), least=2, batch=2)
    ds = sweep_until(crowded, store, counted, 1)
    told = capsys.readouterr().err
    assert "N = 10, seed = 3: BadInput" in told
    assert "again: jamsweep run lin_room --size 2.2 --time-limit 0.5 --N 10 --seed 3" in told
    assert ds.seeds_given.values.tolist() == [4, 4]
    assert (ds.outcome.sel(N=10) == 0).all()
    assert (ds.outcome.sel(N=5) > 0).all()


def fixed_of_N(ds: xr.Dataset) -> xr.DataArray:
    return 4.0 / (ds.outcome > 0).sum("seed")


def test_refined_cells_may_be_named_by_numbers_of_numpy(store):
    def refine(ds):
        return [{"v_d": np.float32(1.25), "N": np.int64(6)}]

    both = Grid("lin_room", v_d=list(V_D), seed=range(3), **{**TINY, "N": [5]})
    until = Until(lambda ds: (ds.outcome > 0).sum("seed") * 0.0, least=2, refine=refine)
    ds = sweep_until(both, store, until, 1)
    assert ds.seeds_given.sel(v_d=1.25, N=6) == 2
    assert ds.attrs["runs_given"] == 8 == len(run_files(store))


@pytest.mark.parametrize("until", [5, ["clearance_time=5%"], True])
def test_what_is_no_rule_is_refused_before_anything_is_made(until, store):
    with pytest.raises(BadInput, match="is no rule, table or words"):
        sweep_until(grid(), store, until, 1)
    assert not store.exists()
