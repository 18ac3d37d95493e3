"""Energy and momentum of a sampled run, by formulas of their own beside the engine's forces.

A step of the engine conserves the sum of what moves, what contacts store and what the social force stores, up to
the error of the step. Mindlin's spring k_t sqrt(R overlap) stiffens while it is held and takes up energy that no
force pays for; that work is counted apart (`stiffening`), since it may come back as motion.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from engine import Run, laws
from engine.kernel.scene_arrays import as_arrays
from studies.stress.paths import pair_distances, pair_indices, walls_of


class Ledger(NamedTuple):
    """Energies at M sampled times, J (M,)."""

    kinetic: np.ndarray
    pressed: np.ndarray  # in normal contact
    social: np.ndarray
    sheared: np.ndarray  # in tangential springs
    stiffening: np.ndarray  # work on tangential springs by pressing, up to each time

    @property
    def total(self) -> np.ndarray:
        """All that is stored, less what pressing put into tangential springs."""
        return self.kinetic + self.pressed + self.social + self.sheared - self.stiffening


def _nothing(p: Any, depth: np.ndarray, other: Any) -> np.ndarray:
    return np.zeros_like(depth)


def _hertz(p: Any, depth: np.ndarray, radius: np.ndarray) -> np.ndarray:
    return 0.4 * p.k_n * np.sqrt(radius) * depth**2.5


def _hooke(p: Any, depth: np.ndarray, radius: np.ndarray) -> np.ndarray:
    return 0.5 * p.k_n * depth**2


def _exponential(p: Any, gap: np.ndarray, tolerance: float) -> np.ndarray:
    """Integral of A exp(-gap/B) - tolerance from the gap to where it ends."""
    if tolerance >= p.A:
        return np.zeros_like(gap)
    ends = p.B * math.log(p.A / tolerance)
    return np.where(gap < ends, p.B * (p.A * np.exp(-gap / p.B) - tolerance) - tolerance * (ends - gap), 0.0)


Potential = Callable[[Any, np.ndarray, Any], np.ndarray]  # of contacts: reduced radii; social: the force tolerance
CONTACT: dict[type, Potential] = {laws.Absent: _nothing, laws.Hertz: _hertz, laws.Hooke: _hooke}
SOCIAL: dict[type, Potential] = {laws.Absent: _nothing, laws.Exponential: _exponential}


def is_known(model: Any) -> bool:
    """Whether the energy that the model's laws store is known in closed form."""
    contacts, pushes = {type(model.normal), type(model.wall_normal)}, {type(model.social), type(model.wall_social)}
    return contacts <= CONTACT.keys() and pushes <= SOCIAL.keys()


def ledger(run: Run) -> Ledger:
    """The energies of a run that sampled places and contacts, with everybody inside."""
    samples, start, model = run.samples, run.start, run.scenario.model
    assert samples is not None
    tolerance = run.scenario.numerics.force_tolerance
    inertia = (
        model.rotation.inertia_factor * start.mass * start.radius**2
        if laws.is_present(model.rotation)
        else 0.0 * start.mass
    )
    kinetic = 0.5 * (start.mass * (samples.vx**2 + samples.vy**2) + inertia * samples.spin**2).sum(axis=1)
    i, j = pair_indices(run.N)
    gap = pair_distances(run) - start.radius[i] - start.radius[j]
    radius = start.radius[i] * start.radius[j] / (start.radius[i] + start.radius[j])
    pressed = _stored(CONTACT, model.normal, np.maximum(-gap, 0.0), radius)
    social = _stored(SOCIAL, model.social, gap, tolerance)
    if run.scenario.scene.walls:
        walls = walls_of(run)
        depth = np.where(walls.acts, start.radius[None, :, None] - walls.distance, -math.inf)
        pressed += _stored(CONTACT, model.wall_normal, np.maximum(depth, 0.0), start.radius[None, :, None])
        social += _stored(SOCIAL, model.wall_social, -depth, tolerance)
    sheared, stiffening = _springs(run)
    return Ledger(kinetic, pressed, social, sheared, stiffening)


def momentum(run: Run) -> np.ndarray:
    """Momentum along x and y at the sampled times (2, M), kg m/s."""
    assert run.samples is not None
    return np.stack([run.samples.vx @ run.start.mass, run.samples.vy @ run.start.mass])


def _stored(table: dict[type, Potential], law: Any, depth: np.ndarray, other: Any) -> np.ndarray:
    return table[type(law)](law, depth, other).reshape(depth.shape[0], -1).sum(axis=1)


def _springs(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Energy in tangential springs, and the work of pressing on them, at the sampled times, J."""
    samples, model = run.samples, run.scenario.model
    assert samples is not None
    M = samples.time.size
    if not laws.has_history(model.friction) and not laws.has_history(model.wall_friction):
        return np.zeros(M), np.zeros(M)
    i, j, at = samples.contact_i, samples.contact_j, np.repeat(np.arange(M), samples.row_size)
    stiffness = _stiffnesses(run, i, j, at)
    slip = samples.tangential_displacement
    sheared = np.bincount(at, 0.5 * stiffness * slip**2, M)
    order = np.lexsort((at, j, i))
    i, j, at, stiffness, slip = i[order], j[order], at[order], stiffness[order], slip[order]
    goes_on = (np.diff(i) == 0) & (np.diff(j) == 0) & (np.diff(at) == 1)
    work = np.where(goes_on, 0.25 * np.diff(stiffness) * (slip[1:] ** 2 + slip[:-1] ** 2), 0.0)
    return sheared, np.cumsum(np.bincount(at[1:], work, M))


def _stiffnesses(run: Run, i: np.ndarray, j: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Tangential stiffness of each sampled contact, N/m."""
    samples, r, model = run.samples, run.start.radius, run.scenario.model
    assert samples is not None
    x, y = samples.x, samples.y
    found = np.zeros(i.size)
    pairs = j >= 0
    a, b, k = i[pairs], j[pairs], at[pairs]
    overlap = np.maximum(r[a] + r[b] - np.hypot(x[k, a] - x[k, b], y[k, a] - y[k, b]), 0.0)
    if laws.has_history(model.friction):
        found[pairs] = model.friction.k_t * np.sqrt(overlap * r[a] * r[b] / (r[a] + r[b]))
    a, w, k = i[~pairs], -1 - j[~pairs], at[~pairs]
    if a.size and laws.has_history(model.wall_friction):
        walls = as_arrays(run.scenario.scene).walls[w]
        x0, y0, ux, uy, length = (walls[name] for name in ("x0", "y0", "ux", "uy", "length"))
        dx, dy = x[k, a] - x0, y[k, a] - y0
        along = np.clip(dx * ux + dy * uy, 0.0, length)
        overlap = np.maximum(r[a] - np.hypot(dx - along * ux, dy - along * uy), 0.0)
        found[~pairs] = model.wall_friction.k_t * np.sqrt(overlap * r[a])
    return found
