"""Laws in a user's own file: run as the engine's own, and told from their edits."""

import importlib.util
import math
import sys
from typing import Annotated, NamedTuple

import numpy as np
import pytest

from engine import BadInput, Crowd, Options, Scenario, Scene, laws, models, simulate
from engine.rooms import square_room
from tests.engine.scenes import UNDRIVEN

PLAIN = Options(time_limit=2.0, record_every=0.5)
FILE = '''
from typing import Annotated, NamedTuple
from engine import laws


class PowerLaw(NamedTuple):
    """Social force A (1 + gap/B)^-n; A in overlap."""

    A: Annotated[float, laws.at_least(0.0, "N", "force at contact")]
    B: Annotated[float, laws.above(0.0, "m", "range")]
    n: Annotated[float, laws.above(0.0, "1", "exponent")]


@laws.social.law(PowerLaw)
def power_law(p, gap):
    return p.A * (1.0 + max(gap, 0.0) / p.B) ** -p.n
'''


def loaded(path, text):
    """A module of this text, loaded as a user's file is."""
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def scenario(social):
    """Ten persons in a small room, without contacts, which take half the time to compile."""
    crowd = Crowd.uniform(10, (0.0, 4.0, 0.0, 4.0), v_d=2.0)
    model = models.Model(laws.Relaxation(0.5), social, wall_social=laws.Exponential(300.0, 0.05))
    return Scenario(square_room(4.0, 1.0), crowd, model, PLAIN, seed=3)


def test_a_law_of_the_users_own_with_the_engines_formula_gives_the_engines_run(tmp_path):
    text = FILE.replace("p.A * (1.0 + max(gap, 0.0) / p.B) ** -p.n", "p.A * laws.exp(gap * (-1.0 / p.B))")
    mine = loaded(tmp_path / "mine.py", text).PowerLaw(300.0, 0.05, 1.0)
    own, engines = simulate(scenario(mine)).samples, simulate(scenario(laws.Exponential(300.0, 0.05))).samples
    assert own.x == pytest.approx(engines.x, abs=1e-12, nan_ok=True)


def test_an_edited_law_gives_new_results_in_the_same_process(tmp_path):
    """Numba's own caches know the type's name alone."""
    weak, strong = (
        loaded(tmp_path / "mine.py", text).PowerLaw(300.0, 0.2, 4.0)
        for text in (FILE, FILE.replace("return p.A", "return 3.0 * p.A"))
    )
    before, after, again = (simulate(scenario(law)).samples.x[1] for law in (weak, strong, weak))
    assert np.abs(after - before).max() > 1e-3
    assert (again == before).all()


def test_the_fingerprint_of_a_law_follows_its_code_its_constants_and_what_it_calls(tmp_path):
    helper = "\nfrom numba import njit\nC = 1.0\n\n@njit\ndef scale(gap):\n    return C * gap\n"
    text = FILE.replace("max(gap, 0.0)", "max(scale(gap), 0.0)") + helper
    versions = {
        "as it is": text,
        "a comment": text.replace("return p.A", "# why\n    return p.A"),
        "another room beside it": text + "\ndef room():\n    return 7\n",
        "the formula": text.replace("** -p.n", "** -(p.n + 1.0)"),
        "a constant": text.replace("C = 1.0", "C = 1.5"),
        "what it calls": text.replace("return C * gap", "return C * gap * 1.5"),
    }
    marks = {}
    for what, version in versions.items():
        law = loaded(tmp_path / "mine.py", version).PowerLaw(300.0, 0.2, 4.0)
        marks[what] = scenario(law).law_fingerprint
    same = ["as it is", "a comment", "another room beside it"]
    assert len({marks[what] for what in same}) == 1
    assert len(set(marks.values())) == 4
    assert scenario(laws.Exponential(300.0, 0.05)).law_fingerprint == ""


def test_a_law_that_refers_to_what_no_key_can_tell_is_refused(tmp_path):
    text = FILE.replace("return p.A", "return TABLE[0] * p.A") + "\nTABLE = [1.0, 2.0]\n"
    law = loaded(tmp_path / "mine.py", text).PowerLaw(300.0, 0.2, 4.0)
    with pytest.raises(BadInput, match="refers to TABLE, a list, which no run's key can tell"):
        scenario(law)


@pytest.mark.parametrize(
    ("values", "complaint"),
    [
        ((300.0, 0.2, 0.0), "social n 0.0 is not a finite number above 0"),
        ((-1.0, 0.2, 4.0), "social A -1.0 is not a finite number of 0 or more"),
        ((300.0, 0.2, 0.1), "is no repulsion that falls below 0.3 N with the gap"),
    ],
)
def test_parameters_out_of_the_range_at_their_field_are_refused(tmp_path, values, complaint):
    law = loaded(tmp_path / "mine.py", FILE).PowerLaw(*values)
    with pytest.raises(BadInput, match=complaint):
        scenario(law)


