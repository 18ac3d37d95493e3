"""Trajectories from files: the text of the Jülich data archive, and by PedPy's loaders whatever else it reads."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from engine import BadInput
from engine.errors import number, require
from sweep import extras

COLUMNS = ["id", "frame", "x", "y"]
LOADERS = {  # format: the loader in PedPy
    "hdf5": "load_trajectory_from_ped_data_archive_hdf5",
    "jupedsim": "load_trajectory_from_jupedsim_sqlite",
    "vadere": "load_trajectory_from_vadere",
    "viswalk": "load_trajectory_from_viswalk",
    "crowdit": "load_trajectory_from_crowdit",
    "pathfinder-csv": "load_trajectory_from_pathfinder_csv",
    "pathfinder-json": "load_trajectory_from_pathfinder_json",
}
SUFFIXES = {".txt": "text", ".h5": "hdf5", ".hdf5": "hdf5", ".sqlite": "jupedsim", ".traj": "vadere", ".pp": "viswalk"}
FORMATS = ("text", *LOADERS)
FRAME_RATE = re.compile(r"framerate:?\s*([^\s]+)", re.IGNORECASE)
UNIT = re.compile(r"\b(?:x/|in )(cm|m)\b", re.IGNORECASE)
IN_METRES = {"m": 1.0, "cm": 0.01}


def read_trajectories(
    path: Path | str, form: str | None = None, frame_rate: float | None = None, unit: str | None = None
) -> xr.Dataset:
    """Who was where at every frame.

    Parameters
    ----------
    path : file
    form : "text" (the Jülich data archive's: `id frame x y z`, head lines with the frame rate and the unit), or one
        that PedPy reads, for which it must be installed: "hdf5", "jupedsim", "vadere", "viswalk", "crowdit",
        "pathfinder-csv", "pathfinder-json". None: by the suffix, .txt, .h5, .hdf5, .sqlite, .traj or .pp
    frame_rate : frames a second, where the file does not say (text, vadere)
    unit : "m" or "cm", where a text does not say

    Returns
    -------
    Dataset with `x`, `y` (sample, person) m, nan where somebody was not seen; `time` (sample) s from frame 0;
    `person_id` (person), as the file numbers them. Attribute `frame_rate`, 1/s.

    Raises
    ------
    BadInput
        If there is no such file, it is not of this format, a person is at two places in one frame, or frame rate or
        unit are not known.
    """
    path = Path(path)
    require(path.is_file(), "trajectories", f"'{path}'", "do not exist", "name a file")
    form = form or SUFFIXES.get(path.suffix.lower(), "")
    remedy = f"choose one of {', '.join(FORMATS)}"
    require(form in FORMATS, "format", repr(form) if form else f"of '{path.name}'", "is not known", remedy)
    table, rate = _text(path, frame_rate, unit) if form == "text" else _by_pedpy(path, form, frame_rate)
    return _dataset(table, rate, path)


def _text(path: Path, frame_rate: float | None, unit: str | None) -> tuple[pd.DataFrame, float]:
    """Rows and frame rate of a text; what the file says is to agree with what is given."""
    said_rate, said_unit = _head(path)
    rate = _agreed(path, "frame rate", said_rate, frame_rate, "frame_rate=25")
    size = _agreed(path, "unit", said_unit, unit, 'unit="m"')
    require(size in IN_METRES, "unit", repr(size), "is not known", f"choose one of {', '.join(IN_METRES)}")
    try:
        table = pd.read_csv(path, sep=r"\s+", comment="#", header=None, usecols=range(4), names=COLUMNS, dtype=float)
    except (ValueError, pd.errors.ParserError, UnicodeDecodeError):
        where = f"has other lines than `id frame x y z` in numbers{_first_bad_line(path)}"
        raise BadInput(f"trajectories '{path}' {where}: mend the file") from None
    table[["x", "y"]] *= IN_METRES[size]
    return table, rate


def _head(path: Path) -> tuple[float | None, str | None]:
    """Frame rate and unit of the head lines, None where they are not said."""
    rate = unit = None
    with path.open(encoding="utf-8-sig", errors="replace") as lines:
        for line in lines:
            if not line.startswith("#"):
                break
            if rate is None and (found := FRAME_RATE.search(line)):
                rate = number(f"frame rate of '{path}',", _float(found[1]), "mend its head")
            unit = found[1].lower() if (found := UNIT.search(line)) else unit
    return rate, unit


def _float(word: str) -> Any:
    try:
        return float(word)
    except ValueError:
        return word


def _agreed(path: Path, what: str, said: Any, given: Any, example: str) -> Any:
    """What a file says, or is told of it."""
    agree = said is None or given is None or said == given
    require(agree, f"{what} {given}", f"given for '{path}'", f"is not the {said} that the file says", "leave it out")
    known = said is not None or given is not None
    require(known, "trajectories", f"'{path}'", f"do not say their {what}", f"give it, such as {example}")
    return given if said is None else said


def _first_bad_line(path: Path) -> str:
    with path.open(encoding="utf-8-sig", errors="replace") as lines:
        for count, line in enumerate(lines, 1):
            words = line.partition("#")[0].split()
            if words and (len(words) < len(COLUMNS) or any(isinstance(_float(word), str) for word in words[:4])):
                return f", first in line {count}"
    return ""


def _by_pedpy(path: Path, form: str, frame_rate: float | None) -> tuple[pd.DataFrame, float]:
    """Rows and frame rate by a loader of PedPy."""
    pedpy = extras.load("pedpy", "pedpy", f"reading trajectories of the format {form}")
    needs_rate = form == "vadere"
    remedy = "give it, such as frame_rate=10"
    require(
        not needs_rate or frame_rate is not None, "trajectories", f"'{path}'", "do not say their frame rate", remedy
    )
    rate = {"frame_rate": frame_rate} if needs_rate else {}
    try:
        found = getattr(pedpy, LOADERS[form])(trajectory_file=path, **rate)
    except Exception as error:  # of many kinds, also of the libraries below
        words = " ".join(str(error).split())
        raise BadInput(f"trajectories '{path}' cannot be read as {form} ({words}): name the right format") from None
    return pd.DataFrame(found.data[COLUMNS]), float(found.frame_rate)


def _dataset(table: pd.DataFrame, rate: float, path: Path) -> xr.Dataset:
    """Rows as arrays over frames and persons."""
    what = f"'{path}'"
    rate = number("frame rate", rate, "give frames a second")
    require(rate > 0, "frame rate", rate, "is not above 0", "give frames a second")
    require(len(table) > 0, "trajectories", what, "are empty", "name a file with rows")
    whole = np.isfinite(table).all(axis=None) and (table.frame % 1 == 0).all() and (table.frame >= 0).all()
    require(bool(whole), "trajectories", what, "have rows that are no finite numbers from frame 0", "mend the file")
    twice = table[table.duplicated(["id", "frame"])]
    at = f"{what}, person {twice.id.iloc[0]:g} in frame {twice.frame.iloc[0]:g}," if len(twice) else what
    require(twice.empty, "trajectories", at, "have two places for one person and frame", "mend the file")
    who, person = np.unique(table.id.to_numpy(), return_inverse=True)
    frame = table.frame.to_numpy().astype(np.int64)
    places = np.full((2, frame.max() + 1, who.size), np.nan)
    places[:, frame, person] = table[["x", "y"]].to_numpy().T
    dims = ("sample", "person")
    return xr.Dataset(
        {
            "x": (dims, places[0], {"units": "m", "long_name": "x, nan where not seen"}),
            "y": (dims, places[1], {"units": "m", "long_name": "y, nan where not seen"}),
            "person_id": ("person", who.astype(np.int64), {"units": "1", "long_name": "number in the file"}),
        },
        coords={"time": ("sample", np.arange(frame.max() + 1) / rate, {"units": "s", "long_name": "time"})},
        attrs={"source": path.name, "frame_rate": rate},
    )
