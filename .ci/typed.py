"""A user's script whose types mypy --strict must see through: run on what is installed by .ci/package."""

import xarray as xr

from engine import Run, Scenario, rooms, simulate
from studies import measures
from sweep import Grid, open_results, read_run, sweep


def my_room(v_d: float = 1.0, seed: int = 0) -> Scenario:
    """The paper's room with a narrow door."""
    return rooms.lin_room(v_d=v_d, seed=seed, L=0.8)


def shares(store: str) -> xr.DataArray:
    """Blocked share of each desired speed."""
    ds: xr.Dataset = sweep(Grid(my_room, v_d=[1.0, 1.4], seed=range(3)), store, jobs=1, timeout=60.0)
    again: xr.Dataset = open_results(store)
    assert ds.sizes == again.sizes
    return measures.blocked_share(ds)["blocked_share"]


run: Run = simulate(my_room())
ended: str = run.outcome
times: xr.DataArray = read_run("run.nc").exit_time
