"""What must not matter: where the room lies, how it is mirrored, who has which number, how a wall is drawn."""

from dataclasses import replace

import numpy as np
import pytest

from engine import Crowd, Exit, Options, Scenario, Scene, models, simulate
from engine.rooms import square_room
from tests.engine.scenes import NO_WALLS, PAPERS

N, SIZE = 30, 6.0


def scenario(scene=None, order=None, turn=None):
    """A crowd in a small room, its plane turned (2 x 2 matrix) and its persons renumbered.

    At dt = 1e-4 s: at 1e-3 s kinetic friction at walls chatters and amplifies rounding.
    """
    turn, order = np.eye(2) if turn is None else turn, np.arange(N) if order is None else order
    start = Crowd.uniform(N, (0, SIZE, 0, SIZE), v_d=2.0).draw(3, NO_WALLS)
    x, y = turn @ np.stack([start.x, start.y])[:, order]
    persons = {name: getattr(start, name)[order] for name in ("radius", "mass")}
    crowd = Crowd.given(x, y, vx=0.0, vy=0.0, spin=0.0, v_d=2.0, **persons)
    scene = turned(scene or square_room(SIZE, 1.0), turn)
    return Scenario(scene, crowd, models.lin_dem(), Options(**PAPERS, dt=1e-4, time_limit=3.0, record_every=0.5))


def turned(scene, turn):
    def point(x, y):
        return tuple(turn @ (x, y))

    walls = tuple((*point(*wall[:2]), *point(*wall[2:])) for wall in scene.walls)
    exits = tuple(Exit(point(*e.start), point(*e.end), point(*e.outward), e.walk_on) for e in scene.exits)
    return Scene(walls, exits)


def rotation(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s], [s, c]])


@pytest.mark.parametrize(
    "turn",
    [rotation(90), rotation(37), rotation(180), np.diag([1.0, -1.0]), np.diag([-1.0, 1.0])],
    ids=["90 degrees", "37 degrees", "180 degrees", "mirror y", "mirror x"],
)
def test_a_turned_or_mirrored_scene_gives_the_turned_run(turn):
    plain, other = simulate(scenario()), simulate(scenario(turn=turn))
    assert plain.N_out == other.N_out > 0
    assert other.exit_person.tolist() == plain.exit_person.tolist()
    assert other.exit_time == pytest.approx(plain.exit_time, abs=1e-7)
    back = np.einsum("ij,jkl->ikl", turn.T, np.stack([other.samples.x, other.samples.y]))
    assert back[0] == pytest.approx(plain.samples.x, abs=1e-7, nan_ok=True)
    assert np.linalg.det(turn) * other.samples.spin == pytest.approx(plain.samples.spin, abs=1e-4, nan_ok=True)


def test_renumbered_persons_do_the_same():
    order = np.random.default_rng(1).permutation(N)
    plain, other = simulate(scenario()), simulate(scenario(order=order))
    assert order[other.exit_person].tolist() == plain.exit_person.tolist()
    assert other.exit_time == pytest.approx(plain.exit_time, abs=1e-7)


def test_splitting_a_wall_changes_nothing():
    """The exit wall's lower half, where the crowd pushes, in five pieces, one turned round, two overlapping."""
    room = square_room(SIZE, 1.0)
    lower = room.walls[3]
    assert lower == (6.0, 0.0, 6.0, 2.5)
    heights = [(0.0, 1.0), (1.9, 1.0), (1.5, 2.0), (2.0, 2.4), (2.4, 2.5)]
    pieces = tuple((6.0, a, 6.0, b) for a, b in heights)
    plain, split = (
        simulate(scenario()),
        simulate(scenario(Scene((*room.walls[:3], *pieces, room.walls[4]), room.exits))),
    )
    assert split.max_overlap == pytest.approx(plain.max_overlap, rel=1e-9)
    assert split.exit_time == pytest.approx(plain.exit_time, abs=1e-9)


def test_a_corner_of_two_walls_pushes_once():
    """A person in front of the edge of a pillar feels the edge once, although two walls end there."""
    edge = Scene(((2.0, 1.0, 1.0, 1.0), (1.0, 1.0, 1.0, 2.0)))
    tip = Scene(((1.0, 1.0, 2.0, 2.0),))
    model = models.lin_dem(tau=1e30)
    crowd = Crowd.given([0.8], [0.8], 0.0, 0.0, 0.0, 0.3, 70.0, 1.0)
    options = Options(**PAPERS, dt=1e-4, time_limit=0.2, record_every=0.05)
    at_edge, at_tip = (simulate(Scenario(scene, crowd, model, options)) for scene in (edge, tip))
    assert at_edge.samples.x == pytest.approx(at_tip.samples.x, abs=1e-12)
    assert at_edge.samples.x[-1] < 0.75


def test_a_wall_that_ends_on_another_does_not_push_those_behind_it():
    """The foot of a partition, felt from the other side of the wall that it stands on."""
    model = models.lin_dem(tau=1e30)
    crowd = Crowd.given([2.0], [-0.35], 0.0, 0.0, 0.0, 0.3, 70.0, 1.0)
    wall, partition = (0.0, 0.0, 4.0, 0.0), (2.0, 0.0, 2.0, 3.0)
    options = Options(**PAPERS, dt=1e-4, time_limit=0.2, record_every=0.05)
    plain, foot = (simulate(Scenario(Scene(w), crowd, model, options)) for w in ((wall,), (wall, partition)))
    assert plain.samples.y[-1] < -0.36
    assert foot.samples.y == pytest.approx(plain.samples.y, abs=1e-12)


def test_isotropic_forces_between_persons_sum_to_zero():
    model = models.lin_dem(tau=1e30, phi=0.0)
    run = simulate(replace(scenario(), scene=Scene(), model=model))
    assert run.max_speed > 0.01
    momentum = run.start.mass @ run.samples.vx.T, run.start.mass @ run.samples.vy.T
    assert np.abs(momentum).max() < 1e-10


def test_anisotropic_forces_do_not_sum_to_zero():
    """Lin's social force is not reciprocal: who sees the other is pushed more."""
    model = models.lin_dem(tau=1e30)
    run = simulate(replace(scenario(), model=model).with_options(time_limit=0.5))
    assert abs(run.start.mass @ run.samples.vx[-1]) > 1.0


def test_the_same_scenario_gives_the_same_bits():
    first, second = simulate(scenario()), simulate(scenario())
    assert first.exit_time.tobytes() == second.exit_time.tobytes()
    assert first.samples.x.tobytes() == second.samples.x.tobytes()
