"""Datasets as pandas tables: one row an exit, or one row a run."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import xarray as xr

from engine.errors import require

ALL_OUT, SHUT, ENDED = ("all_out",), ("blocked", "frozen"), ("blocked", "frozen", "time_limit")
OF_EXITS = ("exit_time", "exit_person", "exit_x", "exit_y", "exit_door")
OF_PERSONS = ("radius", "mass", "v_d_person")
NEEDED = ("exit_time", "exit_person", "outcome", "end_time", "N_out")


def to_dataframe(ds: xr.Dataset, rows: str = "exits") -> pd.DataFrame:
    """A gathered dataset, or a single run, as a table.

    Parameters
    ----------
    ds : what `sweep.open_results`, `sweep.read_run` or `sweep.to_dataset` gives
    rows : "exits", one row for each person who left: the run's parameters, `rank` from 1, `exit_time` s, `exit_person`,
        `exit_x`, `exit_y` m, `exit_door`, and of a single run also the person's `radius`, `mass` and `v_d_person`.
        "runs", one row a run: its parameters, `outcome` as a word, `end_time` s, `N_out` and whatever else a dataset
        has one value a run of; `clearance_time` s: of the last exit if all got out, inf where the exit was blocked,
        nan where the run was ended by its time limit, was unstable or is missing; `censored`: it did not finish.

    Returns
    -------
    DataFrame, units by column in `attrs["units"]`

    Raises
    ------
    BadInput
        If rows are neither, or the dataset has no exits and outcomes.
    """
    require(rows in TABLES, "rows", repr(rows), "is not known", f"choose one of {', '.join(TABLES)}")
    absent = [name for name in NEEDED if name not in ds.variables]
    remedy = "pass what sweep.open_results or sweep.read_run gives"
    require(not absent, "dataset", f"without {', '.join(absent)}", "is none of runs", remedy)
    table = TABLES[rows](ds)
    units = {name: str(ds[name].attrs["units"]) for name in table if "units" in ds.get(name, xr.DataArray()).attrs}
    units |= {"clearance_time": "s"} if "clearance_time" in table else {}
    table.attrs["units"] = {name: unit for name, unit in units.items() if unit != "1"}
    return table


def _exits(ds: xr.Dataset) -> pd.DataFrame:
    made = ds[[name for name in OF_EXITS if name in ds]]
    table = made.to_dataframe().reset_index().rename(columns={"exit": "rank"})
    table = table[table.exit_time.notna()].reset_index(drop=True)
    for name in (n for n in OF_PERSONS if n in ds):
        table[name] = ds[name].values[table.exit_person.to_numpy()]
    return table


def _runs(ds: xr.Dataset) -> pd.DataFrame:
    axes = ds.outcome.dims
    words = np.array(ds.outcome.attrs["flag_meanings"].split())
    single = ds[[name for name in ds.data_vars if ds[name].dims == ds.outcome.dims]].drop_vars("exit", errors="ignore")
    table = single.to_dataframe().reset_index() if axes else single.expand_dims("run").to_dataframe()
    table = table.reset_index(drop=True)
    table["outcome"] = words[table.outcome.to_numpy(dtype=np.int64)]
    shut = table.outcome.isin(SHUT)
    table["clearance_time"] = table.end_time.where(table.outcome.isin(ALL_OUT)).mask(shut, np.inf)
    table["censored"] = table.outcome.isin(ENDED)
    return table


TABLES: dict[str, Callable[[xr.Dataset], pd.DataFrame]] = {"exits": _exits, "runs": _runs}
