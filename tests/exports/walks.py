"""Recorded runs of persons who walk straight out of doors, all made by hand."""

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr

from sweep.schema import FLAGS

OUT = 1  # all_out
SQUARE = (
    (0, 0, 4, 0),
    (4, 3, 4, 4),
    (4, 0, 4, 1),
    (0, 4, 4, 4),
    (0, 0, 0, 4),
)  # a room with a door at x = 4, y = 1 to 3
DOOR = (4.0, 1.0, 4.0, 3.0)


def walked(
    times: Sequence[float],
    speed: float = 1.0,
    rate: float = 10.0,
    doors: Sequence[Sequence[float]] = (DOOR,),
    outward: Sequence[Sequence[float]] = ((1.0, 0.0),),
    walls: Sequence[Sequence[float]] = SQUARE,
    walk_on: float = 0.0,
    rounded: int | None = None,
) -> xr.Dataset:
    """Person k crosses door k (modulo their number) in its middle, straight out at a speed (m/s), at times[k] (s).

    walk_on : s for which the departed are still recorded; rounded : decimals of the recorded positions
    """
    lines, ways = np.array(doors, float).reshape(-1, 2, 2), np.array(outward, float)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    by = np.arange(len(times)) % len(lines)
    middle, way, when = lines.mean(axis=1)[by], ways[by], np.array(times, float)
    clock = np.arange(int(np.floor(when.max() * rate)) + 1) / rate
    gone = clock[:, None] - when  # s since leaving
    at = middle + speed * gone[..., None] * way
    at = at if rounded is None else at.round(rounded)
    at[gone > walk_on] = np.nan
    order = np.argsort(when, kind="stable")
    scene = {"exits": [{"outward": list(way)} for way in ways]}
    return xr.Dataset(
        {
            "x": (("sample", "person"), at[..., 0]),
            "y": (("sample", "person"), at[..., 1]),
            "exit_time": ("exit", when[order], {"units": "s"}),
            "exit_person": ("exit", order.astype(np.int32)),
            "exit_x": ("exit", middle[order, 0], {"units": "m"}),
            "exit_y": ("exit", middle[order, 1], {"units": "m"}),
            "exit_door": ("exit", by[order].astype(np.int16)),
            "wall": (("wall", "end"), np.array(walls, float).reshape(-1, 4)),
            "door": (("door", "end"), np.array(doors, float)),
            "radius": ("person", 0.25 + 0.01 * np.arange(len(times)), {"units": "m"}),
            "outcome": ((), np.int8(OUT), FLAGS),
            "end_time": ((), when.max(), {"units": "s"}),
            "N_out": ((), len(times)),
            "persons": ((), len(times)),
        },
        coords={"time": ("sample", clock), "exit": np.arange(1, len(times) + 1)},
        attrs={"scenario": json.dumps({"scene": scene})},
    )
