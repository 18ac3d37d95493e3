"""What a store does with runs that another state of the engine made."""

import importlib
import json
from pathlib import Path

import pytest
import xarray as xr

from engine import BadInput
from sweep import Grid, Store, SweepStopped, gather, schema, sweep
from sweep.cli import main
from sweep.storage.compact import compact
from tests.sweep.tiny import TINY

OLD = "0123456789abcdef"


def jamsweep(*arguments: object) -> int:
    with pytest.raises(SystemExit) as caught:
        main(list(map(str, arguments)))
    return int(caught.value.code or 0)


@pytest.fixture
def old(grid: Grid, store: Path) -> Store:
    """A store with four of six runs, made by another engine."""
    with pytest.MonkeyPatch.context() as patch:
        for module in ("schema", "storage.serving", "gathering"):
            patch.setattr(importlib.import_module(f"sweep.{module}"), "FINGERPRINT", OLD)
        patch.setattr("sweep.storage.keys.package_fingerprint", lambda: OLD)
        sweep(Grid("lin_room", v_d=[1.0, 1.4], seed=range(2), **TINY), store, jobs=1, progress=False)
    return Store(store)


def test_an_edited_engine_reruns_and_says_how_many(grid: Grid, old: Store, capsys: pytest.CaptureFixture) -> None:
    ds = sweep(grid, old, jobs=1)
    said = capsys.readouterr().err
    states = f"another state of the engine or of a law ({OLD}; now {schema.FINGERPRINT})"
    assert f"4 of 6 runs are done by {states}: run anew" in said
    assert "6 runs: 0 done, 6 to do" in said
    assert len(old.finished()) == 10
    assert "accepted_engines" not in ds.attrs
    sweep(grid, old, jobs=1)
    assert "another state" not in capsys.readouterr().err


def test_error_stops_before_any_run_and_says_how_many(grid: Grid, old: Store) -> None:
    for use in (sweep, gather):
        with pytest.raises(SweepStopped, match="4 of 6 runs are done by another state of the engine"):
            use(grid, old, on_code_change="error")
    assert len(old.finished()) == 4


@pytest.mark.parametrize("folded", [False, True])
def test_accept_takes_the_old_runs_and_the_dataset_says_so(
    grid: Grid, old: Store, folded: bool, capsys: pytest.CaptureFixture
) -> None:
    if folded:
        compact(old)
    ds = sweep(grid, old, jobs=1, on_code_change="accept")
    assert "6 runs: 4 done, 2 to do" in capsys.readouterr().err
    assert json.loads(ds.accepted_engines) == {OLD: 4}
    assert ds.engine_fingerprint == schema.FINGERPRINT
    fresh = sweep(grid, old, jobs=1, on_code_change="rerun")
    assert "accepted_engines" not in fresh.attrs
    xr.testing.assert_equal(ds, fresh)
    assert "accepted_engines" not in sweep(grid, old, jobs=1, on_code_change="accept").attrs, "new runs come first"


def test_the_choice_is_an_option_of_the_command_and_an_entry_of_the_file(
    old: Store, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    text = (
        f'room = "lin_room"\nstore = "{old.path}"\non_code_change = "error"\n[axes]\nv_d = [1.0, 1.4]\nseed = [0, 1]\n'
    )
    path = tmp_path / "grid.toml"
    path.write_text(text + "[constants]\n" + "\n".join(f"{name} = {value}" for name, value in TINY.items()))
    assert jamsweep("sweep", path, "--jobs", 1) == 1
    assert "on_code_change = 'rerun' or 'accept'" in capsys.readouterr().err
    assert jamsweep("sweep", path, "--dry-run", "--on-code-change", "rerun") == 0
    assert "4 stale" in capsys.readouterr().out
    assert jamsweep("sweep", path, "--jobs", 1, "--on-code-change", "accept") == 0
    assert len(old.finished()) == 4
    assert jamsweep("gather", old.path) == 0
    assert jamsweep("gather", old.path, "--on-code-change", "error") == 1
    path.write_text(text.replace('"error"', '"perhaps"'))
    assert jamsweep("sweep", path) == 2


def test_an_unknown_choice_is_refused(grid: Grid, old: Store) -> None:
    with pytest.raises(BadInput, match="on_code_change 'maybe' is not known: choose one of error, rerun, accept"):
        sweep(grid, old, on_code_change="maybe")
