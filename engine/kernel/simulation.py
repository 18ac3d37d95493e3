"""Scenario -> arrays -> time loop."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from engine.kernel.integrators import INTEGRATORS
from engine.kernel.laws import has_history, inertia
from engine.kernel.laws.custom import kernel_parameters
from engine.kernel.laws.social_force import cutoff
from engine.kernel.pair_list import DOMAIN_LIMIT
from engine.kernel.placement import Start
from engine.kernel.recorder import Recorder
from engine.kernel.rest import CREEP, at_rest
from engine.kernel.scene_arrays import as_arrays
from engine.kernel.stability import allowed_overlaps
from engine.kernel.state import (
    EXIT,
    FROZEN,
    PAIRS_EACH,
    RUNNING,
    UNSTABLE,
    WALLS_EACH,
    StepParameters,
    empty_contact_list,
    empty_pair_list,
    initial_state,
    larger_pair_list,
    new_persons,
    new_scratch,
    records,
)
from engine.kernel.step import advance

PERSON_STEPS = 4_000_000  # at most between two returns from the kernel (some tenths of a second)
CHECK_INTERVAL = 1.0  # s, between two checks whether a crowd is at rest for good
QUIET_CHECKS = 5  # until rest is tested: forces that do not balance would have set somebody in motion by then


class Simulation:
    """One run under way.

    Attributes
    ----------
    persons, pairs, wall_pairs, contacts, exits, state
        See `engine.kernel.state`.
    recorder : Recorder or None
        What samples are taken, if any.
    """

    def __init__(self, scenario: Any, start: Start) -> None:
        options, model, N = scenario.options, scenario.model, start.x.size
        self._scene = as_arrays(scenario.scene)
        self._integrator = INTEGRATORS[scenario.numerics.integrator]
        self._model = type(model)(*map(kernel_parameters, model))
        self.parameters = _parameters(scenario, self._integrator)
        self.persons = new_persons(start, inertia(model.rotation, start.mass, start.radius) + np.zeros(N))
        self.pairs, self.wall_pairs = empty_pair_list(PAIRS_EACH * N), empty_pair_list(WALLS_EACH * N)
        self.contacts = empty_contact_list(self.pairs, self.wall_pairs)
        self.exits = records(N, EXIT)
        self._check_interval = max(round(CHECK_INTERVAL / self.parameters.dt), 1)
        self._checks_rest = options.stop_at_rest and self._scene.exits.size > 0
        self._quiet_checks = 0
        self._states, self._scratch = initial_state(N), new_scratch(N, len(scenario.scene.walls))
        self.recorder = (
            Recorder(
                options.record_every,
                scenario.numerics.dt,
                options.contacts,
                options.record == "full",
                (has_history(model.friction), has_history(model.wall_friction)),
                N,
            )
            if options.record_every > 0.0
            else None
        )

    @property
    def state(self) -> np.void:
        """How far the run is: a record of RUN_STATE."""
        return self._states[0]

    def advance(self) -> Iterator[np.void]:
        """Go on to the end, and yield the state every few tenths of a second."""
        for until in self._stops():
            self._advance_to(until)
            if self.recorder and self.state["step"] == self.recorder.next_step:
                self.recorder.record(self.persons, self.pairs, self.wall_pairs, self.contacts, self.state)
            if self._checks_rest and self.state["step"] % self._check_interval == 0:
                self._end_at_rest()
            yield self.state
            if self.state["outcome"] != RUNNING:
                return

    def _advance_to(self, until: int) -> None:
        while True:
            lists = self.pairs, self.wall_pairs, self.contacts, self.exits, self._scratch, self._states
            advance(self._integrator, self._model, self._scene, self.parameters, self.persons, *lists, until)
            if not self.state["room_needed"]:
                return
            self.pairs, self.wall_pairs = larger_pair_list(self.pairs), larger_pair_list(self.wall_pairs)
            self.contacts = empty_contact_list(self.pairs, self.wall_pairs)

    def _stops(self) -> Iterator[int]:
        """Steps at which the kernel returns: often enough to be interrupted, for every check and every sample."""
        longest, step, last = max(PERSON_STEPS // self.persons.x.size, 1), 0, self.parameters.last_step
        yield 0
        while step < last:
            stops = [step + longest]
            if self.recorder:
                stops.append(self.recorder.next_step)
            if self._checks_rest:
                stops.append(step - step % self._check_interval + self._check_interval)
            step = min(stops)
            yield step

    def _end_at_rest(self) -> None:
        """End the run where everybody is at rest for good."""
        state, parameters = self.state, self.parameters
        if state["outcome"] != RUNNING:
            return
        wait = (parameters.blocked_after - (state["step"] - state["last_out"])) * parameters.dt
        self._quiet_checks = self._quiet_checks + 1 if state["speed"] * wait < CREEP else 0
        arrays = self._scene.exits, self.persons, self.pairs, self.wall_pairs, self.contacts, self._states
        if self._quiet_checks >= QUIET_CHECKS and at_rest(self._model, *arrays, float(wait)):
            state["outcome"] = FROZEN

    def unstable_pair(self) -> tuple[int, int]:
        """Who made a run unstable, and the other person of that contact; -1: nobody.

        Somebody whose position is no number or far away, else who is pressed deepest, else, where nobody is pressed
        deeper than half the own radius, the fastest.
        """
        if self.state["outcome"] != UNSTABLE:
            return -1, -1
        persons, n = self.persons, int(self.state["n"])
        c = self.contacts[: self.state["contacts"]]
        ids, r = persons.person_id, persons.radius
        with np.errstate(over="ignore", invalid="ignore"):
            nowhere = ~(np.abs(persons.x[:n]) + np.abs(persons.y[:n]) < DOMAIN_LIMIT)
            if nowhere.any():
                i = int(np.argmax(nowhere))
                both = nowhere[c["i"]] & nowhere[c["j"]] & ((c["i"] == i) | (c["j"] == i))
                others = (c["i"] + c["j"])[both] - i
                return int(ids[i]), int(ids[others[0]]) if others.size else -1
            depth = c["overlap"] / np.minimum(r[c["i"]], r[c["j"]])
            if depth.size and depth.max() > 0.5:
                k = int(np.argmax(depth))
                return int(ids[c["i"][k]]), int(ids[c["j"][k]])
            return int(ids[np.argmax(persons.vx[:n] ** 2 + persons.vy[:n] ** 2)]), -1


def _parameters(scenario: Any, integrator: Any) -> StepParameters:
    options, numerics, model = scenario.options, scenario.numerics, scenario.model
    dt, tolerance = float(numerics.dt), float(numerics.force_tolerance)
    radius, mass = min(scenario.crowd.radius), min(scenario.crowd.mass)
    return StepParameters(
        dt=dt,
        cutoff=cutoff(model.social, tolerance),
        wall_cutoff=cutoff(model.wall_social, tolerance),
        force_tolerance=tolerance,
        solver_tolerance=float(numerics.solver_tolerance),
        skin=float(options.skin),
        min_radius=radius,
        allowed_overlap=allowed_overlaps(model, integrator, dt, radius, mass),
        last_step=max(math.ceil(options.time_limit / dt - 1e-9), 1),
        blocked_after=max(math.ceil(options.blocked_after / dt - 1e-9), 1),
    )
