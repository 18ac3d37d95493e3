"""Who touches whom in a recorded run, and how hard."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from engine.scene import from_closest_points


class Contacts(NamedTuple):
    """Contacts of all samples, one sample after the other, sorted by persons in each."""

    row_size: np.ndarray  # (samples,) number of contacts of each
    i: np.ndarray  # (contacts,) person
    j: np.ndarray  # (contacts,) other person, or -1 - w for wall w
    force: np.ndarray | None  # (contacts,) N, normal force; None where it was not recorded
    recorded: bool  # by the run; else found from its positions


def contacts_of(run: xr.Dataset) -> Contacts:
    """Contacts of the samples of a run.

    Where the run recorded none, persons and walls closer than their radii in the recorded positions are in contact.

    Parameters
    ----------
    run : Dataset
        One run with samples, as `sweep.read_run` gives it.
    """
    recorded = "contact_i" in run
    rows, i, j = _recorded(run) if recorded else _found(run)
    sample = np.repeat(np.arange(rows.size), rows)
    order = np.lexsort((j, i, sample))
    force = run.contact_F_n.values[order] if "contact_F_n" in run else None
    return Contacts(rows, i[order], j[order], force, recorded)


def _recorded(run: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rows, i, j = (run[name].values.astype(np.int64) for name in ("row_size", "contact_i", "contact_j"))
    return rows, i, j


def _found(run: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    radius, walls = run.radius.values, run.wall.values
    found = [_at(*place, radius, walls) for place in zip(run.x.values, run.y.values, strict=True)]
    rows = np.array([i.size for i, _ in found], dtype=np.int64)
    none = np.empty(0, dtype=np.int64)
    return rows, np.concatenate([none, *(i for i, _ in found)]), np.concatenate([none, *(j for _, j in found)])


def _at(x: np.ndarray, y: np.ndarray, radius: np.ndarray, walls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Persons in touch at one sample."""
    here = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    if not here.size:
        return here, here
    positions = np.column_stack([x[here], y[here]])
    a, b = here[cKDTree(positions).query_pairs(2 * radius.max(), output_type="ndarray")].T
    close = np.hypot(x[a] - x[b], y[a] - y[b]) < radius[a] + radius[b]
    near = np.hypot(*from_closest_points(walls[None], x[here, None], y[here, None])) < radius[here, None]
    person, wall = np.nonzero(near)
    return np.concatenate([a[close], here[person]]), np.concatenate([b[close], -1 - wall])
