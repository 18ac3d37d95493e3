"""A recorded run as frames: who was where at each, with the step out of the room that a run does not record."""

import json
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from engine.errors import require
from sweep.schema import MM

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
BEYOND = MM  # m, least distance beyond the door at which a person who has left is shown
UNEQUAL = 1e-6  # of the interval, in which times may differ from equal spacing
NEVER = np.iinfo(np.int64).max
NEEDED = ("time", "x", "y", "exit_time", "exit_person", "exit_x", "exit_y", "exit_door", "door")


class Frames(NamedTuple):
    """Places at equally spaced times, the first of them at time 0."""

    table: pd.DataFrame  # id, frame, x (m), y (m), sorted by id and frame; id is the number of the person
    rate: float  # frames a second


class Doors(NamedTuple):
    """The lines of the exits."""

    start: Floats  # (doors, 2) m
    along: Floats  # (doors, 2) unit vectors
    outward: Floats  # (doors, 2) unit vectors
    width: Floats  # (doors,) m


class Departure(NamedTuple):
    """Who left when and where; one value for each person, also for those who did not."""

    frame: Ints  # (persons,) the first at or after leaving, NEVER for those inside
    time: Floats  # (persons,) s, inf
    place: Floats  # (persons, 2) m, nan
    door: Ints  # (persons,) 0 for those inside


def frames(run: xr.Dataset) -> Frames:
    """The places of a run, frame by frame.

    A run records nobody who has left. So that a line at the door is seen to be crossed in the first frame at or after
    the time of leaving, each person is shown in that frame and in the next: where it was recorded (rooms in which
    people walk on), else on its way straight out at the speed with which it came, and at least 1 mm beyond the door.
    The second frame is there because PedPy 1.5 passes over the last movement of everybody. Recorded places that
    rounding to 1 mm has put beyond the door too early are put on its line. No other place is changed.

    Parameters
    ----------
    run : one run with samples, as `sweep.read_run` or `sweep.to_dataset` gives it

    Raises
    ------
    BadInput
        If it was not recorded, has several runs, or its samples are not equally spaced.
    """
    check_recorded(run)
    time, interval = _clock(run)
    rate = _round(1.0 / interval)
    ahead = interval * np.arange(time.size) - time
    x, y = (_shifted(run[name].transpose("sample", "person").values, time, ahead) for name in ("x", "y"))
    lines, left = doors(run), departures(run, time.size, x.shape[1], rate)
    last = max(int(left.frame[left.frame < NEVER].max(initial=0)) + 2, time.size)
    at = np.full((last, x.shape[1], 2), np.nan)
    at[: time.size] = np.stack([x, y], axis=-1)
    for k in np.flatnonzero(left.frame < NEVER):
        _step_out(at[:, k], lines, left, int(k), rate)
    person, frame = np.nonzero(np.isfinite(at).all(axis=-1).T)
    places = at[frame, person]
    return Frames(pd.DataFrame({"id": person, "frame": frame, "x": places[:, 0], "y": places[:, 1]}), rate)


def check_recorded(run: xr.Dataset) -> None:
    """Raise `BadInput` unless this is one run with samples."""
    absent = [name for name in NEEDED if name not in run.variables]
    remedy = "record it with record_every=0.1 (in a shell: --record-every 0.1) and read it with sweep.read_run"
    require(not absent, "run", f"without {', '.join(absent)}", "has no trajectories", remedy)
    single = run["x"].ndim == 2 and run["exit_time"].ndim == 1
    require(single, "dataset", f"of dimensions {', '.join(map(str, run.dims))}", "is not one run", "pass a single run")


def doors(run: xr.Dataset) -> Doors:
    """The lines of a run's exits, with the directions that lead out as its scenario has them.

    Raises
    ------
    BadInput
        If the run does not carry its scenario.
    """
    ends = run["door"].values.astype(np.float64).reshape(-1, 2, 2)
    try:
        exits = json.loads(run.attrs["scenario"])["scene"]["exits"]
        outward = np.array([line["outward"] for line in exits], np.float64).reshape(-1, 2)
        known = len(outward) == len(ends)
    except (KeyError, TypeError, ValueError):
        known = False
    remedy = "pass what sweep.read_run gives, with its attributes"
    require(known, "run", "without its scenario", "does not tell which way its doors lead", remedy)
    along = ends[:, 1] - ends[:, 0]
    width = np.linalg.norm(along, axis=1)
    return Doors(ends[:, 0], along / width[:, None], outward / np.linalg.norm(outward, axis=1)[:, None], width)


