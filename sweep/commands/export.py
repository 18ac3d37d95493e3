"""`jamsweep export`: a run or a sweep as a file of another tool, which its suffix names."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from engine import BadInput
from engine.errors import require
from sweep import extras
from sweep.errors import DamagedFile
from sweep.storage.durable import replace_durably, require_target

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

FORCES = {"forces-on-persons": "forces_on_persons", "forces-on-walls": "forces_on_walls"}
ROWS = ("exits", "runs", *FORCES)


@click.command()
@click.argument("source", type=click.Path(path_type=Path))
@click.option("--to", "target", type=click.Path(dir_okay=False, path_type=Path), required=True, help="File to write.")
@click.option("--rows", type=click.Choice(ROWS), default="exits", show_default=True, help="What a table lists.")
@click.option("--unit", type=click.Choice(["m", "cm"]), default="m", show_default=True, help="Of places in a .txt.")
def export(source: Path, target: Path, rows: str, unit: str) -> None:
    """Write SOURCE, a run file or the folder of a sweep, in the form that the suffix of the file names.

    \b
    jamsweep export run.nc --to run.txt       # trajectories: Jülich data archive, read by PedPy
    jamsweep export run.nc --to run.h5        # the same with the walkable area
    jamsweep export run.nc --to run.sqlite    # JuPedSim, version 2
    jamsweep export run.nc --to forces.csv --rows forces-on-walls
    jamsweep export results/mine --to exits.parquet
    jamsweep export results/mine --to runs.csv --rows runs

    Trajectories need a run recorded with --record-every, forces one with --contacts as well.
    """  # noqa: D301  click reads \b as a character
    suffix, known = target.suffix.lower(), [*TRAJECTORIES, *TABLES]
    require(suffix in known, "file", f"'{target}'", "has no suffix of an export", f"choose one of {', '.join(known)}")
    require_target(target)
    ds = _dataset(source, single=suffix in TRAJECTORIES or rows in FORCES)
    if suffix in TRAJECTORIES:
        TRAJECTORIES[suffix](ds, target, unit)
    else:
        TABLES[suffix](_table(ds, rows), target)
    click.echo(str(target))


def _dataset(source: Path, single: bool) -> "xr.Dataset":
    from sweep import open_results, read_run  # what needs xarray stands in the functions: --help answers at once

    if not source.is_dir():
        try:
            return read_run(source)
        except BadInput:
            raise
        except (ValueError, KeyError):
            raise DamagedFile(f"'{source}' is no run file: name one that jamsweep wrote") from None
    remedy = f"name one of the files in {source / 'runs'}"
    require(not single, "folder", f"'{source}'", "holds many runs, of which this export takes one", remedy)
    return open_results(source)


def _table(ds: "xr.Dataset", rows: str) -> "pd.DataFrame":
    """Rows as a table; those of forces by sample and person, or wall."""
    from sweep import exports

    if rows not in FORCES:
        return exports.to_dataframe(ds, rows)
    found: xr.Dataset = getattr(exports, FORCES[rows])(ds)
    table = found.reset_coords("time").to_dataframe().reset_index()
    return table[["time", *(name for name in table if name != "time")]].dropna()


def _text(run: "xr.Dataset", path: Path, unit: str) -> None:
    from sweep.exports import write_text

    write_text(run, path, unit)


def _hdf5(run: "xr.Dataset", path: Path, unit: str) -> None:
    from sweep.exports import write_hdf5

    write_hdf5(run, path)


def _sqlite(run: "xr.Dataset", path: Path, unit: str) -> None:
    from sweep.exports import write_sqlite

    write_sqlite(run, path)


def _csv(table: "pd.DataFrame", path: Path) -> None:
    replace_durably(path, lambda temporary: table.to_csv(temporary, index=False))


def _parquet(table: "pd.DataFrame", path: Path) -> None:
    extras.load("pyarrow", "parquet", "the export to Parquet")
    replace_durably(path, lambda temporary: table.to_parquet(temporary, engine="pyarrow", index=False))


TRAJECTORIES: dict[str, Callable[["xr.Dataset", Path, str], None]] = {
    ".txt": _text,
    ".h5": _hdf5,
    ".hdf5": _hdf5,
    ".sqlite": _sqlite,
}
TABLES: dict[str, Callable[["pd.DataFrame", Path], None]] = {".csv": _csv, ".parquet": _parquet}
