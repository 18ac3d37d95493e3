"""The fingerprint means what it says: what turns a scenario into a run, and nothing else."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import engine
from engine.fingerprint import fingerprint

ENGINE = Path(engine.__file__).parent
CODE = """
import json, sys
from engine import FINGERPRINT, Crowd, Model, Options, Scenario, laws, rooms, simulate
from engine.kernel.step import advance
from sweep.schema import run_key
walking = Model(laws.Relaxation(0.5))  # compiles fastest
crowd, options = Crowd.uniform(4, (0.0, 4.0, 0.0, 4.0)), Options(time_limit=0.1)
scenario = Scenario(rooms.square_room(4.0, 1.0), crowd, walking, options)
simulate(scenario)
print(json.dumps([FINGERPRINT, run_key(scenario), sum(advance.stats.cache_misses.values())]))
"""
NEW_ROOM = '''
@with_options
def hall(N: int = 10, seed: int = 0) -> Scenario:
    """A hall."""
    return Scenario(square_room(9.0, 1.0), Crowd.uniform(N, (0.0, 9.0, 0.0, 9.0)), models.lin_dem(), seed=seed)
'''
NEW_MODEL = '''
def soft(A: float = 100.0) -> Model:
    """A soft one."""
    return parisi_dorso(A)
'''


@pytest.fixture
def copied(tmp_path):
    """A copy of the engine and the sweep layer."""
    for package in ("engine", "sweep"):
        shutil.copytree(ENGINE.parent / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def seen(root):
    """Fingerprint, key of a run, compilations, and how often one is said, in a new process with this code."""
    environment = os.environ | {"PYTHONPATH": str(root), "NUMBA_CACHE_DIR": str(root / "numba")}
    found = subprocess.run(
        [sys.executable, "-c", CODE], env=environment, cwd=root, check=True, capture_output=True, text=True
    )
    return [*json.loads(found.stdout), found.stderr.count("compiling the kernel for these laws")]


def edit(path, old, new):
    """Replace a piece of a source file."""
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_a_new_room_a_new_model_and_a_reworded_error_keep_runs_valid_and_kernels_compiled(copied):
    before = seen(copied)
    with (copied / "engine/rooms.py").open("a") as rooms, (copied / "engine/models.py").open("a") as models:
        rooms.write(NEW_ROOM)
        models.write(NEW_MODEL)
    edit(copied / "engine/errors.py", "is not a finite number", "must be a finite number")
    edit(copied / "engine/kernel/forces.py", "# m, out of the reach of any law", "# m, beyond any law")
    after = seen(copied)
    assert before[2:] == [1, 1]
    assert after == [*before[:2], 0, 0]


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("laws/normal_contact.py", "p.k_n * overlap - p.g_n * v_n", "p.k_n * overlap + p.g_n * v_n"),
        ("integrators/velocity_verlet.py", "state.n, 0.5 * dt", "state.n, 0.25 * dt"),
        ("placement.py", "MAX_ROUNDS = 2000", "MAX_ROUNDS = 1000"),
        ("rest.py", "SAFETY = 2.0", "SAFETY = 1.0"),
    ],
)
def test_an_edited_law_integrator_or_placement_changes_the_fingerprint(copied, file, old, new):
    kernel = copied / "engine" / "kernel"
    before = fingerprint(kernel)
    edit(kernel / file, old, new)
    assert fingerprint(kernel) != before
