"""Contact forces against closed forms: whoever stands still is held by what drives it."""

import math

import numpy as np
import pytest
import xarray as xr

from engine import BadInput, Crowd, Exit, Model, Options, Scenario, Scene, laws, models, simulate
from sweep import to_dataset
from sweep.exports import forces_on_persons, forces_on_walls
from tests.engine.scenes import PAPERS

MASS, RADIUS, TAU = 80.0, 0.3, 0.5
WALL = (1.0, -2.0, 1.0, 2.0)  # in the way to the exit
EXIT = Exit((2.0, -1.0), (2.0, 1.0), (1.0, 0.0))
NO_SOCIAL = models.lin_dem(A=0.0, friction="kept", wall_friction="kept")


def pressed(
    model: Model, v_d: float, persons: int = 1, walls: tuple = (WALL,), line: Exit = EXIT, **recorded: object
) -> xr.Dataset:
    """Persons in single file, driven against walls until they stand: the drive damps bouncing by exp(-t/(2 tau))."""
    x = 1.0 - RADIUS - 2 * RADIUS * np.arange(persons)
    crowd = Crowd.given(x, np.zeros(persons), 0.0, 0.0, 0.0, RADIUS, MASS, v_d)
    options = Options(**PAPERS, dt=5e-4, time_limit=20.0, stop_at_rest=False, record_every=0.5, contacts=True)
    scenario = Scenario(Scene(walls, (line,)), crowd, model, options)
    return to_dataset(simulate(scenario, **recorded))


def test_a_wall_holds_what_drives_a_person_against_it() -> None:
    run, drive = pressed(NO_SOCIAL, v_d=2.0), MASS * 2.0 / TAU
    on_wall, on_person = forces_on_walls(run).isel(sample=-1), forces_on_persons(run).isel(sample=-1)
    assert on_wall.wall_force.item() == pytest.approx(drive, rel=1e-4)
    assert (on_wall.wall_force_x.item(), on_wall.wall_force_y.item()) == pytest.approx((drive, 0.0), rel=1e-4, abs=0.1)
    assert on_wall.wall_load.item() == pytest.approx(drive / 4.0, rel=1e-4)
    assert on_person.contact_force_x.item() == pytest.approx(-drive, rel=1e-4)
    assert on_person.contact_force.item() == pytest.approx(drive, rel=1e-4)
    assert on_person.pressure.item() == pytest.approx(drive / (2 * math.pi * RADIUS), rel=1e-4)


@pytest.mark.parametrize("make", [models.lin_dem, models.parisi_dorso])
def test_the_social_force_of_a_wall_takes_its_part_of_the_drive(make) -> None:
    model, v_d = make(), 15.0 if make is models.parisi_dorso else 3.0
    run = pressed(model, v_d)
    overlap = run.x.isel(sample=-1).item() + RADIUS - 1.0
    social = laws.social(model.wall_social, -overlap)
    found = forces_on_walls(run).isel(sample=-1)
    assert 0.1 * social < found.wall_force.item() < 10.0 * social  # both take a part that counts
    assert found.wall_force.item() == pytest.approx(MASS * v_d / TAU - social, rel=1e-4)


def test_a_file_of_persons_hands_its_drives_on() -> None:
    run, drive = pressed(NO_SOCIAL, v_d=1.0, persons=3), MASS * 1.0 / TAU
    assert forces_on_walls(run).wall_force.isel(sample=-1).item() == pytest.approx(3 * drive, rel=1e-4)
    last = forces_on_persons(run).isel(sample=-1)
    assert last.contact_force.values == pytest.approx([5 * drive, 3 * drive, drive], rel=1e-4)  # 3 + 2, 2 + 1, 1
    assert last.contact_force_x.values == pytest.approx([-drive] * 3, rel=1e-4)


def test_the_point_where_two_walls_meet_acts_once() -> None:
    wedge = ((1.0, 0.0, 2.0, 1.0), (1.0, 0.0, 2.0, -1.0))
    run, drive = pressed(NO_SOCIAL, v_d=2.0, walls=wedge), MASS * 2.0 / TAU
    assert run.row_size.values[-1] == 1  # the one that acts is recorded
    assert forces_on_walls(run).wall_force.isel(sample=-1).sum().item() == pytest.approx(drive, rel=1e-4)


def test_friction_is_as_large_as_the_law_says() -> None:
    """A person who is driven obliquely slides along the wall, far faster than v_0 = 0.01 m/s, and drags it along."""
    model = models.lin_dem(A=0.0, wall_mu=0.4)._replace(rotation=laws.Rotation(1e30))  # who rolls has no friction
    ahead = Exit((2.0, 19.0), (2.0, 20.0), (1.0, 0.0))
    run = pressed(model, v_d=2.0, walls=((1.0, -2.0, 1.0, 30.0),), line=ahead)
    sliding = {"sample": slice(2, 12)}
    on_wall = forces_on_walls(run).isel(sliding)
    assert (run.vy.isel(sliding) > 0.5).all()
    assert (on_wall.wall_force > 10.0).all()
    assert on_wall.wall_force_y.values == pytest.approx(0.4 * on_wall.wall_force.values, rel=1e-4)


def test_a_run_that_does_not_tell_is_refused() -> None:
    run = pressed(NO_SOCIAL, v_d=1.0, record="positions")
    with pytest.raises(BadInput, match=r'does not tell its contact forces: record it with .*record="full"'):
        forces_on_persons(run)


def test_forces_are_those_recorded_whatever_the_scenario_was() -> None:
    run = pressed(NO_SOCIAL, v_d=1.0)
    xr.testing.assert_equal(forces_on_walls(run.drop_attrs()), forces_on_walls(run))
