"""Scenario -> arrays -> kernel -> Run."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine import integrate, laws
from engine.crowd import Start
from engine.errors import require
from engine.integrate import Clock, Log, Rules, advance
from engine.integrators import INTEGRATORS
from engine.interrupts import interrupts_held
from engine.neighbours import People, nobody_in_touch, nobody_near
from engine.record import Tape, blank
from engine.scenario import Scenario, turning
from engine.scene import as_arrays

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
    vx, vy : (M, N) m/s; (0, N), as spin, where only places were asked for
    spin : (M, N) rad/s
    row_size : (M,) number of contacts at each time; contacts are listed one time after the other:
    contact_i, contact_j : (contacts,) persons in touch; contact_j = -1 - w for wall w
    contact_slip : (contacts,) m, tangential spring; (0,) where only places were asked for
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
            f"speed up to {self.max_speed:.3g} m/s); shorten dt or stiffen the contacts",
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
    near, touch, tape = nobody_near(), nobody_in_touch(0), _blank_tape(scenario, rules.last_step)
    with interrupts_held() as raise_interrupt:
        for until in _looks(rules, scenario.crowd.N):
            near, touch, tape, clock = advance(
                integrator, model, scene, rules, people, near, touch, log, tape, clock, until
            )
            raise_interrupt()
            if clock.step == 0:
                _check_start(people, clock, rules)
            if clock.outcome != integrate.RUNNING:
                break
    return _run(scenario, start, log, clock, _samples(tape, scenario))


def _looks(rules: Rules, N: int) -> Iterator[int]:
    """Steps at which the kernel returns: often enough to be interrupted."""
    look_every = max(PERSON_STEPS // N, 1)
    yield 0
    yield from range(look_every, rules.last_step + look_every, look_every)


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


def _blank_tape(scenario: Scenario, steps: int) -> Tape:
    record, dt = scenario.record, scenario.numerics.dt
    return blank(round(record.every / dt), record.contacts, record.state == "whole", scenario.crowd.N, steps)


def _samples(tape: Tape, scenario: Scenario) -> Samples | None:
    """What is on the tape, without its room."""
    if not tape.stride:
        return None
    samples, contacts = tape.counts
    return Samples(
        time=tape.step[:samples] * scenario.numerics.dt,
        **{name: getattr(tape, name)[:samples] for name in ("x", "y", "vx", "vy", "spin", "row_size")},
        **{name: getattr(tape, name)[:contacts] for name in ("contact_i", "contact_j", "contact_slip")},
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
