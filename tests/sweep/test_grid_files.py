"""Grid files: what is wrong is said with its line, and how runs are run may stand there."""

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from engine import BadInput
from engine.rooms import ROOMS
from sweep.cli import main
from sweep.commands import sweeping
from sweep.commands.beginning import example
from sweep.gridfile import read_gridfile, read_running
from sweep.tomlfile import lines_of

TOP = 'room = "lin_room"\nstore = "results"\n'  # two lines


def grid_file(folder: Path, rest: str) -> Path:
    path = folder / "grid.toml"
    path.write_text(TOP + rest, "utf-8")
    return path


def jamsweep(*arguments: object) -> int:
    with pytest.raises(SystemExit) as caught:
        main(list(map(str, arguments)))
    return int(caught.value.code or 0)


@pytest.mark.parametrize(
    ("rest", "line", "words"),
    [
        ("\n[axes\n", 4, "is no valid TOML"),
        ('[axes]\nseed = """\n', 4, "is no valid TOML"),
        ("seeds = 3\n", 3, "entry 'seeds' is not known"),
        ("axes = 3\n", 3, "is not a table"),
        ("# seed = 1\n[axes]\n\nseed = 3\n", 6, "axis seed 3 is not a list"),
        ("[axes]\nv_d = [\n  1.0,\n  nan,\n]\nseed = [1]\n", 4, "v_d nan"),
        ("[axes]\nseed = [1]\n[constants]\nmu = 0.5\nN = 5000\n", 7, "do not fit"),
        ("[constants]\nsize = 20\nN = 5000\n", 5, "do not fit"),
        ("[constants]\ntau = 1\nL = 0.5\n", 5, "narrower than the largest person"),
        ("[axes]\nN = [5]\n[constants]\ntau = 1\nN = 5\n", 7, "both axis and constant"),
        ("[axes]\nseed = [1]\nwidth = [1]\n[constants]\nheight = 3\n", 5, "'width' is not a keyword"),
        ('on_code_change = "x"\n', 3, "on_code_change 'x'"),
        ("common_random_numbers = 1\n", 3, "common_random_numbers 1 is not true or false"),
        (f"[axes]\nseed = {{ first = {10**20}, last = {10**20}, step = 1 }}\n", 4, f"seed {10**20}"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path: Path, rest: str, line: int, words: str) -> None:
    path = grid_file(tmp_path, rest)
    with pytest.raises(BadInput) as caught:
        read_gridfile(path)
    assert str(caught.value).startswith(f"{path}:{line}: ")
    assert words in str(caught.value)


def test_a_byte_that_is_no_utf_8_is_said_with_its_line(tmp_path: Path) -> None:
    path = grid_file(tmp_path, "# a crowd\n")
    path.write_bytes(path.read_bytes() + b'x = "\xff"\n')
    with pytest.raises(BadInput, match=f"{path}:4: .*not UTF-8"):
        read_gridfile(path)


def test_a_wrong_goal_is_said_with_its_line(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    for goal, line in (("clearance = 0.1", 7), ("blocked_share = 0.1\nbudget = -3", 8)):
        path = grid_file(tmp_path, f"[axes]\nseed = {{ first = 0, last = 19, step = 1 }}\n\n[until]\n{goal}\n")
        assert jamsweep("sweep", path) == 2
        assert capsys.readouterr().err.startswith(f"jamsweep: {path}:{line}: until: ")


def test_a_dry_run_refuses_a_wrong_goal_and_counts_the_first_round(
    tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rest = (
        "[axes]\nv_d = [0.8, 1.4]\nseed = { first = 0, last = 39, step = 1 }\n[until]\nblocked_share = %s\nleast = 5\n"
    )
    assert jamsweep("sweep", grid_file(tmp_path, rest % "nan"), "--dry-run") == 2
    assert "grid.toml:7: until: blocked_share nan" in capsys.readouterr().err
    assert jamsweep("sweep", grid_file(tmp_path, rest % "0.1"), "--dry-run") == 0
    told = capsys.readouterr().out
    assert "10 runs: 0 done, 10 to do" in told
    assert "first round" in told


def test_every_entry_is_found_where_a_reader_sees_it() -> None:
    text = """\
        a = "[not a table]"
        # b = 1
        [axes]  # x = 1
        many = [
          1,  # mu = 3
          2,
        ]
        span = { first = 0,
                 last = 1 }
        words = '''
        N = 3
        '''
        N = 4
        [until.deep]
        x.y = 1
        """
    text = "\n".join(line.strip() for line in text.splitlines())
    text = text.replace("first = 0,\nlast", "first = 0, last")  # TOML 1.0 has no lines inside { }
    where = {".".join(key): line for key, line in lines_of(text).items()}
    assert {name: where[name] for name in ("a", "axes", "axes.many", "axes.span", "axes.span.last")} == {
        "a": 1,
        "axes": 3,
        "axes.many": 4,
        "axes.span": 8,
        "axes.span.last": 8,
    }
    assert (where["axes.words"], where["axes.N"]) == (9, 12)
    assert (where["until.deep"], where["until.deep.x.y"]) == (13, 14)
    assert not {"b", "x", "mu"} & set(where)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("jobs = 0", "jobs 0 is not a whole number above 0"),
        ("jobs = true", "jobs True"),
        ('backend = "mpi"', "backend 'mpi' is not known: choose one of serial, loky, dask"),
        ("scheduler = 3", "scheduler 3 is not an address"),
        ('timeout = "long"', "timeout 'long' is not a time above 0"),
        ('memory_limit = "2 apples"', "is not an amount of memory"),
        ("fail_fast = 1", "fail_fast 1 is not true or false"),
        ("retry = true", "entry 'retry' is not known"),
    ],
)
def test_a_wrong_manner_of_running_is_said_with_its_line(tmp_path: Path, entry: str, words: str) -> None:
    path = grid_file(tmp_path, f"\n[running]\n# how\n{entry}\n")
    with pytest.raises(BadInput) as caught:
        read_running(path)
    assert str(caught.value).startswith(f"{path}:6: ")
    assert words in str(caught.value)


@pytest.fixture
def manner_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """How a sweep is called for a table [running] and options."""

    class Called(Exception):
        pass

    def manner(running: str, *options: object) -> dict[str, Any]:
        seen: dict[str, Any] = {}

        class Runner:
            @staticmethod
            def sweep(grid: object, store: object, **keywords: Any) -> None:
                seen.update(keywords)
                raise Called

        monkeypatch.setattr(sweeping, "import_module", lambda name: Runner)
        with pytest.raises(Called):
            main(["sweep", str(grid_file(tmp_path, f"[running]\n{running}\n")), *map(str, options)])
        return seen

    return manner


def test_how_runs_are_run_may_stand_in_the_file_and_the_command_line_wins(manner_of: Any) -> None:
    file = 'jobs = 3\ntimeout = 60\nmemory_limit = "2 GB"\nfail_fast = true\nbackend = "serial"'
    none = manner_of("")
    assert none == {"jobs": 2, "backend": "loky", "on_code_change": "rerun", "retry": False, "until": None}
    assert manner_of(file) == none | tomllib.loads(file)
    won = {"jobs": 1, "timeout": 5.0, "memory_limit": "1 GB", "fail_fast": False, "backend": "loky"}
    options = ["--jobs", 1, "--timeout", 5, "--memory-limit", "1 GB", "--no-fail-fast", "--backend", "loky"]
    assert manner_of(file, *options) == none | won


def test_a_scheduler_means_dask_and_a_back_end_of_the_command_line_sets_the_files_scheduler_aside(
    manner_of: Any,
) -> None:
    assert manner_of('scheduler = "tcp://a:1"')["backend"] == "dask"
    local = manner_of('scheduler = "tcp://a:1"', "--backend", "loky")
    assert local["backend"] == "loky"
    assert "scheduler" not in local
    far = manner_of('backend = "loky"', "--scheduler", "tcp://b:2")
    assert (far["backend"], far["scheduler"]) == ("dask", "tcp://b:2")


def test_a_time_out_of_the_file_ends_a_run(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    store = tmp_path / "late"
    grid = "[constants]\nN = 150\ndt = 1e-5\n[running]\njobs = 1\ntimeout = 0.001\n"
    path = grid_file(tmp_path, grid)
    path.write_text(path.read_text("utf-8").replace('"results"', json.dumps(str(store))), "utf-8")
    assert jamsweep("sweep", path) == 1
    assert "0.001 s" in capsys.readouterr().err


@pytest.mark.parametrize("room", ROOMS)
def test_the_example_is_a_grid_of_its_room_and_each_of_its_comments_an_entry(tmp_path: Path, room: str) -> None:
    path = tmp_path / "grid.toml"
    path.write_text(example(room, "grid.toml", "results/mine"), "utf-8")
    described = read_gridfile(path)
    assert (described.grid.name, len(described.grid), described.store) == (room, 15, "results/mine")
    lines = path.read_text("utf-8").splitlines()
    entries = [line.removeprefix("# ") for line in lines if line.startswith("# ") and " =   # " not in line]
    entries = [line for line in entries if " = " in line or line.startswith("[")]
    path.write_text("\n".join([*(line for line in lines if not line.startswith("#")), ""]), "utf-8")
    constants, running = entries[: entries.index("jobs = 2               # worker processes")], entries
    text = path.read_text("utf-8").replace("[running]", "\n".join(constants) + "\n[running]")
    path.write_text(text + "\n".join(running[len(constants) : entries.index("[until]")]) + "\n", "utf-8")
    whole = read_gridfile(path)
    assert whole.grid.constants.keys() >= {"L", "mass" if room == "parisi_room" else "mu", "time_limit"}
    scenario = {"v_d": 0.8, "seed": 0}
    assert whole.grid.scenario(scenario).canonical() == described.grid.scenario(scenario).canonical()
    assert read_running(path).keys() == {"jobs", "timeout", "memory_limit", "fail_fast", "backend", "scheduler"}


def test_init_writes_a_file_that_sweeps_and_replaces_none(
    tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert jamsweep("init") == 0
    assert jamsweep("sweep", "grid.toml", "--dry-run") == 0
    assert capsys.readouterr().out == "grid.toml\n15 runs: 0 done, 15 to do\n"
    Path("grid.toml").write_text("mine")
    assert jamsweep("init") == 2
    assert "'grid.toml' is there already: name another, or give --force" in capsys.readouterr().err
    assert Path("grid.toml").read_text() == "mine"
    assert jamsweep("init", "--force", "--room", "parisi-room", "--store", "other") == 0
    assert read_gridfile(Path("grid.toml")).store == "other"
    for wrong in (["--room", "hall"], ["--store", 'a"b'], ["--store", ""]):
        assert jamsweep("init", "another.toml", *wrong) == 2
    assert not Path("another.toml").exists()
