"""Samples of a run, taken at the steps nearest to the asked times; they never change the run."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from engine.kernel.state import PairList, Persons

PERSON_VALUES = ("x", "y", "vx", "vy", "spin")
POSITIONS = 2  # of these, which are recorded in any case


class Samples(NamedTuple):
    """The state at M sampled times; persons who have left are nan.

    Attributes
    ----------
    time : (M,) float
        s, each that of a step.
    x, y : (M, N) float
        m.
    vx, vy, spin : (M, N) float
        m/s, rad/s; (0, N) where only positions were asked for.
    row_size : (M,) int
        Number of contacts at each time; contacts are listed one time after the other.
    contact_i, contact_j : (contacts,) int
        Persons in contact; contact_j = -1 - w for wall w.
    tangential_displacement : (contacts,) float
        m, of the spring; (0,), as the next two, where only positions were asked for.
    contact_F_n, contact_F_t : (contacts,) float
        N, on person i, along n (from the other body to i) and along t = (-n_y, n_x).
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
    tangential_displacement: np.ndarray
    contact_F_n: np.ndarray
    contact_F_t: np.ndarray


@dataclass
class Recorder:
    """Takes samples every so many seconds.

    Attributes
    ----------
    every, dt : float
        Sampling interval and time step, s.
    contacts : bool
        Whether also who is in contact.
    full : bool
        Whether also velocities, spins, springs and forces.
    have_springs : (bool, bool)
        Whether friction between persons, and that at walls, is a spring.
    N : int
        Persons at the start.
    """

    every: float
    dt: float
    contacts: bool
    full: bool
    have_springs: tuple[bool, bool]
    N: int
    steps: list[int] = field(default_factory=list)
    rows: dict[str, list[np.ndarray]] = field(default_factory=lambda: {name: [] for name in Samples._fields})

    @property
    def next_step(self) -> int:
        """Step of the next sample."""
        return round(len(self.steps) * self.every / self.dt)

    def record(
        self, persons: Persons, pairs: PairList, wall_pairs: PairList, contacts: np.ndarray, state: np.void
    ) -> None:
        """Take a sample of the present state."""
        n = int(state["n"])
        for name in PERSON_VALUES if self.full else PERSON_VALUES[:POSITIONS]:
            values = np.full(self.N, np.nan)
            values[persons.person_id[:n]] = getattr(persons, name)[:n]
            self.rows[name].append(values)
        self.steps.append(int(state["step"]))
        between, every = int(state["contacts"]), int(state["contacts"] + state["wall_contacts"])
        c = contacts[: every if self.contacts else 0]
        self.rows["row_size"].append(np.array([c.size], np.int32))
        i, j = persons.person_id[c["i"]], np.where(c["wall"] < 0, persons.person_id[c["j"]], -1 - c["wall"])
        values_of = {"contact_i": i.astype(np.int32), "contact_j": j.astype(np.int32)}
        if self.full:
            springs = pairs.history[c["entry"][:between]], wall_pairs.history[c["entry"][between:]]
            displacement = [a * has_spring for a, has_spring in zip(springs, self.have_springs, strict=True)]
            values_of |= {"tangential_displacement": np.concatenate(displacement)}
            values_of |= {"contact_F_n": c["F_n"].copy(), "contact_F_t": c["F_t"].copy()}
        for name, of_contacts in values_of.items():
            self.rows[name].append(of_contacts)

    def samples(self) -> Samples:
        """All samples so far."""
        rows = {name: np.concatenate(values) if values else np.empty(0) for name, values in self.rows.items()}
        rows |= {name: rows[name].reshape(-1, self.N) for name in PERSON_VALUES}
        rows["time"] = np.array(self.steps, np.int64) * self.dt
        return Samples(**rows)
