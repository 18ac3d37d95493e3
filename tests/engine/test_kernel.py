"""Promises about the compiled code: vectorised, cached on disk, and the same without the compiler."""

import json
import os
import platform
import re
import subprocess
import sys

import numpy as np
import pytest
from numba import njit

from engine import cache, forces, models, rooms, simulate
from engine.exponential import exp
from engine.integrators import INTEGRATORS
from engine.neighbours import nobody_in_touch, nobody_near

simulation = sys.modules["engine.simulate"]  # the name engine.simulate is the function

SMALL = {"v_d": 2.0, "N": 12, "seed": 5, "size": 4.0}


def in_a_new_process(code, **environment):
    """Run code in a fresh interpreter; what it prints as JSON."""
    found = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | environment, check=True, capture_output=True, text=True
    )
    return json.loads(found.stdout)


def test_the_polynomial_exponential_is_within_1e13():
    compiled = njit(lambda x: exp(x))
    for x in np.concatenate([np.linspace(-700, 700, 20001), np.linspace(-1, 1, 20001)]):
        assert compiled(x) == pytest.approx(np.exp(x), rel=1e-13)


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="looks for x86-64 vector registers")
@pytest.mark.parametrize("model", [models.lin_dem(), models.parisi_dorso(), models.lambda_anisotropic()])
def test_the_pair_arithmetic_is_vectorised(model):
    loop = njit(error_model="numpy")(forces._between_persons.py_func)
    scenario = rooms.lin_room(**SMALL)
    people = simulation._people(scenario, scenario.crowd.draw(5, np.empty((0, 5))))
    scratch, touching = np.ones(forces.ROWS * forces.BLOCK), np.empty(forces.BLOCK + 1, np.uint32)
    loop(INTEGRATORS["semi_implicit"], model, people, nobody_near(), nobody_in_touch(0), 0.0, 0.0, scratch, touching)
    (assembly,) = loop.inspect_asm().values()
    for operation in ("vsqrtpd", "vdivpd", "vmulpd"):
        assert re.search(rf"{operation}\s.*(ymm|zmm)", assembly), operation


def test_a_second_process_compiles_nothing():
    code = (
        "import json; from engine import rooms, simulate; from engine.integrate import advance\n"
        f"simulate(rooms.lin_room(**{SMALL}, time_limit=0.01))\n"
        "stats = advance.stats\n"
        "print(json.dumps([sum(stats.cache_misses.values()), sum(stats.cache_hits.values())]))"
    )
    simulate(rooms.lin_room(**SMALL, time_limit=0.01))
    misses, hits = in_a_new_process(code)
    assert (misses, hits) == (0, 1)


def test_plain_python_gives_the_compiled_run():
    code = (
        "import json; from engine import rooms, simulate\n"
        f"run = simulate(rooms.lin_room(**{SMALL}, dt=1e-3, time_limit=0.4, every=0.1))\n"
        "print(json.dumps([run.samples.x.tolist(), run.samples.spin.tolist(), run.max_overlap]))"
    )
    compiled, plain = in_a_new_process(code), in_a_new_process(code, NUMBA_DISABLE_JIT="1")
    for mine, theirs in zip(compiled, plain, strict=True):
        assert np.array(mine) == pytest.approx(np.array(theirs), abs=1e-12)


def test_the_fingerprint_follows_the_code_and_not_its_comments(tmp_path):
    source = tmp_path / "law.py"
    marks = []
    for text in (
        'def f(x):\n    """One."""\n    return x\n',
        "def f(x):\n    # two\n    return x\n",
        "def f(x):\n    return -x\n",
    ):
        source.write_text(text)
        marks.append(cache.fingerprint(tmp_path))
    assert marks[0] == marks[1] != marks[2]
