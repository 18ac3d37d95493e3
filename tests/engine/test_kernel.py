"""Promises about the compiled code: vectorised, cached on disk, and the same without the compiler."""

import json
import os
import platform
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba import njit, typeof

from engine import Crowd, Scene, fingerprint, models, rooms, simulate
from engine.kernel import forces
from engine.kernel.exponential import exp
from engine.kernel.integrators import INTEGRATORS
from engine.kernel.rest import at_rest
from engine.kernel.scene_arrays import as_arrays
from engine.kernel.simulation import Simulation
from engine.kernel.state import BLOCK, ROWS
from tests.engine.scenes import NO_WALLS, pressed

ROOT = Path(__file__).parents[2]
SMALL = {"v_d": 2.0, "N": 12, "seed": 5, "size": 4.0}
MODELS = {
    "lin": models.lin_dem(wall_mu=0.1),  # at mu = 0.5 a step this long amplifies rounding
    "lin with springs kept": models.lin_dem(friction="kept", wall_friction="kept"),
    "parisi": models.parisi_dorso(),
    "lambda": models.lambda_anisotropic(),
}
COMPARED = ("time", "x", "y", "vx", "vy", "spin", "row_size", "contact_i", "contact_j")
COMPARED += ("tangential_displacement", "contact_F_n", "contact_F_t")


def in_a_new_process(code, **environment):
    """Run code in a fresh interpreter; what it prints as JSON."""
    found = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=os.environ | environment, check=True, capture_output=True, text=True
    )
    return json.loads(found.stdout)


def test_the_polynomial_exponential_is_within_1e13():
    compiled = njit(lambda x: exp(x))
    for x in np.concatenate([np.linspace(-700, 700, 20001), np.linspace(-1, 1, 20001)]):
        assert compiled(x) == pytest.approx(np.exp(x), rel=1e-13)


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="looks for x86-64 vector registers")
@pytest.mark.parametrize("model", [models.lin_dem(), models.parisi_dorso(), models.lambda_anisotropic()])
def test_the_pair_arithmetic_is_vectorised(model):
    loop = njit(error_model="numpy")(forces.social_forces.py_func)
    scenario = rooms.lin_room(**SMALL)
    run = Simulation(scenario, scenario.crowd.draw(5, NO_WALLS))
    arguments = model, 0.3, run.persons, run.pairs, 0, 0, np.ones(ROWS * BLOCK)
    loop.compile(tuple(map(typeof, arguments)))
    (assembly,) = loop.inspect_asm().values()
    for operation in ("vsqrtpd", "vdivpd", "vmulpd"):
        assert re.search(rf"{operation}\s.*(ymm|zmm)", assembly), operation


def test_a_second_process_compiles_nothing():
    code = (
        "import json; from engine import rooms, simulate; from engine.kernel.step import advance\n"
        f"simulate(rooms.lin_room(**{SMALL}, time_limit=0.01))\n"
        "stats = advance.stats\n"
        "print(json.dumps([sum(stats.cache_misses.values()), sum(stats.cache_hits.values())]))"
    )
    simulate(rooms.lin_room(**SMALL, time_limit=0.01))
    misses, hits = in_a_new_process(code)
    assert (misses, hits) == (0, 1)


def computed(model, integrator):
    """All that a run of pressed persons computes, as lists, and whether it is at rest for so many seconds."""
    scenario = pressed(MODELS[model], integrator)
    run = Simulation(scenario, scenario.crowd.draw(0, NO_WALLS))
    for _ in run.advance():
        pass
    samples, exits = run.recorder.samples(), run.exits[: run.state["N_out"]]
    lists = run.persons, run.pairs, run.wall_pairs, run.contacts, run._states
    rests = [at_rest(MODELS[model], as_arrays(scenario.scene).exits, *lists, wait) for wait in np.logspace(-9, -4, 6)]
    found = {name: getattr(samples, name) for name in COMPARED}
    found |= {"exit_time": exits["time"], "exit_y": exits["y"], "rests": np.array(rests)}
    found |= {"counts": np.array([run.state["rebuilds"], run.state["substepped_steps"]])}
    return {name: values.tolist() for name, values in found.items()}


def drawn():
    """A crowd in a room that is nearly full, with a wall across it."""
    walls = as_arrays(Scene(((0.0, 2.0, 6.0, 4.0),))).walls
    return [values.tolist() for values in Crowd.uniform(45, (0.0, 6.0, 0.0, 6.0)).draw(5, walls)]


@pytest.fixture(scope="module")
def plain():
    """What plain Python computes."""
    code = (
        "import json; from tests.engine.test_kernel import INTEGRATORS, MODELS, computed, drawn\n"
        "found = {f'{m}, {i}': computed(m, i) for m in MODELS for i in INTEGRATORS}\n"
        "print(json.dumps(found | {'drawn': drawn()}))"
    )
    return in_a_new_process(code, NUMBA_DISABLE_JIT="1")


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_plain_python_gives_the_compiled_run(model, integrator, plain):
    compiled = {name: np.array(values) for name, values in computed(model, integrator).items()}
    pairs, walls = (compiled["contact_j"] >= 0).sum(), (compiled["contact_j"] < 0).sum()
    assert min(pairs, walls) > 50, "they must be pressed for this to test anything"
    assert compiled["exit_time"].size == 1
    for name, values in compiled.items():
        expected = np.array(plain[f"{model}, {integrator}"][name])
        assert values.shape == expected.shape, name
        size = np.nanmax(np.abs(expected), initial=0.0)
        assert values == pytest.approx(expected, rel=0.0, abs=1e-9 * size, nan_ok=True), name


def test_plain_python_places_persons_where_compiled_code_does(plain):
    assert drawn() == plain["drawn"]


def test_the_fingerprint_follows_the_code_and_not_its_comments(tmp_path):
    source = tmp_path / "law.py"
    marks = []
    for text in (
        'def f(x):\n    """One."""\n    return x\n',
        "def f(x):\n    # two\n    return x\n",
        "def f(x: float) -> float:\n    return x\n",
        "def f(x):\n    return -x\n",
    ):
        source.write_text(text)
        marks.append(fingerprint.fingerprint(tmp_path))
    assert marks[0] == marks[1] == marks[2] != marks[3]
