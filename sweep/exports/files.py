"""Files of a run that other tools open: text and HDF5 as in the Jülich data archive, SQLite as JuPedSim writes it."""

import hashlib
import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import xarray as xr

from engine.errors import require
from sweep import extras
from sweep.exports.area import walkable
from sweep.exports.frames import Frames, frames
from sweep.storage.durable import replace_durably

UNITS = {"m": (1.0, 6), "cm": (100.0, 4)}  # how many in a metre, decimals (1 um: PedPy sees a line from 10 um on)
SQLITE_VERSION = 2
SQLITE_TABLES = """
CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL NOT NULL, pos_y REAL NOT NULL,
    ori_x REAL NOT NULL, ori_y REAL NOT NULL);
CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);
CREATE UNIQUE INDEX geometry_hash ON geometry (hash);
CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);
CREATE INDEX frame_id_idx ON trajectory_data (frame, id);
"""


def write_text(run: xr.Dataset, path: Path | str, unit: str = "m") -> None:
    """Write the trajectories of a run as text: `id frame x y z`, as in the Jülich data archive.

    Parameters
    ----------
    run : one run with samples
    path : file, replaced if it is there
    unit : "m" or "cm"

    Raises
    ------
    BadInput
        If the dataset is not one recorded run, or the unit is another.
    """
    require(unit in UNITS, "unit", repr(unit), "is not known", f"choose one of {', '.join(UNITS)}")
    shown, (scale, decimals) = frames(run), UNITS[unit]
    table = shown.table.assign(x=shown.table.x * scale, y=shown.table.y * scale, z=0.0)
    head = f"# framerate: {shown.rate!r} fps\n# id frame x/{unit} y/{unit} z/{unit}\n"

    def write(temporary: Path) -> None:
        form = ("%d", "%d", *(f"%.{decimals}f",) * 2, "%.0f")
        with temporary.open("w", encoding="utf-8") as file:
            file.write(head)
            np.savetxt(file, table.to_numpy(), fmt=form)

    replace_durably(Path(path), write)


def write_hdf5(run: xr.Dataset, path: Path | str) -> None:
    """Write trajectories (dataset `trajectory`, attribute `fps`) and the area (attribute `wkt_geometry`) as HDF5.

    This is the form of the Jülich data archive; PedPy reads both parts.

    Raises
    ------
    BadInput
        If h5py or shapely is not installed, or the dataset is not one recorded run.
    """
    h5py = extras.load("h5py", "pedpy", "the export to HDF5")
    shown = frames(run)
    kinds = [("id", "i8"), ("frame", "i8"), ("x", "f8"), ("y", "f8"), ("z", "f8")]
    rows = np.zeros(len(shown.table), kinds)
    for name in ("id", "frame", "x", "y"):
        rows[name] = shown.table[name].to_numpy()
    area = walkable(run, shown).wkt

    def write(temporary: Path) -> None:
        with h5py.File(temporary, "w") as file:
            file.attrs["wkt_geometry"] = area
            data = file.create_dataset("trajectory", data=rows, compression="gzip", compression_opts=1, shuffle=True)
            data.attrs["fps"] = shown.rate

    replace_durably(Path(path), write)


def write_sqlite(run: xr.Dataset, path: Path | str) -> None:
    """Write trajectories and area as JuPedSim's SQLite, version 2.

    The orientation is the direction of the way to the next frame, and to the last one that there was.

    Raises
    ------
    BadInput
        If shapely is not installed, or the dataset is not one recorded run.
    """
    shown = frames(run)
    area = walkable(run, shown)
    wkt = area.wkt
    name = int.from_bytes(hashlib.sha256(wkt.encode()).digest()[:7], "big")
    x0, y0, x1, y1 = area.bounds
    known = {"version": SQLITE_VERSION, "fps": shown.rate, "xmin": x0, "xmax": x1, "ymin": y0, "ymax": y1}
    places = np.column_stack([shown.table.to_numpy(), _headings(shown)])
    rows = ((int(frame), int(person), *rest) for person, frame, *rest in places.tolist())
    count = int(shown.table.frame.max()) + 1

    def write(temporary: Path) -> None:
        with closing(sqlite3.connect(temporary)) as file, file:
            file.executescript(SQLITE_TABLES)
            file.executemany("INSERT INTO metadata VALUES (?, ?)", [(key, str(value)) for key, value in known.items()])
            file.execute("INSERT INTO geometry VALUES (?, ?)", (name, wkt))
            file.executemany("INSERT INTO frame_data VALUES (?, ?)", ((k, name) for k in range(count)))
            file.executemany("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?)", rows)

    replace_durably(Path(path), write)


def _headings(shown: Frames) -> np.ndarray:
    """Unit vectors along each person's way: (rows, 2); (1, 0) where nobody moves."""
    steps = shown.table.groupby("id")[["x", "y"]].diff(-1).mul(-1.0)
    moving = steps.where(np.hypot(steps.x, steps.y) > 0.0)
    ways = moving.groupby(shown.table["id"]).ffill().to_numpy(copy=True)
    ways[~np.isfinite(ways).all(axis=1)] = (1.0, 0.0)
    unit: np.ndarray = ways / np.hypot(ways[:, 0], ways[:, 1])[:, None]
    return unit