def departures(run: xr.Dataset, samples: int, persons: int, rate: float) -> Departure:
    """Who left when and where, and in which frame one sees it."""
    who = run["exit_person"].values.astype(np.int64)
    when = run["exit_time"].values.astype(np.float64)
    made = np.isfinite(when)
    who, when = who[made], when[made]
    remedy = "pass exits and samples of one run"
    fits = bool(((who >= 0) & (who < persons)).all())
    require(fits, "exit_person", who.tolist() if who.size < 9 else "...", f"is not among {persons} persons", remedy)
    frame, time = np.full(persons, NEVER), np.full(persons, np.inf)
    place, door = np.full((persons, 2), np.nan), np.zeros(persons, np.int64)
    clock = np.arange(max(samples, int(np.ceil(when.max(initial=0.0) * rate)) + 2)) / rate
    frame[who] = np.searchsorted(clock, when, side="left")
    time[who], door[who] = when, run["exit_door"].values[made]
    place[who] = np.stack([run[name].values[made] for name in ("exit_x", "exit_y")], axis=-1)
    return Departure(frame, time, place, door)


def _clock(run: xr.Dataset) -> tuple[Floats, float]:
    """Times of the samples, s, and the sampling interval that was asked for: each is that of the nearest step."""
    time = run["time"].values.astype(np.float64)
    require(time.size > 1, "run", f"of {time.size} samples", "has no frame rate", "record it more often")
    mean = (time[-1] - time[0]) / (time.size - 1)
    try:
        options = json.loads(run.attrs["scenario"])["options"]
        interval, off = float(options["record_every"]), 0.51 * float(options["dt"])
    except (KeyError, TypeError, ValueError):
        interval, off = mean, 0.0
    spacing = np.diff(time)
    equal = np.abs(time - interval * np.arange(time.size)).max() <= off + UNEQUAL * mean
    remedy = "pass all samples of a run, in order"
    apart = f"{spacing.min():g} to {spacing.max():g} s apart"
    require(bool(equal), "samples", apart, "are no frames from time 0", remedy)
    return time, interval


def _shifted(positions: Floats, time: Floats, ahead: Floats) -> Floats:
    """Positions (samples, persons) so much later, s, by the velocity to the next sample, or else from the last, m."""
    known = positions.astype(np.float64)
    velocity = np.full_like(known, np.nan)
    velocity[:-1] = np.diff(known, axis=0) / np.diff(time)[:, None]
    velocity[1:] = np.where(np.isfinite(velocity[1:]), velocity[1:], velocity[:-1])
    return known + np.where(np.isfinite(velocity), velocity, 0.0) * ahead[:, None]


def _round(rate: float) -> float:
    """A rate without what rounding made of it."""
    return float(f"{rate:.12g}")


def _step_out(at: Floats, lines: Doors, left: Departure, person: int, rate: float) -> None:
    """Make a person (places (frames, 2) m, changed here) cross its door between the frames around its leaving."""
    first, k = int(left.frame[person]), int(left.door[person])
    if first > 1 and not np.isfinite(at[first - 1]).all():  # left between this frame and the step nearest to it
        waited = left.time[person] - (first - 2) / rate
        at[first - 1] = at[first - 2] + (left.place[person] - at[first - 2]) / (rate * waited)
    ahead = (at - lines.start[k]) @ lines.outward[k]  # m beyond the line of the door
    early = np.flatnonzero((ahead[:first] > 0.0) & (ahead[:first] <= BEYOND))
    at[early] -= ahead[early, None] * lines.outward[k]
    before = max(first - 2, 0)
    waited = max(left.time[person] - before / rate, 1.0 / rate)
    speed = max(-ahead[before] / waited, 0.0)
    if not (first > 0 and ahead[first] >= BEYOND and _through(at[first - 1], at[first], lines, k)):
        way = max(speed * (first / rate - left.time[person]), BEYOND)
        at[first] = left.place[person] + way * lines.outward[k]
    if not np.isfinite(at[first + 1]).all():
        at[first + 1] = at[first] + max(speed / rate, BEYOND) * lines.outward[k]


def _through(start: Floats, end: Floats, lines: Doors, k: int) -> bool:
    """Whether the straight way from start to end crosses the door."""
    ahead = (np.stack([start, end]) - lines.start[k]) @ lines.outward[k]
    share = -ahead[0] / (ahead[1] - ahead[0])
    along = float((start + share * (end - start) - lines.start[k]) @ lines.along[k])
    return bool(0.0 <= along <= lines.width[k])
