"""Datasets as pandas tables: nothing lost, nobody added."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from engine import BadInput
from studies import measures
from sweep import Grid, sweep
from sweep.exports import to_dataframe
from tests.exports.walks import walked


@pytest.fixture(scope="module")
def ds(tmp_path_factory: pytest.TempPathFactory):
    grid = Grid("lin_room", v_d=[1.0, 1.4], seed=range(3), N=5, size=4.0, time_limit=4.0)
    return sweep(grid, tmp_path_factory.mktemp("store"), jobs=1)


def test_each_exit_is_a_row_with_the_parameters_of_its_run(ds) -> None:
    table = to_dataframe(ds)
    assert len(table) == int(ds.N_out.sum()) > 0
    for row in table.itertuples():
        there = ds.sel(v_d=row.v_d, seed=row.seed, exit=row.rank)
        assert (row.exit_time, row.exit_person) == (there.exit_time.item(), there.exit_person.item())
        assert row.N == 5
    assert table.attrs["units"]["exit_time"] == "s"
    assert table.attrs["units"]["v_d"] == "m s-1"


def test_each_run_is_a_row_and_unfinished_ones_say_so(ds) -> None:
    table = to_dataframe(ds, rows="runs")
    assert len(table) == 6
    clearance = measures.clearance(ds)
    for row in table.itertuples():
        here = {"v_d": row.v_d, "seed": row.seed}
        words = ds.outcome.attrs["flag_meanings"].split()
        assert row.outcome == words[int(ds.outcome.sel(here))]
        assert row.censored == bool(clearance.censored.sel(here))
        np.testing.assert_equal(row.clearance_time, clearance.clearance_time.sel(here).item())
    assert set(table.outcome) >= {"all_out", "time_limit"}  # both kinds are there to be told apart


def test_clearance_of_a_blocked_run_is_infinite_and_of_a_missing_one_unknown() -> None:
    run = walked([0.5, 1.0])
    words = run.outcome.attrs["flag_meanings"].split()
    for word, clearance, censored in (("frozen", np.inf, True), ("missing", np.nan, False), ("all_out", 1.0, False)):
        outcome = run.outcome.copy(data=words.index(word))
        row = to_dataframe(run.assign(outcome=outcome), rows="runs").iloc[0]
        np.testing.assert_equal(row.clearance_time, clearance)
        assert (row.outcome, row.censored) == (word, censored)


def test_exits_of_a_single_run_know_their_persons() -> None:
    table = to_dataframe(walked([2.0, 0.5, 1.0]))
    assert table["rank"].tolist() == [1, 2, 3]
    assert table.exit_person.tolist() == [1, 2, 0]
    assert table.radius.tolist() == pytest.approx([0.26, 0.27, 0.25])


def test_a_table_survives_parquet(ds, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install '.[parquet]'")
    table = to_dataframe(ds)
    table.to_parquet(tmp_path / "exits.parquet")
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "exits.parquet"), table)


def test_other_rows_and_other_datasets_are_refused(ds) -> None:
    with pytest.raises(BadInput, match="rows 'persons' is not known: choose one of exits, runs"):
        to_dataframe(ds, rows="persons")
    with pytest.raises(BadInput, match="without exit_time"):
        to_dataframe(ds.drop_vars("exit_time"))
