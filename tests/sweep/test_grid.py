"""What a grid promises, and what it refuses."""

import numpy as np
import pytest

from engine import BadInput, Scenario, rooms
from sweep import Grid
from sweep.schema import run_key
from tests.sweep.tiny import TINY


def needy_room(N: int, v_d: float = 1.0) -> Scenario:
    return rooms.lin_room(N=N, v_d=v_d)


def test_lists_ranges_and_arrays_are_axes_in_the_order_given() -> None:
    grid = Grid(rooms.lin_room, seed=range(2), v_d=np.array([1.0, 1.4]), N=(5, 6), A=300)
    assert dict(grid.axes) == {"seed": (0, 1), "v_d": (1.0, 1.4), "N": (5, 6)}
    assert dict(grid.constants) == {"A": 300.0}
    assert grid.shape == (2, 2, 2)
    assert list(grid.points())[1] == {"seed": 0, "v_d": 1.0, "N": 6}


def test_a_point_makes_the_scenario_the_room_would_make() -> None:
    grid = Grid("lin_room", v_d=[1.0], N=5, seed=[3])
    assert [grid.scenario(point) for point in grid.points()] == [rooms.lin_room(v_d=1.0, N=5, seed=3)]


def test_whole_numbers_and_floats_ask_for_the_same_run() -> None:
    keys = [run_key(Grid("lin_room", blocked_after=value).scenario({})) for value in (120, 120.0, np.float64(120))]
    assert len(set(keys)) == 1


def test_every_parameter_changes_the_key() -> None:
    grid = Grid("lin_room", seed=[0, 1], v_d=[1.0, 1.0000000000000002], mu=[0.5, 0.6], friction=["reset", "kept"])
    assert len({run_key(grid.scenario(point)) for point in grid.points()}) == len(grid) == 16


def test_a_grid_survives_its_text_form(grid: Grid) -> None:
    again = Grid.from_json(grid.to_json())
    assert (again.name, again.axes, again.constants) == (grid.name, grid.axes, grid.constants)


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"width": [1.0]}, "'width' is not a keyword of lin_room"),
        ({"v_d": []}, "axis v_d without values makes a grid of zero runs"),
        ({"v_d": [1.0, 1]}, "repeats a value"),
        ({"seed": {1, 2}}, "has no order"),
        ({"N": [5, 6.0]}, "N 6.0 is not a whole number"),
        ({"v_d": "fast"}, "v_d 'fast' is not a number"),
        ({"contacts": 1}, "contacts 1 is not true or false"),
        ({"v_d": [[1.0, 2.0]]}, "is not a number"),
        ({"v_d": [1.0, float("nan")]}, "v_d nan m/s is not finite.*v_d = nan"),
        ({"N": [5, -1]}, "N -1 is not.*N = -1"),
        ({"N": [5, 5000]}, "do not fit.*N = 5000"),
        ({"dt": [0.1]}, "dt 0.1 s is beyond.*dt = 0.1"),
        ({"friction": ["reset", "Q"]}, "friction 'Q' is not known.*friction = Q"),
        ({"L": [1.0, 0.5]}, "exit width 0.5 m is narrower.*L = 0.5"),
        ({"mu": [-1.0]}, "mu -1.0 is not a finite number of 0 or more.*mu = -1.0"),
        ({"tau": [0.0]}, "tau 0.0 is not a finite number above 0.*tau = 0.0"),
    ],
)
def test_bad_input_is_one_line_that_names_it(keywords: dict, words: str) -> None:
    with pytest.raises(BadInput, match=words) as caught:
        Grid("lin_room", **TINY | keywords)
    assert "\n" not in str(caught.value)


def test_an_unknown_room_is_answered_with_the_known_ones() -> None:
    with pytest.raises(BadInput, match="room 'nope' is not known: choose one of lin_room"):
        Grid("nope")


def test_a_room_of_ones_own_works_and_its_needs_are_named() -> None:
    assert Grid(needy_room, N=[5]).shape == (1,)
    with pytest.raises(BadInput, match=r"keyword 'N' of .*needy_room has no default"):
        Grid(needy_room)


@pytest.mark.parametrize("numbers", [{(9.0,): 1}, {(): 1}, {(1.0,): -1}, {(1.0,): 3}, {(1.0,): "a"}])
def test_seeds_of_cells_that_the_grid_has_not_are_refused(numbers: dict) -> None:
    with pytest.raises(BadInput, match=r"is none of the grid|is not a whole number from 0 to 2"):
        Grid("lin_room", v_d=[1.0], seed=range(2)).first_seeds(numbers)


def test_cells_of_words_and_truth_values_keep_their_seeds_through_json() -> None:
    grid = Grid(
        "lin_room", v_d=[1, 2.5], inertia=["disc", "none"], contacts=[True, False], seed=range(3), record_every=1.0
    )
    part = grid.first_seeds({(1, "none", False): 2, (2.5, "disc", True): 1})
    again = Grid.from_json(part.to_json())
    assert len(again) == 3 == len(list(again.points()))
    assert list(again.points()) == list(part.points())
    assert again.to_json() == Grid.from_json(again.to_json()).to_json()
