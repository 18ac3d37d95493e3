"""What must hold in every run, whatever it was."""

import math
from typing import NamedTuple

import numpy as np

from engine import OUTCOMES, Run, simulate
from studies.stress import energy, kinds
from studies.stress.paths import crossings, deepest_overlaps

STRAY = 0.25  # of the smallest radius: how near to a wall's end the engine lets a centre come
ROUNDING = 1e-9  # m and s
MOMENTUM = 1e-9  # of the sum of all mass times speed, or of 1 kg m/s
# What the step's own error may add to the energy of a passive crowd, of that at the start, at the longest step
# allowed. It falls with the step where there is friction, and for a lossless crowd with the integrator's order; an
# integrator of first order also makes it swing while bodies are in touch. Velocity Verlet on a spring of frequency w
# conserves K + (1 - (w dt/2)^2) V, so a pair that springs apart loses (w dt/2)^2 of its energy, which is a third of
# (dt/limit)^2, since the limit is taken for three times the stiffness of one pair.
LOSSLESS_DRIFT = 1.0 / 3.0
PASSIVE_RISE = 0.3
FIRST_ORDER_SWING = 1.0
SECOND_ORDER = ("velocity_verlet", "predictor")  # without friction and damping; any other integrator: first
LEAST_ENERGY = 0.1  # J; below, rounding and the cut of the social force are seen


class Checked(NamedTuple):
    """What a run showed."""

    violations: list[str]
    overlap: float  # deepest of two persons or of a person and a wall, in smallest radii
    rise: float  # of energy, as a share of what is allowed; nan where energy was not counted


def check(run: Run, limit: float) -> Checked:
    """Hold a run against all that must be so.

    Parameters
    ----------
    limit : longest step that the engine allows for this scenario, s
    """
    said = [*_finite(run), *_ends(run), *_exits(run)]
    rise = math.nan
    if run.samples is not None:
        said += [*_sampled(run), *_walls(run), *_bodies(run)]
        rise, gains = _energy(run, limit)
        said += [*gains, *_momentum(run)]
    return Checked(said, run.max_overlap / _smallest(run), rise)


def _smallest(run: Run) -> float:
    """Smallest radius that the crowd can have, m, which the engine measures depths by."""
    return min(run.scenario.crowd.radius)


def _finite(run: Run) -> list[str]:
    """No nan, no infinity; the samples of those who are gone come in `_sampled`."""
    numbers = {name: getattr(run, name) for name in ("end_time", "max_overlap", "max_speed")}
    arrays = {name: getattr(run, name) for name in ("exit_time", "exit_x", "exit_y")} | run.start._asdict()
    bad = [name for name, value in (numbers | arrays).items() if not np.all(np.isfinite(value))]
    return [f"{name} is not finite" for name in bad]


def _ends(run: Run) -> list[str]:
    """The outcome is one of those that are named, and what it says is so."""
    options, N_out = run.scenario.options, run.N_out
    last = float(run.exit_time[-1]) if N_out else 0.0
    slack = run.scenario.numerics.dt + ROUNDING
    holds = {
        "all_out": N_out == run.N and run.end_time == last,
        "blocked": run.end_time - last >= options.blocked_after - slack and N_out < run.N,
        "time_limit": abs(run.end_time - options.time_limit) <= slack and N_out < run.N,
        "unstable": 0 <= run.unstable_person < run.N,
        "frozen": N_out < run.N,
    }
    if run.outcome not in OUTCOMES or not holds.get(run.outcome, False):
        return [f"the outcome {run.outcome} does not hold: {N_out} of {run.N} out, end {run.end_time:g} s"]
    return [] if "\n" not in str(run) else ["the outcome takes more than a line"]


def _exits(run: Run) -> list[str]:
    """Everybody leaves once, in order of time, on the line of an exit."""
    said = []
    if len(set(run.exit_person.tolist())) != run.N_out or (np.diff(run.exit_time) < 0.0).any():
        said.append("persons left twice, or not in order of time")
    for k, line in enumerate(run.scenario.scene.exits):
        here = run.exit_door == k
        along = np.subtract(line.end, line.start) / line.width
        dx, dy = run.exit_x[here] - line.start[0], run.exit_y[here] - line.start[1]
        beside, on = np.abs(along[0] * dy - along[1] * dx), along[0] * dx + along[1] * dy
        if (beside > 1e-6).any() or (on < -1e-6).any() or (on > line.width + 1e-6).any():
            said.append(f"somebody left beside exit {k}")
    return said


