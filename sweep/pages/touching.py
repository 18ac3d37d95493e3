"""Who touches whom in a recorded run, and how hard."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from engine import BadInput, Model, Scenario
from engine.laws import normal


class Contacts(NamedTuple):
    """Contacts of all samples, one sample after the other, sorted by persons in each."""

    row_size: np.ndarray  # (samples,) number of contacts of each
    i: np.ndarray  # (contacts,) person
    j: np.ndarray  # (contacts,) other person, or -1 - w for wall w
    force: np.ndarray | None  # (contacts,) N; None where the run's law is not known
    recorded: bool  # by the run; else found from its places


def contacts_of(run: xr.Dataset) -> Contacts:
    """Contacts of the samples of a run.

    Where the run recorded none, persons and walls closer than their radii in the recorded places are in touch. Forces
    are the elastic part of the run's normal law (`engine.laws.pressing`) at the overlap of the recorded places.

    Parameters
    ----------
    run : one run with samples, as `sweep.read_run` gives it
    """
    recorded = "contact_i" in run
    rows, i, j = _recorded(run) if recorded else _found(run)
    sample = np.repeat(np.arange(rows.size), rows)
    order = np.lexsort((j, i, sample))
    i, j, sample = i[order], j[order], sample[order]
    return Contacts(rows, i, j, _forces(run, sample, i, j), recorded)


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
    places = np.column_stack([x[here], y[here]])
    a, b = here[cKDTree(places).query_pairs(2 * radius.max(), output_type="ndarray")].T
    close = np.hypot(x[a] - x[b], y[a] - y[b]) < radius[a] + radius[b]
    near = distances(x[here, None], y[here, None], walls[None]) < radius[here, None]
    person, wall = np.nonzero(near)
    return np.concatenate([a[close], here[person]]), np.concatenate([b[close], -1 - wall])


def distances(x: np.ndarray, y: np.ndarray, walls: np.ndarray) -> np.ndarray:
    """Distance of places to wall segments (x0, y0, x1, y1 along the last axis), m, broadcast."""
    x0, y0, x1, y1 = np.moveaxis(walls, -1, 0)
    ux, uy = x1 - x0, y1 - y0
    share = ((x - x0) * ux + (y - y0) * uy) / np.maximum(ux**2 + uy**2, 1e-300)
    share = np.clip(share, 0.0, 1.0)
    return np.hypot(x - x0 - share * ux, y - y0 - share * uy)


def _forces(run: xr.Dataset, sample: np.ndarray, i: np.ndarray, j: np.ndarray) -> np.ndarray | None:
    model = _model(run)
    if model is None:
        return None
    x, y, radius, mass = run.x.values, run.y.values, run.radius.values, run.mass.values
    force = np.zeros(i.size)
    pair, wall = np.flatnonzero(j >= 0), np.flatnonzero(j < 0)
    s, a, b = sample[pair], i[pair], j[pair]
    overlap = radius[a] + radius[b] - np.hypot(x[s, a] - x[s, b], y[s, a] - y[s, b])
    reduced = [part[a] * part[b] / (part[a] + part[b]) for part in (radius, mass)]
    force[pair] = _normal(model.normal, overlap, *reduced)
    s, a = sample[wall], i[wall]
    overlap = radius[a] - distances(x[s, a], y[s, a], run.wall.values[-1 - j[wall]])
    force[wall] = _normal(model.wall_normal, overlap, radius[a], mass[a])
    return force


def _model(run: xr.Dataset) -> Model | None:
    """The laws that the run's description names, if this engine has them."""
    try:
        return Scenario.from_json(run.attrs["scenario"]).model
    except (BadInput, KeyError, TypeError, ValueError, AttributeError):
        return None


def _normal(law: object, overlap: np.ndarray, radius: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Elastic force of each contact, N; places to 1 mm may have bodies in touch a little apart."""
    parts = zip(np.maximum(overlap, 0.0).tolist(), radius.tolist(), mass.tolist(), strict=True)
    return np.array([normal(law, *part, 0.0) for part in parts])
