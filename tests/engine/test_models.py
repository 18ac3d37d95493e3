"""The readings of what Lin, Ma & Lo leave open are the laws that they are said to be."""

import pytest

from engine import BadInput, laws, models
from engine.laws import Absent, Coulomb, Exponential, Kinetic, Mindlin, MindlinReset

K_T = 2 * 5e6 / (1.25 * 1.75)
KEPT, RESET = Mindlin(K_T, 0.8, 0.5), MindlinReset(K_T, 0.8, 0.5)
READINGS = {
    "RK": (RESET, Kinetic(0.5, 0.01)),
    "RS": (RESET, Coulomb(0.5, 0.001)),
    "W": (KEPT, KEPT),
    "W01": (KEPT, Mindlin(K_T, 0.8, 0.1)),
    "R02": (RESET, MindlinReset(K_T, 0.8, 0.2)),
    "WK": (KEPT, Kinetic(0.5, 0.01)),
    "WR": (RESET, RESET),
    "B": (KEPT, KEPT),
}


@pytest.mark.parametrize("reading", READINGS)
def test_a_reading_is_its_pair_of_sliding_laws(reading):
    model = models.lin_dem(reading)
    assert (model.sliding, model.wall_sliding) == READINGS[reading]
    assert [type(law) for law in model[5:8:2]] == [
        Absent if reading == "B" else Exponential,
        type(READINGS[reading][1]),
    ]
    assert set(READINGS) == set(models.READINGS)


def test_stiffnesses_are_those_of_the_text():
    model = models.lin_dem()
    assert model.normal.k_n == pytest.approx(3.5556e6, rel=1e-4)
    assert model.sliding.k_t == pytest.approx(4.5714e6, rel=1e-4)


def test_vision_weighs_the_front_more():
    assert laws.vision(laws.Cosine(0.3), 1.0) == pytest.approx(1.3)
    assert laws.vision(laws.Cosine(0.3), -1.0) == pytest.approx(0.7)
    assert laws.vision(laws.Lambda(0.3), 1.0) == pytest.approx(1.0)
    assert laws.vision(laws.Lambda(0.3), -1.0) == pytest.approx(0.3)


def test_the_social_force_ends_without_a_jump_at_its_reach():
    law = laws.cut_at(Exponential(300.0, 0.05), 1e-3)
    reach = laws.reach(law)
    assert reach == pytest.approx(0.05 * 12.6115, rel=1e-4)
    assert laws.social(law, reach + 1e-9) == 0.0
    assert 0.0 < laws.social(law, reach - 1e-6) < 1e-6
    assert laws.social(law, 0.0) == pytest.approx(300.0, rel=1e-5)


def test_a_law_from_elsewhere_is_refused():
    """The fingerprint of the engine's sources would not tell its edits."""
    with pytest.raises(BadInput, match="stands outside the package engine"):
        laws.social.law(type("Mine", (), {}))(lambda p, gap: 0.0)
