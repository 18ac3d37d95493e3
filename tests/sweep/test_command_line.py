"""The command jamsweep: what it prints, and how it refuses."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from engine import rooms, simulate
from engine.rooms import ROOMS
from sweep import open_results, read_run
from sweep.cli import cli, main
from sweep.commands.run import parameter_words
from tests.sweep.tiny import TINY

SMALL = ["--N", "5", "--size", "4", "--time-limit", "2"]


def jamsweep(*arguments: object) -> int:
    """Exit code of the command."""
    with pytest.raises(SystemExit) as caught:
        main(list(map(str, arguments)))
    return int(caught.value.code or 0)


def grid_file(folder: Path, text: str = "") -> Path:
    path = folder / "grid.toml"
    default = "[axes]\nv_d = { first = 1.0, last = 1.4, step = 0.2 }\nseed = [0, 1]\n[constants]\nN = 5\n"
    rest = text or f"{default}size = 4\ntime_limit = 2\n"
    path.write_text(f'room = "lin_room"\nstore = "{folder / "results"}"\n{rest}')
    return path


def test_run_writes_the_run_the_room_would_give(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = tmp_path / "run.nc"
    assert jamsweep("run", "lin_room", "--v-d", "1.4", "--seed", "2", *SMALL, "-o", path) == 0
    run = simulate(rooms.lin_room(v_d=1.4, seed=2, **TINY))
    assert capsys.readouterr().out.splitlines() == [str(run), str(path)]
    assert read_run(path).exit_time.values.tolist() == run.exit_time.tolist()


def test_every_keyword_of_every_room_is_an_option_with_its_default(capsys: pytest.CaptureFixture) -> None:
    for name, room in ROOMS.items():
        assert jamsweep("run", name, "--help") == 0
        said = capsys.readouterr().out
        for keyword in room.__annotations__.keys() - {"return"}:
            assert f"--{keyword.replace('_', '-')} " in said
        assert set(parameter_words(room)) == room.__annotations__.keys() - {"return"}


def test_sweep_status_and_gather_follow_a_grid_file(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path, store = grid_file(tmp_path), tmp_path / "results"
    assert jamsweep("sweep", path, "--dry-run") == 0
    assert capsys.readouterr().out == "6 runs: 0 done, 6 to do\n"
    assert not store.exists()
    assert jamsweep("sweep", path, "--jobs", 1) == 0
    assert jamsweep("status", store) == 0
    assert "6 runs: 6 done, 0 to do" in capsys.readouterr().out
    assert open_results(store).v_d.values.tolist() == [1.0, 1.2, 1.4]
    (store / "dataset.nc").unlink()
    assert jamsweep("gather", store, "-o", tmp_path / "out.nc") == 0
    assert (tmp_path / "out.nc").exists()
    assert (open_results(store).outcome > 0).all()


def test_run_and_sweep_speak_json(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = tmp_path / "run.nc"
    assert jamsweep("run", "lin_room", "--v-d", "1.4", "--seed", "2", *SMALL, "-o", path, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    run = simulate(rooms.lin_room(v_d=1.4, seed=2, **TINY))
    assert (said["outcome"], said["exit_time"], said["file"]) == (run.outcome, run.exit_time.tolist(), str(path))
    assert said["run_key"] == read_run(path).attrs["run_key"]
    grid = grid_file(tmp_path)
    assert jamsweep("sweep", grid, "--dry-run", "--json") == 0
    assert json.loads(capsys.readouterr().out)["states"]["missing"] == 6
    assert jamsweep("sweep", grid, "--jobs", 1, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["runs"], sum(told["outcomes"].values()), told["outcomes"]["missing"]) == (6, 6, 0)
    assert told["dataset"] == str(tmp_path / "results" / "dataset.nc")
    assert told["failure_notes"] == []


def test_a_failed_sweep_names_its_notes_in_json(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = grid_file(tmp_path, "[axes]\nN = [3, 10]\n[constants]\nsize = 2.2\ntime_limit = 0.5\n")
    assert jamsweep("sweep", path, "--jobs", 1, "--json") == 1
    told = json.loads(capsys.readouterr().out)
    assert told["outcomes"]["missing"] == 1
    assert "do not fit" in Path(told["failure_notes"][0]).read_text()


def every_command(group: click.Group, *names: str) -> Iterator[tuple[str, ...]]:
    for name in group.list_commands(click.Context(group)):
        command = group.get_command(click.Context(group), name)
        yield (*names, name)
        if isinstance(command, click.Group):
            yield from every_command(command, *names, name)


def test_every_command_has_help_with_an_example(capsys: pytest.CaptureFixture) -> None:
    commands = list(every_command(cli))
    assert {("run", "lin_room"), ("sweep",), ("init",), ("completion",)} <= set(commands)
    for names in commands:
        assert jamsweep(*names, "--help") == 0
        said = capsys.readouterr().out
        examples = [line.strip() for line in said.splitlines()[1:] if f"jamsweep {' '.join(names)} " in line]
        assert examples, names
        assert max(map(len, said.splitlines())) <= 120


def test_the_help_says_what_exit_codes_mean(capsys: pytest.CaptureFixture) -> None:
    assert jamsweep("--help") == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "Exit codes: 0 all done, 1 a run failed or a file is damaged, 2 bad input, 130 interrupted" in said


def completed(*words: str) -> set[str]:
    """What a shell is offered for the last word."""
    asked = {"_JAMSWEEP_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    command = [sys.executable, "-c", "from sweep.cli import main; main()"]
    root = Path(rooms.__file__).parents[1]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, env=os.environ | asked, check=True)
    return {line.partition(",")[2] for line in done.stdout.splitlines()}


def test_a_shell_completes_commands_rooms_options_and_studies(capsys: pytest.CaptureFixture) -> None:
    for shell in ("bash", "zsh", "fish"):
        assert jamsweep("completion", shell) == 0
        said = capsys.readouterr().out
        assert f"_JAMSWEEP_COMPLETE={shell}_complete" in said
    assert completed("jamsweep", "st") == {"status", "study"}
    assert completed("jamsweep", "run", "") == set(ROOMS)
    assert "--v-d" in completed("jamsweep", "run", "lin_room", "--v")
    assert {"fig10", "fig4"} <= completed("jamsweep", "study", "fi")


def test_a_reader_that_goes_away_is_no_error_to_complain_of() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "sweep.cli", "--help"]
    root = Path(rooms.__file__).parents[1]
    done = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, cwd=root)
    os.close(writer)
    assert (done.returncode, done.stderr) == (1, b"")


def test_off_a_terminal_progress_is_lines_without_control_characters(tmp_path: Path) -> None:
    root = Path(rooms.__file__).parents[1]
    command = [sys.executable, "-m", "sweep.cli", "sweep", str(grid_file(tmp_path)), "--jobs", "1"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, env=os.environ | {"TERM": "xterm"})
    assert done.returncode == 0
    assert "6 of 6 runs over" in done.stderr
    assert "\x1b" not in done.stdout + done.stderr
    assert "\r" not in done.stdout + done.stderr


def test_a_failed_run_gives_exit_code_1(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = grid_file(tmp_path, "[axes]\nN = [3, 10]\n[constants]\nsize = 2.2\ntime_limit = 0.5\n")
    assert jamsweep("sweep", path, "--jobs", 1) == 1
    assert "failed: size = 2.2, time_limit = 0.5, N = 10: BadInput" in capsys.readouterr().err
    assert jamsweep("status", tmp_path / "results") == 0
    assert "2 runs: 1 done, 1 to do; 1 of them failed before" in capsys.readouterr().out


def test_a_study_gets_its_options(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "planted_studies"
    folder.mkdir()
    (folder / "__init__.py").touch()
    (folder / "figure.py").write_text("def main(quick, jobs):\n    print(f'quick {quick} on {jobs}')\n")
    monkeypatch.setattr("sweep.cli.STUDIES", "planted_studies")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.MonkeyPatch.context() as patch:
        said: list[str] = []
        patch.setattr("builtins.print", lambda *words, **_: said.append(" ".join(map(str, words))))
        assert jamsweep("study", "figure", "--quick", "--jobs", 3) == 0
        assert jamsweep("study", "nope") == 2
    assert said == ["quick True on 3", "jamsweep: study 'nope' is not known: choose one of figure"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["run", "nope"], "room 'nope' is not known: choose one of lin_room"),
        (["run", "lin_room", "--v-d", "nan"], "v_d nan"),
        (["run", "lin_room", "--N", "-5"], "N -5 is not"),
        (["run", "lin_room", "--N", "many"], "'many' is not a valid integer"),
        (["run", "lin_room", "--N", "5000"], "do not fit"),
        (["run", "lin_room", "--N", "10", "--size", "2.2"], "do not fit"),
        (["run", "lin_room", "--dt", "0.1"], "dt 0.1 s is beyond"),
        (["run", "lin_room", "--L", "0.5"], "narrower than the largest person"),
        (["run", "lin_room", "--friction", "Q"], "friction 'Q' is not known"),
        (["run", "lin_room", "--width", "1"], "No such option"),
        (["run", "lin_room", "-o", "/proc/run.nc"], "output folder '/proc' cannot be written to"),
        (["sweep", "/nowhere/grid.toml"], "name a TOML file; `jamsweep init` writes one"),
        (["status", "/nowhere"], "holds no sweep"),
        (["gather", "/nowhere"], "holds no sweep"),
        (["wander"], "No such command"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(arguments: list, words: str, capsys: pytest.CaptureFixture) -> None:
    assert jamsweep(*arguments) == 2
    refused(capsys, words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[axes\n", "is no valid TOML"),
        ("seeds = 3\n", "entry 'seeds' is not known"),
        ("[axes]\nseed = 3\n", "axis seed 3 is not a list"),
        ("[axes]\nseed = []\n", "makes a grid of zero runs"),
        ("[axes]\nseed = { first = 3, last = 0, step = 1 }\n", "makes a grid of zero runs"),
        ("[axes]\nseed = { first = 0, last = -1, step = 1 }\n", "makes a grid of zero runs"),
        ("[axes]\nv_d = { first = 1.0, last = 0.5, step = 1.0 }\n", "makes a grid of zero runs"),
        ("[axes]\nv_d = { first = 1.0, last = 1e300, step = 1e-3 }\n", "has more than 100000 values"),
        ("[axes]\nseed = { first = 0, last = 3 }\n", "is not a span"),
        ("[axes]\nseed = { first = 0, last = 3, step = 0 }\n", "is not a span"),
        ("[axes]\nwidth = [1.0]\n", "'width' is not a keyword of lin_room"),
        ("[axes]\nv_d = [1.0, nan]\n", "v_d nan"),
        ("[constants]\nN = [5]\n", "is not a single value"),
        ("[axes]\nN = [5]\n[constants]\nN = 5\n", "both axis and constant"),
        ("[constants]\nfriction = 'Q'\n", "friction 'Q' is not known"),
    ],
)
def test_a_bad_grid_file_is_one_line_and_exit_code_2(
    tmp_path: Path, text: str, words: str, capsys: pytest.CaptureFixture
) -> None:
    assert jamsweep("sweep", grid_file(tmp_path, text)) == 2
    refused(capsys, words)
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize("text", ['store = "results"\n', 'room = "lin_room"\n', 'room = "nope"\nstore = "results"\n'])
def test_a_grid_file_needs_a_room_and_a_store(tmp_path: Path, text: str, capsys: pytest.CaptureFixture) -> None:
    path = tmp_path / "grid.toml"
    path.write_text(text)
    assert jamsweep("sweep", path) == 2
    refused(capsys, "room" if "nope" in text or "room" not in text else "store")


def test_a_store_that_is_a_file_or_cannot_be_made_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = grid_file(tmp_path)
    (tmp_path / "results").write_text("kept")
    assert jamsweep("sweep", path) == 2
    refused(capsys, "is not a folder")
    assert (tmp_path / "results").read_text() == "kept"
    path.write_text('room = "lin_room"\nstore = "/proc/results"\n')
    assert jamsweep("sweep", path) == 2
    refused(capsys, "cannot be written to")


def test_an_output_without_a_name_is_refused_before_the_run(capsys: pytest.CaptureFixture) -> None:
    assert jamsweep("run", "lin_room", *SMALL, "-o", "") == 2
    assert "is not the name of a file" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["gather", "report"])
def test_an_output_of_a_store_without_a_name_is_refused(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    path = grid_file(tmp_path)
    assert jamsweep("sweep", path, "--jobs", 1) == 0
    capsys.readouterr()
    assert jamsweep(command, tmp_path / "results", "-o", "") == 2
    refused(capsys, "is not the name of a file")


NO_SPEEDS = '{"room": "lin_room", "axes": {"v_d": []}, "constants": {}}'


@pytest.mark.parametrize("torn", ["", "{", "[]", "{}", "[" * 100_000, '{"room": 3}', NO_SPEEDS])
def test_a_damaged_grid_of_a_store_is_one_line(tmp_path: Path, torn: str, capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "grid.json").write_text(torn)
    assert jamsweep("status", tmp_path) == 1
    said = capsys.readouterr().err
    assert "is damaged: sweep again" in said
    assert "Traceback" not in said


@pytest.mark.parametrize("seeds", ['[[1.0, "a"]]', "[[1.0, null]]", "[[1.0, 99]]", "[[9.0, 1]]", "[[]]", "3"])
def test_damaged_numbers_of_seeds_of_a_grid_are_one_line(
    tmp_path: Path, seeds: str, capsys: pytest.CaptureFixture
) -> None:
    plain = '{"room": "lin_room", "axes": {"v_d": [1.0], "seed": [0]}, "constants": {}, "seeds_of_cells": '
    (tmp_path / "grid.json").write_text(plain + seeds + "}")
    assert jamsweep("status", tmp_path) in (1, 2)
    refused(capsys, "")


def test_the_status_of_a_room_of_ones_own_says_so(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "grid.json").write_text('{"room": "mine:my_room", "axes": {"N": [3]}, "constants": {}}')
    assert jamsweep("status", tmp_path) == 2
    assert "room 'mine:my_room' is not known" in capsys.readouterr().err


def test_the_module_is_a_command_with_version_and_help() -> None:
    for argument, word in (("--version", "engine"), ("--help", "jamsweep sweep grid.toml"), ("-h", "status")):
        command = [sys.executable, "-m", "sweep.cli", argument]
        done = subprocess.run(command, capture_output=True, text=True, cwd=Path(rooms.__file__).parents[1])
        assert done.returncode == 0
        assert word in done.stdout
        assert not done.stderr


def refused(capsys: pytest.CaptureFixture, words: str) -> None:
    said = capsys.readouterr().err
    assert words in said
    assert said.startswith("jamsweep: ")
    assert said.count("\n") == 1
