"""Contact forces on persons and walls, as a run recorded them.

`theta` has velocities half a step before the positions, so that what depends on velocity in a recorded force is that of
half a step ago. Of a spring that starts anew from zero when it slips, the force in the very step of slipping is the
limit.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine.errors import require
from engine.scene import from_closest_points

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
NEEDED = ("x", "y", "row_size", "contact_i", "contact_j", "contact_F_n", "contact_F_t", "radius", "wall")


class ContactForces(NamedTuple):
    """Contacts of a run; n points from the other body to person i, and the force is on i."""

    sample: Ints  # (contacts,)
    i: Ints  # (contacts,)
    j: Ints  # (contacts,) -1 - w for wall w
    F_n: Floats  # (contacts,) N along n, positive where the two are pressed together
    force: Floats  # (contacts, 2) N, friction included


def forces_on_persons(run: xr.Dataset) -> xr.Dataset:
    """Contact forces on every person at every sample, N and N/m; the social force and the drive are not among them.

    Parameters
    ----------
    run : Dataset
        One run recorded with contacts, as `sweep.read_run` or `sweep.to_dataset` gives it.

    Returns
    -------
    Dataset with `contact_force_x`, `contact_force_y` (sample, person) N, their sum with friction; `contact_force`
    (sample, person) N, sum of the magnitudes of the normal forces; `pressure` (sample, person) N/m, that sum over the
    circumference (Helbing, Farkas & Vicsek 2000). Persons in no contact have 0, those who have left nan.

    Raises
    ------
    BadInput
        If the run was not recorded in this way.
    """
    recorded = contacts(run)
    shape = run.sizes["sample"], run.sizes["person"]
    total, squeeze = np.zeros((*shape, 2)), np.zeros(shape)
    pairs = recorded.j >= 0
    for who, sign, of in ((recorded.i, 1.0, slice(None)), (recorded.j, -1.0, pairs)):
        at = recorded.sample[of], who[of]
        np.add.at(total, at, sign * recorded.force[of])
        np.add.at(squeeze, at, np.abs(recorded.F_n[of]))
    present = np.isfinite(run["x"].transpose("sample", "person").values)
    around = 2.0 * np.pi * run["radius"].values
    forces = {
        "contact_force_x": (total[..., 0], "N", "x component of the sum of the contact forces"),
        "contact_force_y": (total[..., 1], "N", "y component of the sum of the contact forces"),
        "contact_force": (squeeze, "N", "sum of the magnitudes of the normal contact forces"),
        "pressure": (squeeze / around, "N m-1", "that sum over the circumference"),
    }
    return _dataset(run, ("sample", "person"), forces).where(xr.DataArray(present, dims=("sample", "person")))


def forces_on_walls(run: xr.Dataset) -> xr.Dataset:
    """Contact forces on every wall at every sample, N and N/m.

    Returns
    -------
    Dataset with `wall_force_x`, `wall_force_y` (sample, wall) N, of all persons on the wall, friction included;
    `wall_force` (sample, wall) N, sum of the magnitudes of their normal forces; `wall_load` (sample, wall) N/m, that
    sum over the length of the wall. At a corner a person acts on one of the walls that meet there, as in the engine.

    Raises
    ------
    BadInput
        As `forces_on_persons`.
    """
    recorded = contacts(run)
    at_wall = recorded.j < 0
    walls = run["wall"].transpose("wall", "end").values
    shape = run.sizes["sample"], len(walls)
    total, normal = np.zeros((*shape, 2)), np.zeros(shape)
    at = recorded.sample[at_wall], -1 - recorded.j[at_wall]
    np.add.at(total, at, -recorded.force[at_wall])
    np.add.at(normal, at, np.abs(recorded.F_n[at_wall]))
    length = np.hypot(walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1])
    forces = {
        "wall_force_x": (total[..., 0], "N", "x component of the contact forces on the wall"),
        "wall_force_y": (total[..., 1], "N", "y component of the contact forces on the wall"),
        "wall_force": (normal, "N", "sum of the magnitudes of the normal contact forces on the wall"),
        "wall_load": (normal / length, "N m-1", "that sum over the length of the wall"),
    }
    return _dataset(run, ("sample", "wall"), forces)


def contacts(run: xr.Dataset) -> ContactForces:
    """The contacts of a run with their forces."""
    absent = [name for name in NEEDED if name not in run.variables]
    remedy = 'record it with record_every=0.1, contacts=True, record="full"'
    require(not absent, "run", f"without {', '.join(absent)}", "does not tell its contact forces", remedy)
    x, y = (run[name].transpose("sample", "person").values.astype(np.float64) for name in ("x", "y"))
    i, j = (run[name].values.astype(np.int64) for name in ("contact_i", "contact_j"))
    F_n, F_t = (run[name].values.astype(np.float64) for name in ("contact_F_n", "contact_F_t"))
    k, pair = np.repeat(np.arange(run.sizes["sample"]), run["row_size"].values), j >= 0
    n = np.empty((i.size, 2))
    n[pair] = np.column_stack([values[k[pair], i[pair]] - values[k[pair], j[pair]] for values in (x, y)])
    walls = run["wall"].transpose("wall", "end").values[-1 - j[~pair]]
    n[~pair] = np.column_stack(from_closest_points(walls, x[k[~pair], i[~pair]], y[k[~pair], i[~pair]]))
    n /= np.linalg.norm(n, axis=1)[:, None]
    t = np.column_stack([-n[:, 1], n[:, 0]])
    return ContactForces(k, i, j, F_n, F_n[:, None] * n + F_t[:, None] * t)


def _dataset(run: xr.Dataset, dims: tuple[str, str], forces: dict[str, tuple[Floats, str, str]]) -> xr.Dataset:
    """Values with their units, over the times of the run's samples."""
    variables = {name: (dims, values, {"units": u, "long_name": text}) for name, (values, u, text) in forces.items()}
    return xr.Dataset(variables, coords={"time": run["time"]})
