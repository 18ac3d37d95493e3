"""Status says what is done, what is not, and why."""

import json
import os
import time
from pathlib import Path

import pytest

from sweep import Grid, Store, schema, sweep
from sweep.cli import main
from sweep.status import STATES, status_of
from sweep.storage import keys
from sweep.storage.keys import keys_of
from tests.sweep.tiny import TINY


def jamsweep(*arguments: object) -> int:
    with pytest.raises(SystemExit) as caught:
        main(list(map(str, arguments)))
    return int(caught.value.code or 0)


@pytest.mark.parametrize("common", [True, False])
@pytest.mark.parametrize("room", ["lin_room", "parisi_room"])
def test_keys_made_without_building_every_scenario_are_those_of_the_scenarios(room: str, common: bool) -> None:
    grid = Grid(room, seed=[3, 0, 11], v_d=[1.0, 1.4], N=[4, 6], size=6, common_random_numbers=common)
    scenarios = [grid.scenario(point) for point in grid.points()]
    assert [key.key for key in keys_of(grid)] == [schema.run_key(scenario) for scenario in scenarios]
    assert [key.scenario for key in keys_of(grid)] == [schema.scenario_hash(s.canonical()) for s in scenarios]


def test_kept_keys_are_those_of_this_grid_engine_and_schema(
    grid: Grid, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = Store(store)
    kept.make()
    first = keys_of(grid, kept)
    with monkeypatch.context() as patch:
        patch.setattr(keys, "_canonical", lambda grid: pytest.fail("keys were made again"))
        assert keys_of(grid, kept) == first
    path = store / keys.FILE
    path.write_text(path.read_text().replace(first[2].key, "0" * 64))
    assert keys_of(grid, kept) == first, "altered keys were taken"
    monkeypatch.setattr(keys, "package_fingerprint", lambda: "rooms and options edited")
    with monkeypatch.context() as patch:
        patch.setattr(keys, "_canonical", lambda grid: [])
        assert keys_of(grid, kept) == [], "keys of an engine with other rooms were taken"
    assert keys_of(grid, kept) == first, "what stands outside the kernel is part of no key"
    monkeypatch.setattr(schema, "FINGERPRINT", "another")
    monkeypatch.setattr(keys, "package_fingerprint", lambda: "kernel edited")
    assert not {key.key for key in keys_of(grid, kept)} & {key.key for key in first}


def test_every_state_is_told_with_its_reason(store: Path, capsys: pytest.CaptureFixture) -> None:
    grid = Grid("lin_room", seed=range(8), **TINY)
    sweep(Grid("lin_room", seed=range(7), **TINY), store, jobs=1, progress=False)
    kept = Store(store)
    kept.note_grid(grid.to_json())
    files = [kept.file(key.key) for key in keys_of(grid)]
    lines = [line for line in (store / "manifest.jsonl").read_text().splitlines() if line]
    stale = json.loads(next(line for line in lines if files[1].stem in line))
    lines = [line for line in lines if files[1].stem not in line and files[6].stem not in line]
    stale |= {"key": "f" * 64, "engine": "0123456789abcdef"}
    (store / "manifest.jsonl").write_text("\n".join([*lines, json.dumps(stale)]))
    files[1].rename(kept.file("f" * 64))  # 1: done by another engine; 6: not in the manifest
    files[2].write_bytes(b"half")
    kept.set_aside(files[3].stem, "test")
    files[4].unlink()
    kept.note_failure(files[5].stem, "test")
    files[5].unlink()
    found = status_of(grid, kept)
    states = ["done", "stale", "corrupt", "set aside", "lost", "failed", "unlisted", "missing"]
    assert [run.state for run in found.runs] == states
    assert set(states) == set(STATES)
    assert jamsweep("status", store, "--why") == 0
    said = capsys.readouterr().out
    assert said.startswith("8 runs: 1 done, 7 to do; 1 of them failed before, see ")
    for state in states[1:]:
        assert f"\n{state}: " in said
        assert f"1 {state}" in said
    assert "  all defaults, seed = 7" in said
    assert "of CPU time left" in said
    assert jamsweep("status", store, "--json") == 0
    plain = json.loads(capsys.readouterr().out)
    assert plain["states"] == dict.fromkeys(states, 1)
    assert plain["cpu_seconds_left"] > 0
    assert len(plain["not_done"]) == 7


def test_the_time_left_is_that_of_like_runs(store: Path) -> None:
    grid = Grid("lin_room", v_d=[1.0, 1.4], seed=range(3), **TINY)
    sweep(Grid("lin_room", v_d=[1.0, 1.4], seed=range(2), **TINY), store, jobs=1, progress=False)
    took = {1.0: 5.0, 1.4: 70.0}
    key_to_v_d = {key.key: point["v_d"] for key, point in zip(keys_of(grid), grid.points(), strict=True)}
    lines = [json.loads(line) for line in (store / "manifest.jsonl").read_text().splitlines() if line]
    planted = [json.dumps(line | {"duration": took[float(key_to_v_d[line["key"]])]}) for line in lines]
    (store / "manifest.jsonl").write_text("\n".join(planted) + "\n")
    assert status_of(grid, Store(store)).seconds == pytest.approx(75.0)


def test_a_dry_run_gives_reasons_and_touches_nothing(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = tmp_path / "grid.toml"
    path.write_text(f'room = "lin_room"\nstore = "{tmp_path / "store"}"\n[axes]\nseed = [0, 1]\n[constants]\nN = 5\n')
    assert jamsweep("sweep", path, "--dry-run", "--why") == 0
    assert "missing: it was never run (2)\n  all defaults, seed = 0, 1\n" in capsys.readouterr().out
    assert os.listdir(tmp_path) == ["grid.toml"]


def test_the_clock_decides_nothing(grid: Grid, store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = sweep(Grid("lin_room", v_d=[1.0], seed=range(3), **TINY), store, jobs=1, progress=False)
    for path in store.rglob("*"):
        os.utime(path, (1e9, 4e9))
    monkeypatch.setattr(time, "time", lambda: -1e9)
    ds = sweep(grid, store, jobs=1, progress=False)
    assert (ds.sel(v_d=[1.0]).max_speed == whole.max_speed).all()
    assert len(Store(store).finished()) == 6
