"""The crowd: who is there at the start, drawn from a seed or given as arrays."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.errors import finite, require
from engine.kernel.placement import Range, Start, draw_uniform


@dataclass(frozen=True)
class Uniform:
    """A crowd whose persons and places are drawn independently and uniformly; see `Crowd.uniform`."""

    N: int
    area: tuple[float, float, float, float]
    radius: Range
    mass: Range
    v_d: Range
    speed: Range

    @property
    def largest_radius(self) -> float:
        """Largest radius that can be drawn, m."""
        return self.radius[1]

    def draw(self, seed: int, walls: np.ndarray) -> Start:
        """The crowd of this seed among these walls (`SceneArrays.walls`)."""
        start = draw_uniform(seed, self.N, self.area, self.radius, self.mass, self.v_d, self.speed, walls)
        x0, x1, y0, y1 = self.area
        fraction = float(np.sum(np.pi * start.radius**2)) / ((x1 - x0) * (y1 - y0))
        _require_room(not np.isnan(start.x).any(), self.N, fraction, self.area)
        return start


@dataclass(frozen=True)
class Given:
    """A crowd given person by person; see `Crowd.given`. Tuples of N numbers."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    vx: tuple[float, ...]
    vy: tuple[float, ...]
    spin: tuple[float, ...]
    radius: tuple[float, ...]
    mass: tuple[float, ...]
    v_d: tuple[float, ...]

    @property
    def N(self) -> int:
        """Number of persons."""
        return len(self.x)

    @property
    def largest_radius(self) -> float:
        """Largest radius, m."""
        return max(self.radius)

    def draw(self, seed: int, walls: np.ndarray) -> Start:
        """The crowd as given, whatever the seed."""
        return Start(*(np.array(getattr(self, name)) for name in Start._fields))


class Crowd:
    """Makes the two kinds of crowd."""

    @staticmethod
    def uniform(
        N: int,
        area: tuple[float, float, float, float],
        radius: float | Range = (0.25, 0.35),
        mass: float | Range = (60.0, 80.0),
        v_d: float | Range = 1.0,
        speed: float | Range = 0.0,
    ) -> Uniform:
        """N persons placed at random in a rectangle without overlap.

        Parameters
        ----------
        N : number of persons
        area : x0, x1, y0, y1 of the rectangle that holds every disc whole, m
        radius, mass, v_d : range to draw from, m, kg, m/s; or one value for all
        speed : initial speed in a random direction, m/s

        Raises
        ------
        BadInput
            If a number is not finite or out of its range, or the discs cannot fit into the area.
        """
        require(
            isinstance(N, int | np.integer) and N > 0, "N", repr(N), "is not a whole number above 0", "give persons"
        )
        box = finite("area", area, 4)
        require(box[1] > box[0] and box[3] > box[2], "area", area, "is empty", "give x0 < x1 and y0 < y1 in m")
        crowd = Uniform(
            int(N),
            (box[0], box[1], box[2], box[3]),
            _range("radius", radius, "m", positive=True),
            _range("mass", mass, "kg", positive=True),
            _range("v_d", v_d, "m/s"),
            _range("speed", speed, "m/s"),
        )
        _fits(crowd)
        return crowd

    @staticmethod
    def given(x: Any, y: Any, vx: Any, vy: Any, spin: Any, radius: Any, mass: Any, v_d: Any) -> Given:
        """Persons as arrays (N,) or, from `vx` on, single numbers that hold for all; SI units.

        Raises
        ------
        BadInput
            If lengths differ, a number is not finite, or a radius or mass is not positive.
        """
        arrays = dict(zip(Start._fields, map(np.asarray, (x, y, vx, vy, spin, radius, mass, v_d)), strict=True))
        N = arrays["x"].size
        require(N > 0, "crowd", "of 0 persons", "is empty", "give at least one person")
        for name, values in arrays.items():
            fits = values.ndim == 0 or values.shape == (N,)
            require(fits, name, f"of shape {values.shape}", f"does not match {N} persons", "give one number each")
            least = "positive" if name in ("radius", "mass") else ("not negative" if name == "v_d" else "finite")
            bad = [v for v in np.broadcast_to(values, N) if not _holds(v, least)]
            require(not bad, name, bad[0] if bad else "", f"is not finite and {least}", "mend the array")
        crowd = Given(*(tuple(np.broadcast_to(values, N).astype(float).tolist()) for values in arrays.values()))
        positions = list(zip(crowd.x, crowd.y, strict=True))
        twice = next((p for p in positions if positions.count(p) > 1), None) if len(set(positions)) < N else None
        require(twice is None, "position", twice, "is given to two persons", "move one of them")
        return crowd


def _holds(value: float, least: str) -> bool:
    return math.isfinite(value) and (least == "finite" or value > 0 or (least == "not negative" and value == 0))


def _range(name: str, given: Any, unit: str, positive: bool = False) -> Range:
    least = "positive" if positive else "not negative"
    try:
        low, high = (given, given) if np.ndim(given) == 0 else given
        low, high = float(low), float(high)
    except (TypeError, ValueError):
        low = high = math.nan
    shown = f"{given} {unit}"
    require(_holds(low, least) and _holds(high, least), name, shown, f"is not finite and {least}", "mend it")
    require(low <= high, name, shown, "is a range that runs backwards", "give the smaller value first")
    return low, high


def _fits(crowd: Uniform) -> None:
    """Refuse what cannot fit at all: more disc area than the densest packing of discs covers."""
    x0, x1, y0, y1 = crowd.area
    least = crowd.N * math.pi * crowd.radius[0] ** 2
    fraction = least / ((x1 - x0) * (y1 - y0))
    room = min(x1 - x0, y1 - y0) >= 2 * crowd.radius[1] and fraction <= math.pi / math.sqrt(12.0)
    _require_room(room, crowd.N, fraction, crowd.area)


def _require_room(holds: bool, N: int, fraction: float, area: tuple[float, float, float, float]) -> None:
    where = f"{area[1] - area[0]:g} x {area[3] - area[2]:g} m"
    require(
        holds,
        "N",
        N,
        f"persons do not fit at random into {where} without overlap (they cover {fraction:.0%} of it)",
        "reduce N or the radii, or enlarge the room (up to about 45 % can be placed)",
    )
