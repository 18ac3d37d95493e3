"""Rooms and laws in a user's own file: swept from Python, a grid file and the command line, and never served stale."""

import subprocess
import sys

import pytest
from click.testing import CliRunner

from engine import BadInput
from sweep import Grid, sweep
from sweep.cli import cli
from sweep.rooms import room_named
from tests.engine.test_custom_laws import FILE

ROOM = '''
from engine import Crowd, Scenario, models
from engine.rooms import square_room


def my_room(v_d: float = 1.0, N: int = 6, seed: int = 0) -> Scenario:
    """A square room of 4 m."""
    crowd = Crowd.uniform(N, (0.0, 4.0, 0.0, 4.0), v_d=v_d)
    return Scenario(square_room(4.0, 1.0), crowd, MODEL, seed=seed)
'''
PLAIN = ROOM.replace("MODEL", "models.lin_dem()")
LEAN = "models.Model(laws.Relaxation(0.5), PowerLaw(300.0, 0.2, 4.0), wall_social=laws.Exponential(300.0, 0.05))"
WITH_LAW = FILE + ROOM.replace("MODEL", LEAN)  # without contacts, which take half the time to compile
GRID = """room = "my_rooms.py:my_room"
store = "results"
[axes]
seed = [0, 1]
[constants]
time_limit = 3.0
record_every = 1.0
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder, in which commands are given."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sweep.rooms._loaded", {})
    return tmp_path


def test_a_room_in_a_file_has_every_option_and_its_own_keywords(folder):
    (folder / "my_rooms.py").write_text(PLAIN)
    scenario = room_named("my_rooms.py:my_room")(v_d=1.3, N=3, accuracy="0.1mm", blocked_after=7.0)
    assert (scenario.crowd.N, scenario.crowd.v_d, scenario.options.blocked_after) == (3, (1.3, 1.3), 7.0)
    assert scenario.numerics.dt < room_named("my_rooms.py:my_room")().numerics.dt


def test_a_room_in_a_file_is_run_and_swept_by_command(folder):
    (folder / "my_rooms.py").write_text(PLAIN)
    (folder / "grid.toml").write_text(GRID)
    run = CliRunner().invoke(cli, ["run", "my_rooms.py:my_room", "--v-d", "1.5", "--time-limit", "2"])
    assert "stopped at the time limit of 2 s" in run.output
    swept = CliRunner().invoke(cli, ["sweep", "grid.toml", "--backend", "serial"])
    assert "2 time_limit" in swept.output
    assert "v-d" in CliRunner().invoke(cli, ["run", "my_rooms.py:my_room", "--help"]).output


def test_a_law_in_a_file_reaches_workers_and_an_edit_of_it_is_never_served_stale(folder):
    (folder / "my_rooms.py").write_text(WITH_LAW)
    before = sweep(Grid("my_rooms.py:my_room", seed=range(2), time_limit=3.0), "results", jobs=2)
    assert (before.outcome != 0).all()
    (folder / "my_rooms.py").write_text(WITH_LAW.replace("return p.A", "return 3.0 * p.A"))
    script = (
        "import sys\nfrom sweep import Grid, sweep\n"
        "ds = sweep(Grid('my_rooms.py:my_room', seed=range(2), time_limit=3.0), 'results', jobs=2)\n"
        "print(*ds.max_speed.values)\n"
    )
    found = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert "2 of 2 runs are done by another state of the engine or of a law" in found.stderr
    after = [float(word) for word in found.stdout.split()]
    assert all(a != pytest.approx(b, rel=1e-6) for a, b in zip(after, before.max_speed.values, strict=True))


def test_a_law_in_the_script_itself_reaches_workers(folder):
    (folder / "script.py").write_text(
        WITH_LAW + "\nfrom sweep import Grid, sweep\n"
        "ds = sweep(Grid(my_room, seed=range(2), time_limit=3.0), 'results', jobs=2)\n"
        "print((ds.outcome.values != 0).sum())\n"
    )
    found = subprocess.run([sys.executable, "script.py"], check=True, capture_output=True, text=True)
    assert found.stdout.split() == ["2"]


@pytest.mark.parametrize(
    ("name", "text", "complaint"),
    [
        ("other.py:my_room", "", "room file 'other.py' is not there"),
        ("my_rooms.py:hall", PLAIN, "room 'hall' is no function in 'my_rooms.py'"),
        ("my_rooms.py:my_room", "x = 1\nimport nothing_such\n", "room file 'my_rooms.py', line 2: ModuleNotFoundError"),
        ("my_rooms.py:my_room", "def f(:\n", "room file 'my_rooms.py', line 1: SyntaxError"),
        ("hall", "", "room 'hall' is not known: choose one of lin_room, parisi_room, or name a file"),
    ],
)
def test_a_room_that_cannot_be_had_is_named_with_its_line(folder, name, text, complaint):
    (folder / "my_rooms.py").write_text(text)
    with pytest.raises(BadInput, match=complaint):
        Grid(name, seed=[0])
