"""What of a recorded run is shown: its samples, speeds, forces, and the frame around them."""

import numpy as np
import xarray as xr

from engine.errors import require
from sweep.pages.touching import Contacts

NEEDED = ("exit_time", "exit_person", "radius", "wall", "door", "outcome")  # of a run file
MARGIN = 1.5  # m, beyond walls and persons
COMMON = 0.99  # share of values that the scale of colours spans


def check_playable(run: xr.Dataset, name: str = "dataset") -> None:
    """Raise `BadInput` unless this is one run, and it has samples."""
    whole = all(part in run.variables for part in NEEDED) and run.outcome.ndim == 0
    require(whole, "run file", f"'{name}'", "holds no run", "name a file that `jamsweep run ... -o` wrote")
    remedy = "run it again with `--record-every 0.1`, and `--contacts` to see who touches whom"
    require("time" in run and run.sizes["sample"] > 0, "run", f"'{name}'", "has no samples to play", remedy)


def thinned(run: xr.Dataset, every: int) -> xr.Dataset:
    """The run with each sample of so many, and their contacts."""
    if every == 1:
        return run
    kept = np.arange(0, run.sizes["sample"], every)
    selected = {"sample": kept}
    if "row_size" in run:
        of_sample = np.repeat(np.arange(run.sizes["sample"]), run.row_size.values)
        selected["contact"] = np.flatnonzero(of_sample % every == 0)
    return run.isel(selected)


def speeds(run: xr.Dataset) -> np.ndarray:
    """Speed of each person at each sample, m/s: recorded, or the way to the next sample over its time."""
    if "vx" in run:
        return np.hypot(run.vx.values, run.vy.values)
    x, y, time = run.x.values, run.y.values, run.time.values
    if time.size < 2:
        return np.where(np.isfinite(x), 0.0, np.nan)
    ahead = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)) / np.diff(time)[:, None]
    last = np.vstack([np.full(x.shape[1], np.nan), ahead])
    found = np.where(np.isfinite(np.vstack([ahead, ahead[-1:]])), np.vstack([ahead, ahead[-1:]]), last)
    return np.where(np.isfinite(x), np.where(np.isfinite(found), found, 0.0), np.nan)


def force_on_each(contacts: Contacts, persons: int) -> np.ndarray:
    """Sum of the normal contact forces on each person at each sample, N: (samples, persons)."""
    samples = contacts.row_size.size
    force = np.zeros((samples, persons))
    if contacts.force is not None:
        sample = np.repeat(np.arange(samples), contacts.row_size)
        np.add.at(force, (sample, contacts.i), contacts.force)
        pair = contacts.j >= 0
        np.add.at(force, (sample[pair], contacts.j[pair]), contacts.force[pair])
    return force


def common_top(values: np.ndarray, least: float) -> float:
    """A round number that nearly all positive values lie below, for the top of a scale."""
    positive = values[np.isfinite(values) & (values > 0)]
    top = max(float(np.quantile(positive, COMMON)) if positive.size else 0.0, least)
    step = 10.0 ** np.floor(np.log10(top)) / 2
    return float(np.ceil(top / step - 1e-9) * step)


def box_of(run: xr.Dataset) -> tuple[float, float, float, float]:
    """What a picture shows, m: walls, doors and all places, with a margin: x0, y0, x1, y1."""
    lines = np.concatenate([run.wall.values, run.door.values]).reshape(-1, 2)
    x = np.concatenate([lines[:, 0], run.x.values[np.isfinite(run.x.values)]])
    y = np.concatenate([lines[:, 1], run.y.values[np.isfinite(run.y.values)]])
    return (
        float(x.min()) - MARGIN,
        float(y.min()) - MARGIN,
        float(x.max()) + MARGIN,
        float(y.max()) + MARGIN,
    )
