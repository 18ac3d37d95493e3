"""One jam for all codes: a closed hall filled to constant density, everybody pressing towards one side.

The hall is always equally deep along the drive and as wide as N asks for, so that pressure, contacts and
neighbours of a person are the same at every N; a square hall would press harder the more persons it holds.
"""

import math
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from engine import laws, models
from engine.rooms import LIN_2016

SIZES = (100, 200, 1000, 10_000, 100_000)
DENSITY = 2.8  # persons/m^2; then 2.2 contacts a person and lists for 70 steps, as in Lin's room at 1.6 to 2 m/s
DEPTH = 8.0  # m, along the drive
V_D = 1.0  # m/s
JOSTLE = 0.5  # m/s, speed at the start in random directions: nobody stands still where people still get out
RADII = (0.25, 0.275, 0.3, 0.325, 0.35)  # m; five classes, because LAMMPS's exponential wants types
MASSES = (60.0, 65.0, 70.0, 75.0, 80.0)  # kg

ROUNDS, LISTED_FOR, MARGIN = 400, 10, 0.1  # of relaxation; rounds and m for which its lists hold
PUSH, MOMENTUM = 0.3, 0.8  # share of an overlap undone in a round, share of the last move made again


@dataclass(frozen=True)
class Packing:
    """A jam in the hall [0, depth] x [0, width], m; persons are arrays (N,), the drive is along x."""

    depth: float
    width: float
    x: np.ndarray  # m
    y: np.ndarray  # m
    vx: np.ndarray  # m/s
    vy: np.ndarray  # m/s
    size: np.ndarray  # class in RADII and MASSES

    @property
    def N(self) -> int:
        """Number of persons."""
        return self.x.size

    @property
    def radius(self) -> np.ndarray:
        """Radii (N,), m."""
        return np.array(RADII)[self.size]

    @property
    def mass(self) -> np.ndarray:
        """Masses (N,), kg."""
        return np.array(MASSES)[self.size]

    def save(self, path: Path) -> None:
        """Write all arrays to one file."""
        np.savez(path, **asdict(self))

    @staticmethod
    def load(path: Path) -> "Packing":
        """The packing that `save` wrote."""
        with np.load(path) as kept:
            arrays = [kept[name] for name in ("x", "y", "vx", "vy", "size")]
            return Packing(float(kept["depth"]), float(kept["width"]), *arrays)


def jam(N: int, seed: int = 0) -> Packing:
    """N persons at `DENSITY`, pushed out of their overlaps from random positions until they barely touch."""
    rng = np.random.default_rng(seed)
    width = N / (DENSITY * DEPTH)
    size = rng.permutation(np.arange(N) % len(RADII))
    radius = np.array(RADII)[size]
    positions = rng.uniform(radius, np.array([[DEPTH], [width]]) - radius)
    positions = _relaxed(positions, radius, np.array([[DEPTH], [width]]))
    angle = rng.uniform(0.0, 2.0 * math.pi, N)
    return Packing(DEPTH, width, positions[0], positions[1], JOSTLE * np.cos(angle), JOSTLE * np.sin(angle), size)


def _relaxed(positions: np.ndarray, radius: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Positions (2, N) after rounds in which discs and walls push overlaps apart."""
    last = np.zeros_like(positions)
    for round_ in range(ROUNDS):
        if round_ % LISTED_FOR == 0:
            i, j = pairs(positions, radius, MARGIN)
        last = MOMENTUM * last + PUSH * _overlaps(positions, radius, i, j, far)
        positions = np.clip(positions + np.clip(last, -0.02, 0.02), radius / 2, far - radius / 2)
    return positions


def _overlaps(positions: np.ndarray, radius: np.ndarray, i: np.ndarray, j: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Overlap vectors (2, N) that push each disc out of the others and of the walls, m."""
    way = positions[:, i] - positions[:, j]
    distance = np.maximum(np.hypot(*way), 1e-9)
    push = way / distance * np.maximum(radius[i] + radius[j] - distance, 0.0)
    on_each = [np.bincount(i, row, radius.size) - np.bincount(j, row, radius.size) for row in push]
    return np.array(on_each) + np.maximum(radius - positions, 0.0) - np.maximum(positions + radius - far, 0.0)


def pairs(positions: np.ndarray, radius: np.ndarray, gap: float) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of discs with a gap below `gap`, each once; `positions` (2, N) m."""
    found = cKDTree(positions.T).query_pairs(2.0 * float(radius.max()) + gap, output_type="ndarray").T
    i, j = found
    close = np.hypot(*(positions[:, i] - positions[:, j])) < radius[i] + radius[j] + gap
    return i[close], j[close]


def reach() -> float:
    """Gap at which Lin's social force ends by the paper's numerics, m."""
    return laws.cutoff(models.lin_dem().social, LIN_2016.force_tolerance)


def pairs_in_reach(packing: Packing) -> int:
    """Pairs with a gap below `reach`, which is what `ns per pair` counts for every code."""
    return pairs(np.array([packing.x, packing.y]), packing.radius, reach())[0].size
