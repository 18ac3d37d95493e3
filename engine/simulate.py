"""Run a scenario."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba.core import event

from engine.errors import require
from engine.interrupts import interrupts_held
from engine.kernel.placement import Start
from engine.kernel.recorder import Samples
from engine.kernel.scene_arrays import as_arrays
from engine.kernel.simulation import Simulation
from engine.kernel.step import advance
from engine.scenario import Scenario

OUTCOMES = ("missing", "all_out", "blocked", "frozen", "time_limit", "unstable")  # their numbers are the kernel's
DEEPEST_START = 0.5  # of the smallest radius: overlap that a given crowd may begin with

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Run:
    """Result of one run.

    Attributes
    ----------
    scenario : Scenario
        What was run.
    outcome : str
        "all_out", "blocked", "frozen", "time_limit" or "unstable".
    end_time : float
        s.
    exit_time, exit_person, exit_x, exit_y, exit_door : (N_out,) arrays
        Who left when (s), where (m) and by which exit, in order.
    start : Start
        The crowd at the start.
    samples : Samples or None
        The state along the run, if it was recorded.
    max_overlap, max_speed : float
        m, m/s.
    steps, rebuilds : int
        Of the integration, of the neighbour lists.
    substepped_steps : int
        Steps that were cut into substeps, because the laws did not allow them whole at that overlap or speed.
    unstable_person, unstable_partner : int
        The person who was pressed or thrown through others, or is nowhere, if unstable, and the other person of that
        contact, if there is one; else -1.
    contact_sums : (2, 4) float
        Sums over all contacts between persons (0), at walls (1), and all steps: impulses of friction and of normal
        forces, N s, and each times the slip speed, N m; the third is the energy that friction took, J.
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
    substepped_steps: int
    unstable_person: int
    unstable_partner: int
    contact_sums: np.ndarray

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
        partner = f"person {self.unstable_partner}" if self.unstable_partner >= 0 else "others"
        return {
            "all_out": f"all {self.N} persons were out after {self.end_time:.1f} s",
            "blocked": f"blocked: nobody got out during the last {self.scenario.options.blocked_after:g} s of "
            f"{self.end_time:.1f} s; {self.N_out} of {self.N} persons were out",
            "frozen": f"frozen: at rest for good after {self.end_time:.1f} s, {self.N_out} of {self.N} out",
            "time_limit": f"stopped at the time limit of {self.end_time:g} s, {self.N_out} of {self.N} out",
            "unstable": f"unstable after {self.end_time:.4f} s: person {self.unstable_person} was pressed or thrown "
            f"through {partner} (overlap up to {self.max_overlap:.2g} m, speed up to "
            f"{self.max_speed:.3g} m/s); shorten dt or stiffen the contacts",
        }[self.outcome]


def simulate(scenario: Scenario, **options: Any) -> Run:
    """Run a scenario to its end.

    Parameters
    ----------
    scenario : Scenario
        What to run.
    options
        Some of `Options`, which hold instead of the scenario's: `simulate(scenario, time_limit=60.0)`.

    Returns
    -------
    Run
        Not finishing is a result: see its `outcome`.

    Raises
    ------
    BadInput
        If the crowd cannot be placed, or a given one overlaps too deeply.
    """
    scenario = scenario.with_options(**options) if options else scenario
    start = scenario.crowd.draw(scenario.seed, as_arrays(scenario.scene).walls)
    simulation = Simulation(scenario, start)
    with interrupts_held() as raise_interrupt, compilation_said():
        for state in simulation.advance():
            raise_interrupt()
            if state["step"] == 0:
                _check_start(simulation)
    return _run(scenario, start, simulation)


@contextmanager
def compilation_said() -> Iterator[None]:
    """Say it when the kernel is compiled in this block."""
    listener = _Compilation()
    event.register("numba:compile", listener)
    try:
        yield
    finally:
        event.unregister("numba:compile", listener)


class _Compilation(event.Listener):
    """Hears numba compile the kernel."""

    def on_start(self, compilation: event.Event) -> None:
        """Say that it begins."""
        if compilation.data["dispatcher"] is advance:
            log.warning("compiling the kernel for these laws: some ten seconds, once on this machine")

    def on_end(self, compilation: event.Event) -> None:
        """Say nothing when it ends."""


def _check_start(simulation: Simulation) -> None:
    """Refuse a crowd that the first forces would blow up."""
    persons, state, radius = simulation.persons, simulation.state, simulation.parameters.min_radius
    overlap, allowed = float(state["max_overlap"]), DEEPEST_START * radius
    here = f"is {overlap:.3g} m deep in another or in a wall at the start (allowed: {allowed:.3g} m)"
    who, _ = simulation.unstable_pair()
    who = int(persons.person_id[0]) if who < 0 else who
    require(overlap <= allowed, "somebody (such as person", f"{who})", here, "move the persons apart")
    n = state["n"]
    lost = np.flatnonzero(~np.isfinite(persons.fx[:n] + persons.fy[:n]))
    remedy = "move the person off the wall"
    require(not lost.size, "person", int(lost[0]) if lost.size else "", "stands with the centre on a wall", remedy)


def _run(scenario: Scenario, start: Start, simulation: Simulation) -> Run:
    state = simulation.state
    exits = simulation.exits[: state["N_out"]]
    exits = exits[np.argsort(exits["time"], kind="stable")]
    outcome = OUTCOMES[state["outcome"]]
    unstable_person, unstable_partner = simulation.unstable_pair()
    return Run(
        scenario=scenario,
        outcome=outcome,
        end_time=float(exits["time"][-1]) if outcome == "all_out" else int(state["step"]) * scenario.numerics.dt,
        exit_time=exits["time"].copy(),
        exit_person=exits["person"].copy(),
        exit_x=exits["x"].copy(),
        exit_y=exits["y"].copy(),
        exit_door=exits["exit"].copy(),
        start=start,
        samples=simulation.recorder.samples() if simulation.recorder else None,
        max_overlap=float(state["max_overlap"]),
        max_speed=float(state["max_speed"]),
        steps=int(state["step"]),
        rebuilds=int(state["rebuilds"]),
        substepped_steps=int(state["substepped_steps"]),
        unstable_person=unstable_person,
        unstable_partner=unstable_partner,
        contact_sums=state["contact_sums"].copy(),
    )
