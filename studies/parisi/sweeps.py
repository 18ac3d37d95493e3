"""The runs of all figures: over v_d, over the width of the door, and over v_d with A = 1000 N as printed."""

from functools import cached_property
from pathlib import Path

import pandas as pd
import xarray as xr
from joblib import Parallel, delayed, parallel_config

from engine import Scenario, fingerprint, rooms
from engine.errors import require
from studies import measures, swept
from studies.published import parisi2005 as paper
from studies.swept import Swept
from sweep import Grid, Store, SweepStopped, read_run
from sweep.schema import PARAMETERS, run_key
from sweep.storage.durable import replace_durably

FOLDER = Path("results/parisi")
EVERY = 0.02  # s, sampling interval of the contacts
QUICK_SEEDS = 3
QUICK_V_D, QUICK_L = [0.8, 1.5, 2.0, 3.0, 4.0, 6.0], [1.2, 2.4, 4.2]


def wide_room(L: float, seed: int = 0) -> Scenario:
    """Parisi's room at 4 m/s with as many persons as the paper has for a door of width L (Sec. 3)."""
    known = ", ".join(f"{width:g}" for width in paper.DOORS_N)
    require(L in paper.DOORS_N, "L", f"{L} m", "is no door of the paper", f"choose one of {known} m")
    return rooms.parisi_room(
        paper.DOORS_V_D, paper.DOORS_N[L], seed, L, record_every=EVERY, contacts=True, record="positions"
    )


def grids(quick: bool) -> dict[str, Grid]:
    """The three sweeps, thinned or as the paper has them."""
    seeds = range(QUICK_SEEDS if quick else paper.RUNS)
    v_d = QUICK_V_D if quick else list(paper.V_D)
    listed = [v for v in v_d if v in paper.EVACUATION_TIME]
    recorded = {"record_every": EVERY, "contacts": True, "record": "positions"}
    return {
        "speeds": Grid(rooms.parisi_room, v_d=v_d, seed=seeds, **recorded),
        "doors": Grid(wide_room, L=QUICK_L if quick else list(paper.DOORS_N), seed=seeds),
        "printed": Grid(rooms.parisi_room, v_d=listed, seed=seeds, A=1000.0),
    }


class Sweeps(swept.Sweeps):
    """Facts of the sweeps, run and counted when they are first asked for, and kept on disk."""

    def __init__(self, quick: bool = False, jobs: int = 2, folder: Path = FOLDER) -> None:
        super().__init__(grids(quick), folder, jobs)
        self.quick, self.folder = quick, folder

    @cached_property
    def speeds(self) -> xr.Dataset:
        """Exits over v_d and seed."""
        return self.swept("speeds")

    @cached_property
    def doors(self) -> xr.Dataset:
        """Exits over L and seed."""
        return self.swept("doors")

    @cached_property
    def printed(self) -> xr.Dataset:
        """Exits over v_d and seed, with A = 1000 N."""
        return self.swept("printed")

    @cached_property
    def speed_counts(self) -> xr.Dataset:
        """What the contacts come to, over v_d and seed: `measures.contact_counts`."""
        return counted(self.speeds, self.grids["speeds"], self.jobs, self._counts("speeds"))

    @cached_property
    def door_counts(self) -> xr.Dataset:
        """The same over L and seed."""
        return counted(self.doors, self.grids["doors"], self.jobs, self._counts("doors"))

    def run(self, v_d: float, seed: int) -> xr.Dataset:
        """One recorded run of the sweep over v_d."""
        return self.recorded("speeds", {"v_d": v_d, "seed": seed})

    def _counts(self, name: str) -> Path:
        return self.grids[name].folder / f"counts{'-quick' * self.quick}.nc"


def counted(ds: xr.Dataset, runs: Swept, jobs: int, path: Path) -> xr.Dataset:
    """`contact_counts` of every run, kept in a file until the runs or the measures change.

    Raises
    ------
    SweepStopped
        If a run is missing.
    """
    missing = int(measures.outcome_is(ds, "missing").sum())
    if missing:
        raise SweepStopped(f"{missing} runs of {runs.folder} are missing: see {runs.folder}/failed, then run again")
    made_of = f"{ds.attrs['content']} {fingerprint.fingerprint(Path(measures.__file__).parent)}"
    if path.is_file():
        with xr.open_dataset(path) as kept:
            if kept.attrs.get("content") == made_of:
                return kept.load()
    counts = _all(runs, jobs).assign_attrs(content=made_of)
    replace_durably(path, counts.to_netcdf)
    return counts


def _all(runs: Swept, jobs: int) -> xr.Dataset:
    grid, folder = runs
    files = [Store(folder).file(run_key(grid.scenario(point))) for point in grid.points()]
    with parallel_config("loky", inner_max_num_threads=1):
        rows = Parallel(n_jobs=jobs)(delayed(counts_of)(file) for file in files)
    return side_by_side(rows, grid)


def counts_of(file: Path) -> xr.Dataset:
    """`contact_counts` of a run file."""
    return measures.contact_counts(read_run(file))


def side_by_side(rows: list[xr.Dataset], grid: Grid) -> xr.Dataset:
    """Results of single runs over the axes of their grid, which they are in the order of."""
    index = pd.MultiIndex.from_product(list(grid.axes.values()), names=list(grid.axes))
    flat = xr.concat(rows, "run", join="outer", combine_attrs="override", coords="minimal", compat="override")
    ds = flat.assign_coords(xr.Coordinates.from_pandas_multiindex(index, "run")).unstack("run")  # noqa: PD010  an xarray dataset
    for name in grid.axes:
        units, long_name = PARAMETERS[name]
        ds[name].attrs = {"units": units, "long_name": long_name}
    return ds
