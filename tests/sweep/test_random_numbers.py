"""Common random numbers, or each cell its own."""

from pathlib import Path

import numpy as np
import pytest

from engine import BadInput, Scenario, rooms
from sweep import Grid, Store, sweep
from sweep.gridfile import read_gridfile
from tests.sweep.tiny import TINY


def seeds(grid: Grid) -> dict[tuple[object, ...], int]:
    """(v_d, mu, seed) -> the seed that the scenario has."""
    full = ({"v_d": 1.0, "mu": 0.3, "seed": 0} | dict(grid.constants) | point for point in grid.points())
    points = [tuple(point[name] for name in ("v_d", "mu", "seed")) for point in full]
    return dict(zip(points, (grid.scenario(point).seed for point in grid.points()), strict=True))


def test_common_random_numbers_are_the_seed_itself_and_the_default() -> None:
    grid = Grid("lin_room", v_d=[1.0, 1.4], seed=range(3), **TINY)
    assert grid.common_random_numbers
    assert all(seed == point[2] for point, seed in seeds(grid).items())


def test_own_random_numbers_differ_between_all_cells_and_seeds() -> None:
    grid = Grid("lin_room", v_d=[1.0, 1.4, 2.0], mu=[0.3, 0.5], seed=range(50), common_random_numbers=False, **TINY)
    given = list(seeds(grid).values())
    assert len(set(given)) == len(grid) == 300
    assert 0 <= min(given) < max(given) < 2**63
    assert abs(np.mean(given) / 2**62 - 1.0) < 0.2, "seeds are not spread over the whole range"


def test_own_random_numbers_do_not_depend_on_what_else_the_grid_holds() -> None:
    small = seeds(Grid("lin_room", v_d=[1.4], seed=[2], common_random_numbers=False, **TINY))
    wider = Grid("lin_room", mu=[0.3, 0.5], seed=range(4), v_d=[1.0, 1.4, 2], common_random_numbers=False, **TINY)
    default = Grid("lin_room", v_d=1.4, seed=2, mu=0.3, tau=0.5, common_random_numbers=False, **TINY)
    assert small.items() <= seeds(wider).items()
    assert seeds(default) == small


def test_runs_of_own_random_numbers_share_no_crowd_and_the_dataset_says_so(store: Path) -> None:
    own = sweep(Grid("lin_room", v_d=[1.0, 1.4], seed=[1], common_random_numbers=False, **TINY), store, jobs=1)
    common = sweep(Grid("lin_room", v_d=[1.0, 1.4], seed=[1], **TINY), store, jobs=1)
    assert len(Store(store).finished()) == 4
    assert own.seed.values.tolist() == common.seed.values.tolist() == [1]
    assert (own.attrs["common_random_numbers"], common.attrs["common_random_numbers"]) == (0, 1)
    assert own.random_numbers.startswith("Independent random numbers")
    assert common.random_numbers.startswith("Common random numbers")


def test_the_choice_survives_json_and_toml(tmp_path: Path) -> None:
    grid = Grid("lin_room", seed=[0, 1], common_random_numbers=False, **TINY)
    again = Grid.from_json(grid.to_json())
    assert seeds(again) == seeds(grid)
    path = tmp_path / "grid.toml"
    path.write_text(
        'room = "lin_room"\nstore = "s"\ncommon_random_numbers = false\n[axes]\nseed = [0, 1]\n'
        "[constants]\nN = 5\nsize = 4\ntime_limit = 2\n"
    )
    assert seeds(read_gridfile(path).grid) == seeds(grid)
    path.write_text('room = "lin_room"\nstore = "s"\ncommon_random_numbers = "no"\n')
    with pytest.raises(BadInput, match="common_random_numbers 'no' is not true or false"):
        read_gridfile(path)


def seedless(N: int = 3) -> Scenario:
    return rooms.lin_room(N=N)


def test_own_random_numbers_need_a_seed_to_draw_them_from() -> None:
    with pytest.raises(BadInput, match="has no keyword seed"):
        Grid(seedless, common_random_numbers=False)
    with pytest.raises(BadInput, match="seed -1 is not"):
        Grid("lin_room", seed=[-1], common_random_numbers=False)
