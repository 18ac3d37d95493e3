"""What is known of durations: the longest run first, the time that is left; what is left in notes about failures."""

import math
import shlex
from pathlib import Path

import pytest

from engine import BadInput, rooms, simulate
from engine.scenario import Scenario
from sweep import Grid, Store, SweepStopped, read_run, sweep
from sweep.cli import main
from sweep.running import worker
from sweep.running.estimate import Durations
from sweep.running.limits import Limits, limits_of
from sweep.running.notes import command, held_back
from sweep.running.plan import durations_of, longest_first, plan_of
from sweep.schema import run_key
from tests.sweep.tiny import TINY

GRID = Grid("lin_room", v_d=[1.0, 2.0, 4.0], N=[5, 10], seed=range(2), size=4.0)


def test_a_run_is_expected_to_take_as_long_as_its_cell_took_on_average() -> None:
    durations = Durations(GRID)
    durations.note({"v_d": 1.0, "N": 5, "seed": 0}, 2.0)
    durations.note({"v_d": 1.0, "N": 5, "seed": 1}, 4.0)
    durations.note({"v_d": 4.0, "N": 10, "seed": 1}, 10.0)
    assert durations.expected({"v_d": 1.0, "N": 5, "seed": 7}) == 3.0
    assert durations.left({(1.0, 5): 2, (4.0, 10): 3, (2.0, 5): 0}) == 36.0


def test_a_cell_without_runs_is_expected_to_be_as_its_neighbour() -> None:
    durations = Durations(GRID)
    assert math.isnan(durations.expected({"v_d": 1.0, "N": 5, "seed": 0}))
    durations.note({"v_d": 1.0, "N": 5, "seed": 0}, 1.0)
    assert durations.expected({"v_d": 4.0, "N": 10, "seed": 0}) == 1.0
    durations.note({"v_d": 4.0, "N": 5, "seed": 0}, 9.0)
    assert durations.expected({"v_d": 4.0, "N": 10, "seed": 0}) == 9.0


def test_the_longest_runs_begin_first(store: Path) -> None:
    few, kept = Grid("lin_room", time_limit=[0.1, 5.0, 0.5], seed=[0], N=5, size=4.0), Store(store)
    sweep(few, kept, jobs=1)
    lines = [line for line in kept.manifest.read_text().splitlines() if line]
    planted = [
        line.replace(f'"duration": {entry.duration}', f'"duration": {10 * k + 1}')
        for line, (k, entry) in zip(lines, enumerate(Store(store).finished().values()), strict=True)
    ]
    kept.manifest.write_text("\n".join(planted))
    more = Grid("lin_room", time_limit=[0.1, 5.0, 0.5], seed=[0, 1, 2], N=5, size=4.0)
    plan = plan_of(more, kept)
    order = longest_first(plan.missing, durations_of(plan, more, kept))
    assert [task.point["time_limit"] for task in order] == [0.5, 0.5, 5.0, 5.0, 0.1, 0.1]
    assert [task.point["seed"] for task in order] == [1, 2] * 3


def test_without_durations_the_order_is_that_of_the_grid(store: Path) -> None:
    plan = plan_of(GRID, Store(store))
    assert longest_first(plan.missing, durations_of(plan, GRID, Store(store))) == plan.missing


def test_fail_fast_begins_no_run_after_one_that_failed(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    grid = Grid("lin_room", seed=range(4), **TINY)
    begun: list[int] = []

    def second_fails(scenario: Scenario) -> object:
        if scenario.options.time_limit == TINY["time_limit"]:  # no run of one step, which is to compile
            begun.append(scenario.seed)
        return 1 / 0 if len(begun) == 2 else simulate(scenario)

    monkeypatch.setattr(worker, "simulate", second_fails)
    with pytest.raises(SweepStopped, match="a run failed: 1 of 4 runs are kept, run again to resume"):
        sweep(grid, store, jobs=1, fail_fast=True)
    assert len(begun) == 2
    assert len(list((store / "failed").iterdir())) == 1


@pytest.mark.parametrize(
    ("room", "parameters"),
    [
        ("lin_room", {"v_d": 0.1 + 0.2, "inertia": "disc", "record_every": 0.5, "contacts": True, **TINY}),
        ("lin_room", {"seed": 3, "contacts": False, **TINY}),
    ],
)
def test_the_command_of_a_failure_repeats_that_very_run(tmp_path: Path, room: str, parameters: dict) -> None:
    grid = Grid(room, **parameters)
    words = shlex.split(command(grid, {}))
    assert words[0] == "jamsweep"
    with pytest.raises(SystemExit) as end:
        main([*words[1:], "-o", str(tmp_path / "run.nc")])
    assert end.value.code == 0
    assert read_run(tmp_path / "run.nc").attrs["run_key"] == run_key(grid.scenario({}))


def own_room(N: int = 3, name: str = "a'b") -> Scenario:
    return rooms.lin_room(N=N, size=4.0, time_limit=0.1)


def test_the_command_for_a_room_of_ones_own_goes_through_python() -> None:
    line = shlex.split(command(Grid(own_room, N=[4]), {"N": 4}))
    assert line[:2] == ["python", "-c"]
    assert f"from {__name__} import own_room as room" in line[2]
    assert "print(simulate(room(N=4)))" in line[2]


@pytest.mark.parametrize(
    ("note", "timeout", "held"),
    [
        ("set aside: 2 workers ended in this run, the last one by SIGKILL", None, True),
        ("timed out after 5 s", 5.0, True),
        ("timed out after 5 s", 3.0, True),
        ("timed out after 5 s", 6.0, False),
        ("timed out after 5 s", None, False),
        ("ValueError: set aside", None, False),
    ],
)
def test_what_would_fail_again_is_held_back(store: Path, note: str, timeout: float | None, held: bool) -> None:
    kept = Store(store)
    kept.make()
    kept.note_failure("key", f"{note}\n\nmore\n")
    assert held_back(kept, "key", limits_of(timeout, None)) is held
    assert not held_back(kept, "another", Limits())


@pytest.mark.parametrize(("given", "size"), [(1e9, 1e9), ("2 GB", 2e9), ("512MiB", 2**29), ("1.5 gb", 1.5e9)])
def test_memory_is_given_in_bytes_or_units(given: float | str, size: float) -> None:
    assert limits_of(None, given).memory == size


def test_a_time_out_is_a_number() -> None:
    with pytest.raises(BadInput, match="timeout True is not a time above 0"):
        limits_of(True, None)
