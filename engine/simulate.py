"""Scenario -> arrays -> kernel -> Run."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import integrate, laws
from engine.crowd import Start
from engine.errors import require
from engine.integrate import Clock, Log, Rules, advance
from engine.integrators import INTEGRATORS
from engine.interrupts import interrupts_held
from engine.neighbours import Near, People, nobody_in_touch, nobody_near
from engine.scenario import Scenario, turning
from engine.scene import SceneArrays, as_arrays

OUTCOMES = ("missing", "all_out", "blocked", "frozen", "time_limit", "unstable")  # their numbers are the kernel's
PERSON_STEPS = 4_000_000  # at most between two looks at the world outside the kernel (some tenths of a second)
LOOK = 1.0  # s, between two looks whether a crowd is at rest for good
DEEPEST_START = 0.5  # of the smallest radius: overlap that a given crowd may begin with


@dataclass(frozen=True)
class Samples:
    """The state at M sampled times; persons who have left are nan.

    Attributes
    ----------
    time : (M,) s
    x, y : (M, N) m
    vx, vy : (M, N) m/s
    spin : (M, N) rad/s
    row_size : (M,) number of contacts at each time; contacts are listed one time after the other:
    contact_i, contact_j : (contacts,) persons in touch; contact_j = -1 - w for wall w
    contact_slip : (contacts,) m, tangential spring
    """

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    spin: np.ndarray
    row_size: np.ndarray
    contact_i: np.ndarray
    contact_j: np.ndarray
    contact_slip: np.ndarray


@dataclass(frozen=True)
class Run:
    """What one run gave.

    Attributes
    ----------
    scenario : what was run
    outcome : "all_out", "blocked", "frozen", "time_limit" or "unstable"
    end_time : s
    exit_time, exit_person, exit_x, exit_y, exit_door : (N_out,) who left when (s) and where (m), in order
    start : the crowd at the start
    samples : the state along the run, if it was recorded
    max_overlap, max_speed : m, m/s
    steps, rebuilds : of the integration, of the neighbour lists
    cuts : steps that were cut into parts, because the laws did not allow them whole at that overlap or speed
    culprit, partner : the person who was pressed or thrown through others, or is nowhere, if unstable, and the
        other person of that contact, if there is one; else -1
    """

    scenario: Scenario
    outcome: str
    end_time: float
    exit_time: np.ndarray
    exit_person: np.ndarray
    exit_x: np.ndarray
    exit_y: np.ndarray
    exit_door: np.ndarray
    start: Start
    samples: Samples | None
    max_overlap: float
    max_speed: float
    steps: int
    rebuilds: int
    cuts: int
    culprit: int
    partner: int

    @property
    def N(self) -> int:
        """Persons at the start."""
        return self.start.x.size

    @property
    def N_out(self) -> int:
        """Persons who got out."""
        return self.exit_time.size

    def __str__(self) -> str:
        """The outcome in a sentence."""
        return {
            "all_out": f"all {self.N} persons were out after {self.end_time:.1f} s",
            "blocked": f"blocked: nobody got out during the last {self.scenario.stopping.patience:g} s of "
            f"{self.end_time:.1f} s; {self.N_out} of {self.N} persons were out",
            "frozen": f"frozen: at rest for good after {self.end_time:.1f} s, {self.N_out} of {self.N} out",
            "time_limit": f"stopped at the time limit of {self.end_time:g} s, {self.N_out} of {self.N} out",
            "unstable": f"unstable after {self.end_time:.4f} s: person {self.culprit} was pressed or thrown through "
            f"{f'person {self.partner}' if self.partner >= 0 else 'others'} (overlap up to {self.max_overlap:.2g} m, "
            f"speed up to {self.max_speed:.3g} m/s); shorten dt",
        }[self.outcome]


def simulate(scenario: Scenario) -> Run:
    """Run a scenario to its end.

    Returns
    -------
    Run
        Not finishing is a result: see its `outcome`.

    Raises
    ------
    BadInput
        If the crowd cannot be placed, or a given one overlaps too deeply.
    """
    scene = as_arrays(scenario.scene)
    start = scenario.crowd.draw(scenario.seed, scene.walls)
    people, model, rules = _people(scenario, start), _with_cut(scenario), _rules(scenario)
    integrator = INTEGRATORS[scenario.numerics.integrator]
    log = _empty_log(scenario.crowd.N)
    clock = integrate.begun(scenario.crowd.N)
    near, touch, recorder = nobody_near(), nobody_in_touch(0), _Recorder(scenario)
    with interrupts_held() as raise_interrupt:
        for until in recorder.looks(rules):
            near, touch, clock = advance(integrator, model, scene, rules, people, near, touch, log, clock, until)
            raise_interrupt()
            if clock.step == 0:
                _check_start(people, clock, rules)
            recorder.look(scene, people, near, clock)
            if clock.outcome != integrate.RUNNING:
                break
    return _run(scenario, start, log, clock, recorder.samples())


def _check_start(people: People, clock: Clock, rules: Rules) -> None:
    """Refuse a crowd that the first forces would blow up."""
    overlap, allowed = clock.max_overlap, DEEPEST_START * rules.deepest
    here = f"is {overlap:.3g} m deep in another or in a wall at the start (allowed: {allowed:.3g} m)"
    who = int(people.who[0]) if clock.culprit < 0 else clock.culprit
    require(overlap <= allowed, "somebody (such as person", f"{who})", here, "move the persons apart")
    lost = np.flatnonzero(~np.isfinite(people.fx[: clock.inside] + people.fy[: clock.inside]))
    remedy = "move the person off the wall"
    require(not lost.size, "person", int(lost[0]) if lost.size else "", "stands with the centre on a wall", remedy)


def _people(scenario: Scenario, start: Start) -> People:
    N = start.x.size
    rotation = scenario.model.rotation
    inertia = rotation.shape * start.mass * start.radius**2 if laws.turns(rotation) else np.full(N, math.inf)
    state: dict[str, np.ndarray] = {name: np.zeros(N) for name in People._fields}
    state |= {name: value.copy() for name, value in start._asdict().items()}
    state |= {
        "who": np.arange(N),
        "out": np.zeros(N, np.int64),
        "inertia": inertia,
        "ease": 1.0 / start.mass,
        "ease_to_turn": 1.0 / inertia,
    }
    return People(**state | {"listed_x": np.full(N, np.nan), "listed_y": np.full(N, np.nan)})  # nowhere: not listed


def _with_cut(scenario: Scenario) -> Any:
    tolerance, model = scenario.numerics.force_tolerance, scenario.model
    return model._replace(
        social=laws.cut_at(model.social, tolerance), wall_social=laws.cut_at(model.wall_social, tolerance)
    )


def _rules(scenario: Scenario) -> Rules:
    dt, model = scenario.numerics.dt, _with_cut(scenario)
    return Rules(
        dt=float(dt),
        reach=laws.reach(model.social),
        wall_reach=laws.reach(model.wall_social),
        skin=float(scenario.numerics.skin),
        deepest=min(scenario.crowd.radius),
        lightest=min(scenario.crowd.mass),
        turning=turning(model.rotation),
        last_step=max(math.ceil(scenario.stopping.time_limit / dt - 1e-9), 1),
        look=max(round(LOOK / dt), 1) if scenario.stopping.at_rest else 0,
        patience=max(math.ceil(scenario.stopping.patience / dt - 1e-9), 1),
    )


def _empty_log(N: int) -> Log:
    return Log(np.full(N, np.nan), np.full(N, -1), np.full(N, np.nan), np.full(N, np.nan), np.full(N, -1))


class _Recorder:
    """Samples a run at the times that were asked for."""

    def __init__(self, scenario: Scenario) -> None:
        self.record, self.dt, self.N = scenario.record, scenario.numerics.dt, scenario.crowd.N
        self.stride = round(self.record.every / self.dt)
        self.times: list[float] = []
        self.states: list[np.ndarray] = []
        self.contacts: list[tuple[np.ndarray, ...]] = []

    def looks(self, rules: Rules) -> Any:
        """Steps at which the kernel returns: every sample, and often enough to be interrupted."""
        yield 0
        look_every = max(PERSON_STEPS // self.N, 1)
        stride = self.stride or look_every
        for step in range(stride, rules.last_step + stride, stride):
            yield from range(step - stride + look_every, step, look_every)
            yield step

    def look(self, scene: SceneArrays, people: People, near: Near, clock: Clock) -> None:
        """Take a sample if one is due."""
        if not self.stride or clock.step % self.stride:
            return
        n = clock.inside
        state = np.full((5, self.N), np.nan)
        for row, values in enumerate((people.x, people.y, people.vx, people.vy, people.spin)):
            state[row, people.who[:n]] = values[:n]
        self.times.append(clock.step * self.dt)
        self.states.append(state)
        if self.record.contacts:
            self.contacts.append(_contacts(scene, people, near))

    def samples(self) -> Samples | None:
        """All samples, one array for each quantity."""
        if not self.stride:
            return None
        x, y, vx, vy, spin = np.stack(self.states, axis=1)
        row_size = np.array([len(found[0]) for found in self.contacts], np.int64)
        if self.contacts:
            i, j, slip = (np.concatenate(parts) for parts in zip(*self.contacts, strict=True))
        else:
            i, j, slip = np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
        return Samples(np.array(self.times), x, y, vx, vy, spin, row_size, i, j, slip)


def _contacts(scene: SceneArrays, people: People, near: Near) -> tuple[np.ndarray, ...]:
    """Who touches whom now: persons i < j, and person i with wall w as j = -1 - w."""
    i, j = near.i.astype(np.int64), near.j.astype(np.int64)
    touch = np.hypot(people.x[i] - people.x[j], people.y[i] - people.y[j]) < people.radius[i] + people.radius[j]
    wall_i, wall = near.wall_i.astype(np.int64), near.wall.astype(np.int64)
    x0, y0, ux, uy, length = scene.walls[wall].T
    dx, dy = people.x[wall_i] - x0, people.y[wall_i] - y0
    along = np.clip(dx * ux + dy * uy, 0.0, length)
    at_wall = np.hypot(dx - along * ux, dy - along * uy) < people.radius[wall_i]
    return (
        np.concatenate([people.who[i[touch]], people.who[wall_i[at_wall]]]),
        np.concatenate([people.who[j[touch]], -1 - wall[at_wall]]),
        np.concatenate([near.slip[touch], near.wall_slip[at_wall]]),
    )


def _run(scenario: Scenario, start: Start, log: Log, clock: Clock, samples: Samples | None) -> Run:
    order = np.argsort(log.time[: clock.N_out], kind="stable")
    time, person, x, y, door = (values[order] for values in log)
    outcome = OUTCOMES[clock.outcome]
    return Run(
        scenario=scenario,
        outcome=outcome,
        end_time=float(time[-1]) if outcome == "all_out" else clock.step * scenario.numerics.dt,
        exit_time=time,
        exit_person=person,
        exit_x=x,
        exit_y=y,
        exit_door=door,
        start=start,
        samples=samples,
        max_overlap=clock.max_overlap,
        max_speed=clock.max_speed,
        steps=clock.step,
        rebuilds=clock.rebuilds,
        cuts=clock.cuts,
        culprit=clock.culprit,
        partner=clock.partner,
    )
