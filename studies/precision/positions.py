"""Error of the positions before chaos, and the time that it costs."""

import itertools
from collections.abc import Iterable
from statistics import median
from typing import NamedTuple

import numpy as np

from engine import BadInput, Scenario, simulate
from engine.rooms import ROOMS
from studies.precision.clock import at, pace, spread
from studies.precision.settings import Setting, chosen, under

TIGHT = 1e-6  # N, force tolerance of references
JAMMED = 10.0  # s after which the crowd of all rooms presses at the exit
SKINS = (0.0, 0.06, 0.12, 0.25)  # m


class Case(NamedTuple):
    """A crowd, the time at which positions are compared, and what with."""

    room: str
    v_d: float  # m/s
    time: float  # s
    reference: Setting
    checks: tuple[Setting, ...]  # other references: how far they part from the first is the floor
    N: int = 200

    def __str__(self) -> str:
        """Room, desired speed and time."""
        return f"{self.room}, v_d = {self.v_d:g} m/s, t = {self.time:g} s"

    def scenario(self, seed: int = 0) -> Scenario:
        """The room that is left running beyond the time."""
        return ROOMS[self.room](v_d=self.v_d, N=self.N, seed=seed)


class Point(NamedTuple):
    """What a setting gives in a case."""

    case: Case
    setting: Setting
    errors: tuple[float, ...]  # m, one for each seed: root mean square over the persons
    cost: float  # CPU seconds per simulated second in the jam; nan: not timed

    @property
    def error(self) -> float:
        """Median over the seeds, m."""
        return median(self.errors)


class Found(NamedTuple):
    """A case: what all settings gave, the floor, and what was refused."""

    case: Case
    points: list[Point]
    floors: list[Point]  # of the other references
    skins: list[Point]  # the chosen setting with other skins
    refused: list[Setting]
    touching: float  # persons who touch somebody or a wall at the case's time, mean over the seeds

    @property
    def floor(self) -> float:
        """Error below which the reference tells nothing, m."""
        return max((point.error for point in self.floors), default=0.0)

    def at(self, setting: Setting) -> Point:
        """What a setting gave."""
        return next(point for point in self.points if point.setting == setting)


def product(integrators: Iterable[str], steps: Iterable[float], tolerances: Iterable[float]) -> list[Setting]:
    """All combinations."""
    return [Setting(*values) for values in itertools.product(integrators, steps, tolerances)]


def measure(cases: Iterable[Case], settings: list[Setting], seeds: int, stretch: float, jobs: int) -> list[Found]:
    """Errors over seeds and costs of all settings, of the chosen ones and of other skins, in all cases."""
    plans = [(case, *_allowed(case, settings)) for case in cases]
    skins = {case: [_default(case)._replace(skin=skin) for skin in SKINS] for case, _, _ in plans}
    wanted = {case: [*allowed, *case.checks, *skins[case]] for case, allowed, _ in plans}
    runs = [(case, seed, wanted[case]) for case in wanted for seed in range(seeds)]
    errors = dict(zip(((case, seed) for case, seed, _ in runs), spread(errors_of, runs, jobs), strict=True))
    times = [(case, [*allowed, *skins[case]], stretch) for case, allowed, _ in plans]
    costs = dict(zip(wanted, spread(costs_of, times, jobs), strict=True))
    found = []
    for case, allowed, refused in plans:
        of_seeds = [errors[case, seed] for seed in range(seeds)]
        points = {
            s: Point(case, s, tuple(error[s] for error in of_seeds), costs[case].get(s, float("nan")))
            for s in wanted[case]
        }
        usual, floors, others = ([points[s] for s in some] for some in (allowed, case.checks, skins[case]))
        found.append(Found(case, usual, floors, others, refused, _touching(case, seeds)))
    return found


def errors_of(case: Case, seed: int, settings: Iterable[Setting]) -> dict[Setting, float]:
    """Root mean square distance of the persons from where the reference has them at the case's time, m."""
    reference = _positions(case, seed, case.reference)
    return {setting: _apart(_positions(case, seed, setting), reference) for setting in settings}


def costs_of(case: Case, settings: Iterable[Setting], stretch: float) -> dict[Setting, float]:
    """CPU seconds per simulated second of the settings in the case's jam."""
    jam = at(case.scenario(), JAMMED)
    return {setting: pace(under(setting, jam), stretch) for setting in settings}


def _allowed(case: Case, settings: list[Setting]) -> tuple[list[Setting], list[Setting]]:
    """The settings and the chosen ones, each once: those that the laws allow, and the others."""
    allowed, refused = [], []
    for setting in dict.fromkeys([*settings, *chosen(case.room).values()]):
        try:
            under(setting, case.scenario())
            allowed.append(setting)
        except BadInput:
            refused.append(setting)
    return allowed, refused


def _default(case: Case) -> Setting:
    return next(iter(chosen(case.room).values()))


def _touching(case: Case, seeds: int) -> float:
    counts = []
    for seed in range(seeds):
        scenario = case.scenario(seed)
        samples = simulate(scenario, time_limit=case.time, record_every=case.time, contacts=True).samples
        assert samples is not None
        last = slice(samples.contact_i.size - int(samples.row_size[-1]), None)
        who = np.concatenate([samples.contact_i[last], samples.contact_j[last]])
        counts.append(np.unique(who[who >= 0]).size)
    return float(np.mean(counts))


def _positions(case: Case, seed: int, setting: Setting) -> np.ndarray:
    """Positions (2, N) at the case's time, m; nan where somebody has left."""
    scenario = under(setting, case.scenario(seed))
    run = simulate(scenario, time_limit=case.time, record_every=case.time)
    if run.samples is None or run.samples.time[-1] < 0.999 * case.time:
        return np.full((2, case.N), np.nan)  # unstable: nobody is anywhere
    return np.stack([run.samples.x[-1], run.samples.y[-1]])


def _apart(a: np.ndarray, b: np.ndarray) -> float:
    squares = ((a - b) ** 2).sum(axis=0)
    known = squares[np.isfinite(squares)]
    return float(np.sqrt(known.mean())) if known.size else float("nan")
