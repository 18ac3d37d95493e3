"""The contacts of one recorded run as arrays: who is inside, who touches whom, who touches the sides of a door."""

import json
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Dims = Mapping[str, tuple[str | None, ...]]  # of variables; None: x0, y0, x1, y1

DIMS: Dims = {
    "time": ("sample",),
    "x": ("sample", "person"),
    "y": ("sample", "person"),
    "row_size": ("sample",),
    "contact_i": ("contact",),
    "contact_j": ("contact",),
    "exit_time": ("exit",),
    "exit_person": ("exit",),
    "outcome": (),
}
DOOR_DIMS: Dims = {"wall": ("wall", None), "door": ("door", None), "exit_door": ("exit",)}
SLACK = 1e-9  # s, by which times that are equal may differ in rounding
SAME_POINT = 1e-9  # m, between an end of a door and the end of the wall beside it
UNEQUAL = 1e-6  # of the sampling interval, in which times of samples may deviate besides from equal spacing


class History(NamedTuple):
    """Persons inside and their contacts at every sample of a run; who has left is in no contact."""

    time: Floats  # (samples,) s
    interval: float  # s between samples, the longest
    x: Floats  # (samples, persons) m
    y: Floats  # (samples, persons) m
    inside: Bools  # (samples, persons)
    sample: Ints  # (contacts,) sample of the contact
    i: Ints  # (contacts,) person
    j: Ints  # (contacts,) other person, or -1 - w for wall w

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of samples and of persons."""
        return self.inside.shape[0], self.inside.shape[1]


class Doorway(NamedTuple):
    """A door, and the walls at its two ends."""

    centre: Floats  # (2,) m
    vertices: Floats  # (2, 2) m, the ends of its line
    walls: tuple[Ints, Ints]  # numbers of the walls that end there


def history(run: xr.Dataset) -> History:
    """Who is inside and who touches whom, sample by sample.

    A person is inside from the start until its exit time; later contacts of persons who walk on beyond the
    exit are left out.

    Parameters
    ----------
    run : one run with `time`, `row_size` (sample), `x`, `y` (sample, person) m, `contact_i`, `contact_j`
        (contact), `exit_time`, `exit_person` (exit) and `outcome`

    Raises
    ------
    ValueError
        If a variable is missing or has other dimensions, samples are not equally spaced, or contacts and
        exits do not fit persons and samples.
    """
    check_dims(run, DIMS)
    time = run["time"].values.astype(np.float64)
    x, y = (run[name].transpose("sample", "person").values.astype(np.float64) for name in ("x", "y"))
    rows, i, j = (run[name].values.astype(np.int64) for name in ("row_size", "contact_i", "contact_j"))
    interval = sampling_interval(time, _time_step(run))
    check_contacts(rows, i, j, x.shape[1])
    inside = np.isfinite(x) & np.isfinite(y) & (time[:, None] < leaving_times(run, x.shape[1]) - SLACK)
    sample = np.repeat(np.arange(time.size), rows)
    both = inside[sample, i] & ((j < 0) | inside[sample, np.maximum(j, 0)])
    return History(time, interval, x, y, inside, sample[both], i[both], j[both])


def check_dims(run: xr.Dataset, dims: Dims) -> None:
    """Raise ValueError unless the run has the variables, of the dimensions of one run."""
    absent = [name for name in dims if name not in run.variables]
    if absent:
        raise ValueError(
            f"run has no variable {', '.join(absent)}: contact measures need its walls, doors, exits and recorded"
            " contacts, so record with record_every=0.02, contacts=True and pass what sweep.read_run gives"
        )
    for name, wanted in dims.items():
        have = run[name].dims
        named = {dim for dim in wanted if dim}
        if len(have) != len(wanted) or not named.issubset(have):
            raise ValueError(
                f"{name} has the dimensions ({', '.join(map(str, have))}), but one run has"
                f" ({', '.join(dim or '4' for dim in wanted)}): pass the runs one by one"
            )


def _time_step(run: xr.Dataset) -> float:
    """Time step, s, where the run says it; else 0."""
    return float(json.loads(run.attrs.get("scenario", "{}")).get("options", {}).get("dt") or 0.0)


def sampling_interval(time: Floats, dt: float) -> float:
    """Longest time between samples, s, checked to be the same throughout but for the step dt that each is rounded to.

    An interval that is no multiple of the step is sampled at the nearest steps.
    """
    if time.size < 2:
        raise ValueError(f"run has {time.size} samples, of which no interval can be told: pass a run of two or more")
    steps = np.diff(time)
    interval = float(np.mean(steps))
    if not interval > 0 or np.abs(steps - interval).max() > dt + UNEQUAL * interval:
        raise ValueError(
            f"samples are spaced by {steps.min():g} to {steps.max():g} s, but lifetimes need equal steps: pass all"
            " samples of a run, in order"
        )
    return float(steps.max())


def check_contacts(rows: Ints, i: Ints, j: Ints, persons: int) -> None:
    """Raise ValueError unless the contacts are as many as `row_size` says, each of two of the persons."""
    if rows.sum() != i.size:
        raise ValueError(
            f"row_size adds up to {rows.sum()} contacts, but there are {i.size}: select neither samples nor contacts"
        )
    wrong = np.flatnonzero((i < 0) | (i >= persons) | (j >= persons) | (i == j))
    if wrong.size:
        at = wrong[0]
        raise ValueError(
            f"contact {at} is of persons {i[at]} and {j[at]}, but the run has persons 0 to {persons - 1}, who touch"
            " others than themselves: pass contacts and persons of one run"
        )


def leaving_times(run: xr.Dataset, persons: int) -> Floats:
    """When each person crosses an exit, s; inf for those who never do: (persons,)."""
    who, when = run.exit_person.values.astype(np.int64), run.exit_time.values
    who, when = who[np.isfinite(when)], when[np.isfinite(when)]
    if who.size and not 0 <= who.min() <= who.max() < persons:
        raise ValueError(
            f"exit_person goes from {who.min()} to {who.max()}, but the run has persons 0 to {persons - 1}:"
            " pass exits and persons of one run"
        )
    left = np.full(persons, np.inf)
    left[who] = when
    return left


def doorway(run: xr.Dataset, door: int) -> Doorway:
    """The door of this number with the walls that have an end at an end of its line.

    Raises
    ------
    ValueError
        If there is no such door, or no wall at one of its ends.
    """
    check_dims(run, DOOR_DIMS)
    walls, doors = (run[name].transpose(name, ...).values.astype(np.float64) for name in ("wall", "door"))
    if not 0 <= door < len(doors):
        raise ValueError(f"door={door} is none of the run's {len(doors)} doors: give a number from 0")
    vertices = doors[door].reshape(2, 2)
    # (2 vertices, walls, 2 ends of each)
    apart = np.linalg.norm(walls.reshape(1, -1, 2, 2) - vertices[:, None, None], axis=-1)
    first, second = (np.flatnonzero((near <= SAME_POINT).any(axis=-1)) for near in apart)
    for vertex, beside in zip(vertices, (first, second), strict=True):
        if not beside.size:
            raise ValueError(
                f"door {door} ends at ({vertex[0]:g}, {vertex[1]:g}) m, where no wall ends: a blocking cluster leans"
                " on a wall at each end of a door, so draw the walls up to it"
            )
    return Doorway(vertices.mean(axis=0), vertices, (first, second))


def touching(h: History, walls: Ints) -> Bools:
    """Whether each contact is of a person and one of these walls: (contacts,)."""
    return np.isin(-1 - h.j, walls)
