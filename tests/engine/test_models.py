"""The variants of what Lin, Ma & Lo leave open are the laws that they are said to be."""

import pytest

from engine import Crowd, Options, Scenario, Scene, laws, models
from engine.kernel.simulation import Simulation
from tests.engine.scenes import PAPERS

K_T = 2 * 5e6 / (1.25 * 1.75)
LAWS = {
    "reset": laws.MindlinReset(K_T, 0.8, 0.5),
    "reset_to_zero": laws.MindlinResetToZero(K_T, 0.8, 0.5),
    "kept": laws.Mindlin(K_T, 0.8, 0.5),
    "kinetic": laws.Kinetic(0.5, 0.01),
    "coulomb": laws.Coulomb(0.5, 0.001),
    "none": laws.Absent(),
}


def kinds(*of_contacts):
    """Laws with their types: two laws of equal numbers are equal tuples."""
    return [(type(law), law) for law in of_contacts]


@pytest.mark.parametrize("friction", LAWS)
@pytest.mark.parametrize("wall_friction", LAWS)
def test_a_friction_keyword_is_its_law_between_persons_and_at_walls(friction, wall_friction):
    model = models.lin_dem(friction=friction, wall_friction=wall_friction, mu=0.5)
    assert kinds(model.friction, model.wall_friction) == kinds(LAWS[friction], LAWS[wall_friction])


def test_the_default_is_a_spring_that_is_kept_and_kinetic_friction_at_walls_that_push():
    model = models.lin_dem()
    assert set(LAWS) == set(models.FRICTION)
    assert kinds(model.friction, model.wall_friction) == kinds(LAWS["kept"]._replace(mu=0.3), LAWS["kinetic"])
    assert kinds(model.social, model.wall_social) == kinds(laws.Exponential(300.0, 0.05), laws.Exponential(300.0, 0.05))


def test_walls_may_have_friction_and_a_social_force_of_their_own():
    model = models.lin_dem(wall_friction="kept", wall_mu=0.1, wall_A=100.0, mu=0.4)
    assert (model.friction.mu, model.wall_friction.mu, model.wall_social) == (0.4, 0.1, laws.Exponential(100.0, 0.05))
    assert models.lin_dem(wall_social=False).wall_social == laws.Absent()
    assert models.lin_dem(A=200.0).wall_social.A == 200.0


def test_stiffnesses_are_those_of_the_text():
    model = models.lin_dem()
    assert model.normal.k_n == pytest.approx(3.5556e6, rel=1e-4)
    assert model.friction.k_t == pytest.approx(4.5714e6, rel=1e-4)


def test_anisotropy_weighs_the_front_more():
    assert laws.anisotropy(laws.Cosine(0.3), 1.0) == pytest.approx(1.3)
    assert laws.anisotropy(laws.Cosine(0.3), -1.0) == pytest.approx(0.7)
    assert laws.anisotropy(laws.Lambda(0.3), 1.0) == pytest.approx(1.0)
    assert laws.anisotropy(laws.Lambda(0.3), -1.0) == pytest.approx(0.3)


def test_the_social_force_ends_where_it_has_fallen_to_the_tolerance():
    law = laws.Exponential(300.0, 0.05)
    assert laws.cutoff(law, 1e-3) == pytest.approx(0.05 * 12.6115, rel=1e-4)
    assert laws.social(law, laws.cutoff(law, 1e-3)) == pytest.approx(1e-3, rel=1e-12)
    assert laws.cutoff(law, 400.0) == 0.0
    assert laws.cutoff(laws.Absent(), 1e-3) == 0.0


@pytest.mark.parametrize("other", ["person", "wall"])
def test_the_social_force_ends_without_a_jump(other):
    cutoff = laws.cutoff(laws.Exponential(300.0, 0.05), 1e-3)

    def force(gap):
        """Force on person 0 at the origin, N."""
        persons = ([0.0, 0.6 + gap], [0.0, 0.0]) if other == "person" else ([0.0], [0.0])
        walls = () if other == "person" else ((0.3 + gap, -9.0, 0.3 + gap, 9.0),)
        crowd = Crowd.given(*persons, 0.0, 0.0, 0.0, 0.3, 70.0, 0.0)
        scenario = Scenario(Scene(walls), crowd, models.lin_dem(), Options(**PAPERS, dt=1e-3))
        simulation = Simulation(scenario, crowd.draw(0, None))
        next(simulation.advance())
        return -simulation.persons.fx[0]

    assert force(cutoff + 1e-9) == 0.0
    assert 0.0 < force(cutoff - 1e-6) < 1e-6
    assert force(0.0) == pytest.approx(300.0, rel=1e-5)
