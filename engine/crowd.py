"""The crowd: who is there at the start, drawn from a seed or given as arrays."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from engine.errors import finite, require

PERSONS, PLACEMENT, MOTION = 0, 1, 2  # independent random streams of one seed
MAX_ROUNDS = 2000  # of placement: each round every person without a place tries a new one

Range = tuple[float, float]


class Start(NamedTuple):
    """The state of N persons at the start, each an array (N,)."""

    x: np.ndarray  # m
    y: np.ndarray  # m
    vx: np.ndarray  # m/s
    vy: np.ndarray  # m/s
    spin: np.ndarray  # rad/s
    radius: np.ndarray  # m
    mass: np.ndarray  # kg
    v_d: np.ndarray  # m/s


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
        """The crowd of this seed among these walls (rows of `SceneArrays.walls`)."""
        persons = _stream(seed, PERSONS)
        radius = persons.uniform(*self.radius, self.N)
        mass = persons.uniform(*self.mass, self.N)
        v_d = persons.uniform(*self.v_d, self.N)
        x, y = _place(radius, self.area, walls, _stream(seed, PLACEMENT))
        motion = _stream(seed, MOTION)
        speed, angle = motion.uniform(*self.speed, self.N), motion.uniform(0.0, 2.0 * math.pi, self.N)
        return Start(x, y, speed * np.cos(angle), speed * np.sin(angle), np.zeros(self.N), radius, mass, v_d)


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
        places = list(zip(crowd.x, crowd.y, strict=True))
        twice = next((place for place in places if places.count(place) > 1), None) if len(set(places)) < N else None
        require(twice is None, "place", twice, "is given to two persons", "move one of them")
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


def _stream(seed: int, stream: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(stream,)))


def _fits(crowd: Uniform) -> None:
    """Refuse what cannot fit at all: more disc area than the densest packing of discs covers."""
    x0, x1, y0, y1 = crowd.area
    least = crowd.N * math.pi * crowd.radius[0] ** 2
    share = least / ((x1 - x0) * (y1 - y0))
    room = min(x1 - x0, y1 - y0) >= 2 * crowd.radius[1] and share <= math.pi / math.sqrt(12.0)
    _require_room(room, crowd.N, share, crowd.area)


def _require_room(holds: bool, N: int, share: float, area: tuple[float, float, float, float]) -> None:
    where = f"{area[1] - area[0]:g} x {area[3] - area[2]:g} m"
    require(
        holds,
        "N",
        N,
        f"persons do not fit at random into {where} without overlap (they cover {share:.0%} of it)",
        "reduce N or the radii, or enlarge the room (up to about 45 % can be placed)",
    )


def _place(
    radius: np.ndarray, area: tuple[float, float, float, float], walls: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Random sequential placement: rounds in which all who wait try one place each."""
    x0, x1, y0, y1 = area
    N = radius.size
    size = max(2.0 * float(radius.max()), math.sqrt((x1 - x0) * (y1 - y0) / (4.0 * N + 16.0)))  # of a cell
    x, y = np.full(N, np.nan), np.full(N, np.nan)
    first = np.full((int((x1 - x0) / size) + 3, int((y1 - y0) / size) + 3), -1, np.int64)  # person in each cell
    following = np.full(N, -1, np.int64)  # the next person in the same cell
    waiting = np.arange(N)
    for _ in range(MAX_ROUNDS):
        u, v = rng.random(waiting.size), rng.random(waiting.size)
        r = radius[waiting]
        tried_x, tried_y = x0 + r + u * (x1 - x0 - 2 * r), y0 + r + v * (y1 - y0 - 2 * r)
        _try_places(waiting, tried_x, tried_y, x, y, radius, walls, first, following, x0, y0, size)
        waiting = waiting[np.isnan(x[waiting])]
        if not waiting.size:
            return x, y
    share = float(np.sum(np.pi * radius**2)) / ((x1 - x0) * (y1 - y0))
    _require_room(False, N, share, area)
    raise AssertionError("unreachable")


@njit(cache=True)
def _try_places(who, tried_x, tried_y, x, y, radius, walls, first, following, x0, y0, size):
    """Give each of `who` the tried place if nobody and no wall is in the way; nan in x: no place yet."""
    for k in range(who.size):
        i, px, py = who[k], tried_x[k], tried_y[k]
        cx, cy = int((px - x0) / size) + 1, int((py - y0) / size) + 1
        free = _is_free(px, py, radius[i], cx, cy, x, y, radius, first, following)
        if free and _clear_of(walls, px, py, radius[i]):
            following[i], first[cx, cy] = first[cx, cy], i
            x[i], y[i] = px, py


@njit(cache=True)
def _is_free(px, py, r, cx, cy, x, y, radius, first, following):
    for ax in range(cx - 1, cx + 2):
        for ay in range(cy - 1, cy + 2):
            j = first[ax, ay]
            while j >= 0:
                if (px - x[j]) ** 2 + (py - y[j]) ** 2 <= (r + radius[j]) ** 2:
                    return False
                j = following[j]
    return True


@njit(cache=True)
def _clear_of(walls, px, py, r):
    for w in range(walls.shape[0]):
        dx, dy = px - walls[w, 0], py - walls[w, 1]
        s = min(max(dx * walls[w, 2] + dy * walls[w, 3], 0.0), walls[w, 4])
        if (dx - s * walls[w, 2]) ** 2 + (dy - s * walls[w, 3]) ** 2 < r * r * (1.0 - 1e-12):
            return False
    return True