def test_a_social_force_that_attracts_is_refused(tmp_path):
    text = FILE.replace("p.A * (1.0 + max(gap, 0.0) / p.B) ** -p.n", "p.A * (0.1 - gap) * (gap < p.B)")
    law = loaded(tmp_path / "mine.py", text).PowerLaw(300.0, 0.5, 4.0)
    with pytest.raises(BadInput, match="is no repulsion"):
        scenario(law)


def test_a_law_under_the_name_of_one_of_the_engines_is_refused(tmp_path):
    law = loaded(tmp_path / "mine.py", FILE.replace("PowerLaw", "Exponential")).Exponential(300.0, 0.2, 4.0)
    with pytest.raises(BadInput, match="has the name of a law of the engine"):
        scenario(law)
    engines = scenario(laws.Exponential(300.0, 0.2))
    assert Scenario.from_json(engines.to_json()).model == engines.model  # the text of a stored run means the engine's


class Quadratic(NamedTuple):
    """Friction without memory, -c F_n v_t abs(v_t)/(1 + v_t^2)."""

    c: Annotated[float, laws.at_least(0.0, "1", "coefficient")]


@laws.friction.law(Quadratic)
def quadratic(p, overlap, radius, mass, v_t, F_n):
    return -p.c * F_n * v_t * abs(v_t) / (1.0 + v_t * v_t)


def test_a_friction_law_without_memory_slows_at_long_steps_as_at_short_ones():
    """A person who is thrown back by a wall while sliding along it; nothing else slows the slide."""
    crowd = Crowd.given([0.0], [0.29], 3.0, 0.0, 0.0, 0.3, 70.0, 0.0)
    model = models.lin_dem(**UNDRIVEN, g_n=0.0)._replace(wall_friction=Quadratic(0.5), rotation=laws.Absent())
    sliding = Scenario(Scene(((-50.0, 0.0, 50.0, 0.0),)), crowd, model, Options(time_limit=0.05, record_every=0.005))
    long, short = (simulate(sliding, dt=dt).samples.vx[:, 0] for dt in (None, 1e-5))
    assert (np.diff(long) <= 1e-12).all()
    assert 3.0 - short[-1] > 0.1
    assert 3.0 - long[-1] == pytest.approx(3.0 - short[-1], rel=0.05)


def test_a_friction_law_with_another_number_of_arguments_is_refused():
    with pytest.raises(TypeError, match="takes 3 arguments: friction takes"):
        laws.friction.law(type("Odd", (), {}))(lambda p, v_t, F_n: 0.0)


class Shifted(NamedTuple):
    """As the engine's exponential force, ten times as far."""

    A: float
    B: float


@laws.social.law(Shifted)
def shifted(p, gap):
    return p.A * math.exp(-gap / (10.0 * p.B))


def test_two_laws_of_the_same_numbers_have_each_their_own_cutoff_and_step():
    """They are equal tuples, which no cache may take for the same."""
    ours, mine = scenario(laws.Exponential(300.0, 0.05)), scenario(Shifted(300.0, 0.05))
    assert laws.cutoff(mine.model.social, 0.3) == pytest.approx(10.0 * laws.cutoff(ours.model.social, 0.3))
    stiff = [scenario(kind(3e6, 0.05)).numerics.dt for kind in (laws.Exponential, Shifted)]
    assert stiff[1] > stiff[0]


def test_the_fingerprint_of_a_law_follows_what_it_takes_from_a_module_of_the_users(tmp_path, monkeypatch):
    """`my_constants.K` and `my_constants.scale(gap)`, by the name of the module."""
    text = "import math\nimport my_constants\n" + FILE.replace(
        "return p.A", "return my_constants.K * my_constants.scale(1.0) * math.exp(0.0) * p.A"
    )
    marks = []
    for K, factor in ((1.0, 1.0), (2.0, 1.0), (1.0, 3.0), (1.0, 1.0)):
        constants = f"from numba import njit\nK = {K}\n\n@njit\ndef scale(x):\n    return {factor} * x\n"
        monkeypatch.setitem(sys.modules, "my_constants", loaded(tmp_path / "my_constants.py", constants))
        marks.append(scenario(loaded(tmp_path / "mine.py", text).PowerLaw(300.0, 0.2, 4.0)).law_fingerprint)
    assert marks[0] == marks[3]
    assert len(set(marks)) == 3
