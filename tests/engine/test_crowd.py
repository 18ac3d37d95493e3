"""Placement and the random streams."""

import numpy as np
import pytest

from engine import BadInput, Crowd, Scene, rooms, simulate
from engine.kernel.scene_arrays import as_arrays
from tests.engine.scenes import NO_WALLS


@pytest.mark.parametrize("N", [1, 100, 300, 350])
def test_nobody_overlaps_anybody_or_a_wall_at_the_start(N):
    start = Crowd.uniform(N, (0, 15, 0, 15)).draw(0, NO_WALLS)
    apart = np.hypot(start.x[:, None] - start.x, start.y[:, None] - start.y) + 9 * np.eye(N)
    assert (apart >= start.radius[:, None] + start.radius).all()
    for position in (start.x, start.y):
        assert ((position >= start.radius) & (position <= 15 - start.radius)).all()


def test_walls_inside_the_area_are_kept_clear():
    walls = as_arrays(Scene(((0.0, 5.0, 10.0, 5.0),))).walls
    start = Crowd.uniform(80, (0, 10, 0, 10)).draw(0, walls)
    assert (np.abs(start.y - 5.0) >= start.radius * (1 - 1e-12)).all()


def test_persons_of_a_factor_of_ten_in_size_are_placed():
    start = Crowd.uniform(200, (0, 15, 0, 15), radius=(0.06, 0.6)).draw(0, NO_WALLS)
    apart = np.hypot(start.x[:, None] - start.x, start.y[:, None] - start.y) + 9 * np.eye(200)
    assert (apart >= start.radius[:, None] + start.radius).all()


def test_a_crowd_that_does_not_fit_is_refused_by_number():
    with pytest.raises(
        BadInput, match=r"^N 600 persons do not fit at random into 15 x 15 m without overlap .*: reduce"
    ):
        simulate(rooms.lin_room(N=600))
    with pytest.raises(BadInput, match=r"^N 2000 persons do not fit"):
        rooms.lin_room(N=2000)


def test_bodies_positions_and_motion_are_independent_streams():
    """An initial speed changes no position, wider bodies have the same masses, another seed other bodies."""
    few = Crowd.uniform(50, (0, 15, 0, 15)).draw(1, NO_WALLS)
    wide = Crowd.uniform(50, (0, 15, 0, 15), radius=(0.3, 0.4)).draw(1, NO_WALLS)
    assert (wide.mass == few.mass).all()
    moving = Crowd.uniform(50, (0, 15, 0, 15), speed=(0.9, 1.1)).draw(1, NO_WALLS)
    assert (moving.x == few.x).all()
    assert np.hypot(moving.vx, moving.vy) == pytest.approx(1.0, abs=0.1)
    other = Crowd.uniform(50, (0, 15, 0, 15)).draw(2, NO_WALLS)
    assert abs(np.corrcoef(few.radius, other.radius)[0, 1]) < 0.5
    assert abs(np.corrcoef(few.radius, few.x)[0, 1]) < 0.5


def test_the_seed_of_a_run_does_not_depend_on_the_desired_speed():
    slow, fast = (rooms.lin_room(v_d=v, seed=3).crowd.draw(3, NO_WALLS) for v in (0.6, 2.0))
    assert (slow.x == fast.x).all()
    assert (slow.radius == fast.radius).all()
