"""Contact forces on persons and walls, from recorded contacts by the laws of the run's model.

A run records places, velocities, spins and tangential springs, of which its laws make the forces again, with limits
that follow. Places are stored as float32: 1 um at 15 m, or some 0.1 % of a normal force. And `semi_implicit` has
velocities half a step before the places, so that damping and friction that depend on velocity are those of half a step
ago. Of a spring that starts anew from zero when it slips, one in the very step of slipping shows its damper alone.
Normal forces of people at rest have neither of these two errors. To tell the very forces of a step, the recording
itself would have to keep two more values a contact, F_n and F_t.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine import Scenario, laws
from engine.errors import require
from engine.models import Model
from engine.scene import as_arrays

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
NEEDED = ("x", "y", "vx", "vy", "spin", "row_size", "contact_i", "contact_j", "contact_slip", "radius", "mass", "wall")
SAME_POINT = 1e-8  # m, as in the engine


class Touch(NamedTuple):
    """Contacts of a run that act; n points from the other body to person i, and the force is on i."""

    sample: Ints  # (contacts,)
    i: Ints  # (contacts,)
    j: Ints  # (contacts,) -1 - w for wall w
    F_n: Floats  # (contacts,) N along n, positive where the two are pressed together
    force: Floats  # (contacts, 2) N, friction included


def forces_on_persons(run: xr.Dataset) -> xr.Dataset:
    """Contact forces on every person at every sample, N and N/m; the social force and the drive are not among them.

    Parameters
    ----------
    run : one run recorded with contacts and `state="whole"`, as `sweep.read_run` or `sweep.to_dataset` gives it

    Returns
    -------
    Dataset with `contact_force_x`, `contact_force_y` (sample, person) N, their sum with friction; `contact_force`
    (sample, person) N, sum of the magnitudes of the normal forces; `pressure` (sample, person) N/m, that sum over the
    circumference (Helbing, Farkas & Vicsek 2000). Persons in no contact have 0, those who have left nan.

    Raises
    ------
    BadInput
        If the run was not recorded in this way, or does not carry its scenario.
    """
    touch = contacts(run)
    shape = run.sizes["sample"], run.sizes["person"]
    total, squeeze = np.zeros((*shape, 2)), np.zeros(shape)
    pairs = touch.j >= 0
    for who, sign, of in ((touch.i, 1.0, slice(None)), (touch.j, -1.0, pairs)):
        at = touch.sample[of], who[of]
        np.add.at(total, at, sign * touch.force[of])
        np.add.at(squeeze, at, np.abs(touch.F_n[of]))
    present = np.isfinite(run["x"].transpose("sample", "person").values)
    around = 2.0 * np.pi * run["radius"].values
    found = {
        "contact_force_x": (total[..., 0], "N", "x component of the sum of the contact forces"),
        "contact_force_y": (total[..., 1], "N", "y component of the sum of the contact forces"),
        "contact_force": (squeeze, "N", "sum of the magnitudes of the normal contact forces"),
        "pressure": (squeeze / around, "N m-1", "that sum over the circumference"),
    }
    return _dataset(run, ("sample", "person"), found).where(xr.DataArray(present, dims=("sample", "person")))


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
    touch = contacts(run)
    at_wall = touch.j < 0
    walls = run["wall"].transpose("wall", "end").values
    shape = run.sizes["sample"], len(walls)
    total, normal = np.zeros((*shape, 2)), np.zeros(shape)
    at = touch.sample[at_wall], -1 - touch.j[at_wall]
    np.add.at(total, at, -touch.force[at_wall])
    np.add.at(normal, at, np.abs(touch.F_n[at_wall]))
    length = np.hypot(walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1])
    found = {
        "wall_force_x": (total[..., 0], "N", "x component of the contact forces on the wall"),
        "wall_force_y": (total[..., 1], "N", "y component of the contact forces on the wall"),
        "wall_force": (normal, "N", "sum of the magnitudes of the normal contact forces on the wall"),
        "wall_load": (normal / length, "N m-1", "that sum over the length of the wall"),
    }
    return _dataset(run, ("sample", "wall"), found)


def contacts(run: xr.Dataset) -> Touch:
    """The contacts of a run that act, with their forces by the laws of its model."""
    absent = [name for name in NEEDED if name not in run.variables]
    remedy = 'record it with every=0.1, contacts=True, state="whole"'
    require(not absent, "run", f"without {', '.join(absent)}", "does not tell its contact forces", remedy)
    remedy = "pass what sweep.read_run gives, with its attributes"
    require("scenario" in run.attrs, "run", "without its scenario", "does not tell its laws", remedy)
    scenario = Scenario.from_json(run.attrs["scenario"])
    rows = list(_acting(run, scenario))
    sample, i, j = (np.array([row[k] for row in rows], np.int64) for k in range(3))
    F_n, fx, fy = (np.array([row[k] for row in rows], np.float64) for k in (3, 4, 5))
    return Touch(sample, i, j, F_n, np.column_stack([fx, fy]))


def _acting(run: xr.Dataset, scenario: Scenario) -> Iterator[tuple[int, int, int, float, float, float]]:
    """Sample, i, j, F_n and force on i of each contact that acts."""
    state = [run[n].transpose("sample", "person").values.astype(np.float64) for n in ("x", "y", "vx", "vy", "spin")]
    radius, mass = run["radius"].values, run["mass"].values
    scene, model = as_arrays(scenario.scene), scenario.model
    rows, slips = run["row_size"].values, run["contact_slip"].values.astype(np.float64)
    touching = zip(
        np.repeat(np.arange(rows.size), rows).tolist(),
        run["contact_i"].values.tolist(),
        run["contact_j"].values.tolist(),
        slips.tolist(),
        strict=True,
    )
    for k, i, j, slip in touching:
        x, y, vx, vy, spin = (values[k, i] for values in state)
        R, m = radius[i], mass[i]
        if j >= 0:
            dx, dy, ux, uy = x - state[0][k, j], y - state[1][k, j], vx - state[2][k, j], vy - state[3][k, j]
            wide, turn = R + radius[j], R * spin + radius[j] * state[4][k, j]
            R, m = R * radius[j] / wide, m * mass[j] / (m + mass[j])
        else:
            dx, dy, acts = _from_wall(scene.walls, scene.joints, -1 - j, x, y)
            if not acts:
                continue
            ux, uy, wide, turn = vx, vy, R, R * spin
        distance = np.hypot(dx, dy)
        nx, ny, overlap = dx / distance, dy / distance, wide - distance
        if overlap > 0.0:  # rounding may part a contact that hardly is one
            v_n, v_t = ux * nx + uy * ny, uy * nx - ux * ny - (turn if laws.turns(model.rotation) else 0.0)
            F_n, F_t = _forces(model, j >= 0, overlap, R, m, v_n, v_t, slip)
            yield k, i, j, F_n, F_n * nx - F_t * ny, F_n * ny + F_t * nx


def _forces(
    model: Model, persons: bool, overlap: float, radius: float, mass: float, v_n: float, v_t: float, slip: float
) -> tuple[float, float]:
    """Normal and tangential force of one contact, N."""
    pressing, sliding = (model.normal, model.sliding) if persons else (model.wall_normal, model.wall_sliding)
    F_n = laws.normal(pressing, overlap, radius, mass, v_n)
    F_t, _ = laws.sliding(sliding, overlap, radius, mass, v_t, F_n, slip)
    return float(F_n), float(F_t)


def _from_wall(walls: Floats, joints: Ints, w: int, x: float, y: float) -> tuple[float, float, bool]:
    """From the closest point of a wall to (x, y), and whether it acts for this wall.

    An end that lies on other walls acts once, for the first of them, and only if it is the closest point of each.
    """
    dx, dy, end = _from_segment(walls[w], x, y)
    for other in joints[w, end] if end >= 0 else ():
        if other < 0:
            break
        ox, oy, other_end = _from_segment(walls[other], x, y)
        if other_end < 0 or other < w or np.hypot(ox - dx, oy - dy) > SAME_POINT:
            return dx, dy, False
    return dx, dy, True


def _from_segment(wall: Floats, x: float, y: float) -> tuple[float, float, int]:
    """From the closest point of a wall to (x, y), and which end that point is (-1: neither)."""
    x0, y0, ux, uy, length = wall.tolist()
    along = (x - x0) * ux + (y - y0) * uy
    end = 0 if along <= 0.0 else (1 if along >= length else -1)
    along = min(max(along, 0.0), length)
    return x - x0 - along * ux, y - y0 - along * uy, end


def _dataset(run: xr.Dataset, dims: tuple[str, str], found: dict[str, tuple[Floats, str, str]]) -> xr.Dataset:
    """Values with their units, over the times of the run's samples."""
    variables = {name: (dims, values, {"units": u, "long_name": text}) for name, (values, u, text) in found.items()}
    return xr.Dataset(variables, coords={"time": run["time"]})