def _sampled(run: Run) -> list[str]:
    """All five numbers of a person are there, or none, and who is gone has left and stays away."""
    assert run.samples is not None
    s = run.samples
    there = np.isfinite(np.stack([s.x, s.y, s.vx, s.vy, s.spin]))
    said = [] if (there.all(axis=0) == there.any(axis=0)).all() else ["a sample is partly nan or infinite"]
    absent = ~there[0]
    if (absent[:-1] & ~absent[1:]).any():
        said.append("somebody who was gone came back")
    left = np.full(run.N, math.inf)
    left[run.exit_person] = run.exit_time
    if (absent & (s.time[:, None] < left - run.scenario.numerics.dt - ROUNDING)).any():
        said.append("somebody is nan without having left")
    if not np.isfinite(s.tangential_displacement).all():
        said.append("a tangential spring is not finite")
    return said


def _walls(run: Run) -> list[str]:
    """Nobody's way leads through a wall; samples far apart are taken again one step apart before that is said."""
    said = crossings(run)
    every, dt = run.scenario.options.record_every, run.scenario.numerics.dt
    if not said or run.max_speed * every < 2 * STRAY * _smallest(run) or every <= 1.5 * dt:
        return said[:1]
    return crossings(simulate(run.scenario, record_every=dt))[:1]


def _bodies(run: Run) -> list[str]:
    """Nobody is deeper in another than the smallest radius, and the run knows how deep."""
    if run.outcome == "unstable":
        return []
    deepest = float(deepest_overlaps(run).max())
    if deepest > _smallest(run):
        return [f"an overlap of {deepest:.3g} m was not called unstable"]
    if deepest > run.max_overlap + ROUNDING:
        return [f"an overlap of {deepest:.3g} m was sampled, beyond max_overlap = {run.max_overlap:.3g} m"]
    return []


def _energy(run: Run, limit: float) -> tuple[float, list[str]]:
    """Rise of the energy of a passive crowd as a share of what is allowed, and what to say of it."""
    model = run.scenario.model
    if not _counts_energy(run) or not energy.is_known(model):
        return math.nan, []
    total = energy.ledger(run).total
    if total[0] < LEAST_ENERGY:
        return math.nan, []
    allowed = _allowed(run, run.scenario.numerics.dt / limit)
    if kinds.is_lossless(model):
        share = float(np.abs(total - total[0]).max()) / total[0] / allowed
        return share, [f"energy drifts by {share:.3g} times what is allowed"] if share > 1.0 else []
    share = float((total - np.minimum.accumulate(total)).max()) / total[0] / allowed
    return share, [f"energy rises by {share:.3g} times what is allowed"] if share > 1.0 else []


def _allowed(run: Run, step: float) -> float:
    """Error of the energy that a step of this share of the limit may make, of the energy at the start."""
    if run.scenario.numerics.integrator not in SECOND_ORDER:
        return FIRST_ORDER_SWING * step
    return LOSSLESS_DRIFT * step**2 if kinds.is_lossless(run.scenario.model) else PASSIVE_RISE * step


def _counts_energy(run: Run) -> bool:
    scenario = run.scenario
    every_step = scenario.options.contacts and scenario.options.record_every <= 1.5 * scenario.numerics.dt
    return every_step and run.N_out == 0 and run.outcome != "unstable" and kinds.is_passive(scenario.model)


def _momentum(run: Run) -> list[str]:
    """Momentum stays where no wall and no drive takes it."""
    if run.scenario.scene.walls or run.N_out or run.outcome == "unstable" or not kinds.is_passive(run.scenario.model):
        return []
    assert run.samples is not None
    now = energy.momentum(run)
    speed = np.hypot(run.samples.vx, run.samples.vy)
    change = np.abs(now - now[:, :1]).max() / max(float((speed @ run.start.mass).max()), 1.0)
    return [f"momentum changes by {change:.2g} of itself"] if change > MOMENTUM else []
