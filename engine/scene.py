"""The scene: wall segments, and exits that lead out of it."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.errors import finite, require
from engine.kernel.scene_arrays import STRAIGHT, along

Point = tuple[float, float]
Segment = tuple[float, float, float, float]  # x0, y0, x1, y1 in m


@dataclass(frozen=True)
class Exit:
    """A line that persons leave across.

    Attributes
    ----------
    start, end : ends of the line, m; walls begin there
    outward : direction that leads out, at a right angle to the line
    walk_on : how far beyond the line those who have left still walk and push, m
    """

    start: Point
    end: Point
    outward: Point
    walk_on: float = 0.0

    def __post_init__(self) -> None:
        for name in ("start", "end", "outward"):
            object.__setattr__(self, name, finite(f"exit {name}", getattr(self, name), 2))
        object.__setattr__(self, "walk_on", finite("exit walk_on", (self.walk_on,), 1)[0])
        require(self.walk_on >= 0, "exit walk_on", self.walk_on, "is negative", "give a distance of 0 m or more")
        require(self.width > 0, "exit width", f"{self.width:g} m", "is not positive", "give two different ends")
        along = np.subtract(self.end, self.start) / self.width
        size = math.hypot(*self.outward)
        crossed = size > 0 and abs(along @ self.outward) <= 1e-6 * size
        require(crossed, "exit outward", self.outward, "is not at a right angle to the exit", "give its normal")

    @property
    def width(self) -> float:
        """Length of the line, m."""
        return math.dist(self.start, self.end)


@dataclass(frozen=True)
class Scene:
    """Walls and exits.

    Attributes
    ----------
    walls : wall segments (x0, y0, x1, y1), m; pieces that touch on one line are joined into one wall.
        Walls that meet act through the closest point of each, a common corner once. A person in a bend feels
        both walls, so draw curves that people lean against from inside in few pieces.
    exits : the exits; none makes a closed box

    Raises
    ------
    BadInput
        If a wall is not made of four finite numbers, or has no length.
    """

    walls: tuple[Segment, ...] = ()
    exits: tuple[Exit, ...] = ()

    def __post_init__(self) -> None:
        walls: list[Any] = [finite("wall", wall, 4) for wall in self.walls]
        for wall in walls:
            require(math.dist(wall[:2], wall[2:]) > 0, "wall", wall, "has no length", "give two different ends")
        object.__setattr__(self, "walls", tuple(_joined(walls)))
        for line in self.exits:
            require(isinstance(line, Exit), "exit", repr(line), "is no Exit", "make one with Exit(start, end, outward)")
        object.__setattr__(self, "exits", tuple(self.exits))

    @property
    def doors(self) -> tuple[Segment, ...]:
        """The lines of the exits, (x0, y0, x1, y1) as walls have them, m."""
        return tuple((*line.start, *line.end) for line in self.exits)

    @classmethod
    def box(cls, width: float, height: float) -> "Scene":
        """A closed box [0, width] x [0, height], m."""
        return cls(((0, 0, width, 0), (width, 0, width, height), (width, height, 0, height), (0, height, 0, 0)))


def _joined(pieces: list[Segment]) -> list[Segment]:
    """Join pieces that touch or overlap on one line."""
    walls: list[Segment] = []
    for piece in pieces:
        place = len(walls)
        for k in range(len(walls) - 1, -1, -1):
            union = _union(walls[k], piece)
            if union:
                piece, place = union, k
                del walls[k]
        walls.insert(place, piece)
    return walls


def _union(first: Segment, second: Segment) -> Segment | None:
    """The one segment that two collinear, touching segments make; None if they are not such."""
    x0, y0 = first[:2]
    ux, uy, length = along(*first)
    ends = [(x - x0, y - y0) for x, y in (second[:2], second[2:])]
    aside = max(abs(ux * dy - uy * dx) for dx, dy in ends)
    s, e = sorted(ux * dx + uy * dy for dx, dy in ends)
    slack = STRAIGHT * max(length, e - s)
    if aside > slack or s > length + slack or e < -slack:
        return None
    s, e = min(s, 0.0), max(e, length)
    return x0 + s * ux, y0 + s * uy, x0 + e * ux, y0 + e * uy


def from_closest_points(walls: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From the closest points of wall segments (..., 4) to positions (...), broadcast, m."""
    x0, y0, x1, y1 = np.moveaxis(walls, -1, 0)
    ux, uy = x1 - x0, y1 - y0
    s = np.clip(((x - x0) * ux + (y - y0) * uy) / np.maximum(ux**2 + uy**2, 1e-300), 0.0, 1.0)
    return x - x0 - s * ux, y - y0 - s * uy
