"""The scene as the kernel sees it."""

import math
from typing import Any, NamedTuple

import numpy as np

from engine.kernel.state import records

STRAIGHT = 1e-9  # of a wall's length, and m: how far beside a line a point may lie and still be on it


SEGMENT = [(name, np.float64) for name in ("x0", "y0", "ux", "uy", "length")]  # m, unit vector along, m
WALL = np.dtype(SEGMENT)
EXIT_LINE = np.dtype([*SEGMENT, ("nx", np.float64), ("ny", np.float64), ("walk_on", np.float64)])  # outward normal, m


class SceneArrays(NamedTuple):
    """Walls and exits as arrays."""

    walls: np.ndarray  # (walls,) WALL
    joints: np.ndarray  # (walls, 2, n): walls that its start, its end lies on; -1 none
    exits: np.ndarray  # (exits,) EXIT_LINE


def as_arrays(scene: Any) -> SceneArrays:
    """Walls and exits of an `engine.Scene`."""
    walls, exits = records(len(scene.walls), WALL), records(len(scene.exits), EXIT_LINE)
    for w, (x0, y0, x1, y1) in enumerate(scene.walls):
        walls[w] = (x0, y0, *along(x0, y0, x1, y1))
    for k, line in enumerate(scene.exits):
        segment = (*line.start, *along(*line.start, *line.end))
        outward = np.divide(line.outward, math.hypot(*line.outward))
        exits[k] = (*segment, *outward, line.walk_on)
    return SceneArrays(walls, _joints(scene.walls), exits)


def along(x0: float, y0: float, x1: float, y1: float) -> tuple[float, float, float]:
    """Unit vector along a segment, and its length, m."""
    length = math.hypot(x1 - x0, y1 - y0)
    return (x1 - x0) / length, (y1 - y0) / length, length


def _joints(walls: Any) -> np.ndarray:
    """For each end of each wall the other walls that it lies on."""
    lies_on = [
        [[k for k, other in enumerate(walls) if k != w and _is_on(end, other)] for end in (wall[:2], wall[2:])]
        for w, wall in enumerate(walls)
    ]
    most = max((len(others) for wall in lies_on for others in wall), default=0)
    joints = np.full((len(walls), 2, max(most, 1)), -1, np.int64)
    for w, wall in enumerate(lies_on):
        for end, others in enumerate(wall):
            joints[w, end, : len(others)] = others
    return joints


def _is_on(point: tuple[float, float], wall: tuple[float, float, float, float]) -> bool:
    ux, uy, length = along(*wall)
    dx, dy = point[0] - wall[0], point[1] - wall[1]
    s = min(max(dx * ux + dy * uy, 0.0), length)
    return math.hypot(dx - s * ux, dy - s * uy) < STRAIGHT
