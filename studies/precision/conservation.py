"""Drift of the energy where it is conserved: a crowd in a closed box that is not driven and loses nothing."""

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from engine import BadInput, Crowd, Run, Scenario, Scene, models, simulate
from studies.precision.clock import spread
from studies.precision.settings import Setting, under
from studies.stress.energy import ledger
from studies.stress.kinds import lossless

GASES = {"Hertz (lin_dem)": models.lin_dem(), "Hooke (parisi_dorso)": models.parisi_dorso()}
SIDE, N, SPEED = 7.0, 60, 1.0  # m, persons, m/s
EVERY = 0.05  # s
TOLERANCE = 1e-3  # N
LEAPFROG = "theta"


class Drift(NamedTuple):
    """What a setting does to the energy, as parts of it."""

    gas: str
    setting: Setting
    drift: float  # mean of the last quarter less mean of the first
    swing: float  # standard deviation in time
    outcome: str


def measure(integrators: Iterable[str], steps: Iterable[float], time: float, jobs: int) -> list[Drift]:
    """Drifts over `time` s of all integrators and steps that the laws allow."""
    steps = list(steps)
    settings = [Setting(integrator, dt, TOLERANCE) for integrator in integrators for dt in steps]
    tasks = [(name, setting, time) for name in GASES for setting in settings if _is_allowed(name, setting)]
    return spread(drift_of, tasks, jobs)


def drift_of(name: str, setting: Setting, time: float) -> Drift:
    """Run the gas and read its energies.

    The leapfrog's positions are taken back by half a step, to where its velocities stand.
    """
    scenario = under(setting, gas(name)).with_options(time_limit=time, record_every=EVERY, contacts=True)
    run = simulate(scenario)
    energy = ledger(_at_one_time(run)).total
    quarter = max(energy.size // 4, 1)
    first, last = energy[1 : 1 + quarter].mean(), energy[-quarter:].mean()
    return Drift(name, setting, float(last / first - 1.0), float(energy[1:].std() / first), run.outcome)


def _at_one_time(run: Run) -> Run:
    samples, dt = run.samples, run.scenario.numerics.dt
    if samples is None or run.scenario.numerics.integrator != LEAPFROG:
        return run
    before = samples._replace(x=samples.x - 0.5 * dt * samples.vx, y=samples.y - 0.5 * dt * samples.vy)
    return replace(run, samples=before)


def gas(name: str) -> Scenario:
    """The passive crowd in its box."""
    crowd = Crowd.uniform(N, (0.0, SIDE, 0.0, SIDE), radius=(0.25, 0.35), mass=(60.0, 80.0), v_d=0.0, speed=SPEED)
    return Scenario(Scene.box(SIDE, SIDE), crowd, lossless(GASES[name]), seed=1)


def _is_allowed(name: str, setting: Setting) -> bool:
    try:
        under(setting, gas(name))
    except BadInput:
        return False
    return True
