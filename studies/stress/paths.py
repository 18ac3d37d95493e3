"""Where persons are at the sampled times: distances to each other and to walls, and walls that paths cross."""

from typing import NamedTuple

import numpy as np

from engine import Run
from engine.kernel.scene_arrays import as_arrays


class Walls(NamedTuple):
    """Distances of N persons from W walls at M times."""

    distance: np.ndarray  # (M, N, W) m, from the closest point of each wall
    acts: np.ndarray  # (M, N, W) whether the wall acts: a shared end acts once, and only from outside the bend


def pair_indices(N: int) -> tuple[np.ndarray, np.ndarray]:
    """All pairs i < j."""
    i, j = np.triu_indices(N, 1)
    return i, j


def pair_distances(run: Run) -> np.ndarray:
    """Distances of all pairs at the sampled times (M, pairs), m; nan where one of the two is gone."""
    assert run.samples is not None
    x, y = run.samples.x, run.samples.y
    i, j = pair_indices(run.N)
    return np.hypot(x[:, i] - x[:, j], y[:, i] - y[:, j])


def deepest_overlaps(run: Run) -> np.ndarray:
    """Largest overlap of two persons at each sampled time (M,), m; crowds of any size.

    Every person is compared with those up to one largest diameter aside, in the order of x.
    """
    assert run.samples is not None
    radius, widest = run.start.radius, 2.0 * float(run.start.radius.max())
    found = np.zeros(run.samples.time.size)
    for k, (x, y) in enumerate(zip(run.samples.x, run.samples.y, strict=True)):
        here = np.flatnonzero(np.isfinite(x))
        order = here[np.argsort(x[here])]
        xs, ys, rs = x[order], y[order], radius[order]
        for shift in range(1, order.size):
            near = xs[shift:] - xs[:-shift] < widest
            if not near.any():
                break
            apart = np.hypot(xs[shift:] - xs[:-shift], ys[shift:] - ys[:-shift])
            found[k] = max(found[k], float(np.max(rs[shift:] + rs[:-shift] - apart)))
    return found


def walls_of(run: Run) -> Walls:
    """Distances from walls, and which walls act."""
    assert run.samples is not None
    arrays = as_arrays(run.scenario.scene)
    x, y = run.samples.x[:, :, None], run.samples.y[:, :, None]
    x0, y0, ux, uy, length = (arrays.walls[name] for name in ("x0", "y0", "ux", "uy", "length"))
    dx, dy = x - x0, y - y0
    along = np.clip(dx * ux + dy * uy, 0.0, length)
    dx, dy = dx - along * ux, dy - along * uy
    end = np.where(along <= 0.0, 0, np.where(along >= length, 1, -1))
    acts = np.ones(end.shape, bool)
    for w in range(length.size):
        for e in (0, 1):
            for other in arrays.joints[w, e][arrays.joints[w, e] >= 0]:
                here = (np.abs(dx[..., w] - dx[..., other]) < 1e-8) & (np.abs(dy[..., w] - dy[..., other]) < 1e-8)
                counts = here & (end[..., other] >= 0) & (other > w)
                acts[..., w] &= (end[..., w] != e) | counts
    return Walls(np.hypot(dx, dy), acts)


def crossings(run: Run) -> list[str]:
    """Whose straight way from one sample to the next leads through a wall, in words."""
    assert run.samples is not None
    x, y, time = run.samples.x, run.samples.y, run.samples.time
    said = []
    for w, (x0, y0, x1, y1) in enumerate(run.scenario.scene.walls):
        side = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)  # of the wall's line, m^2
        length = (x1 - x0) ** 2 + (y1 - y0) ** 2
        along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length
        changed = side[1:] * side[:-1] < 0.0
        part = side[:-1] / np.where(changed, side[:-1] - side[1:], 1.0)
        at = along[:-1] + part * (along[1:] - along[:-1])
        for k, i in np.argwhere(changed & (at >= 0.0) & (at <= 1.0)):
            said.append(f"person {i} went through wall {w} between {time[k]:g} and {time[k + 1]:g} s")
    return said
