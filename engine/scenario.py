"""A scenario: the frozen description of one run, checked once, with a canonical text form."""

import json
import math
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

from engine import crowd as crowds
from engine import laws, models
from engine.errors import number, require
from engine.integrators import INTEGRATORS, settles, share
from engine.models import Model
from engine.scene import Exit, Scene
from engine.stability import CAUSES, plain_step_limits

MOST_STEPS = 1e12
STATES = ("whole", "places")  # what of each person is recorded
ASSUMED_OVERLAP = 0.2  # of the smallest radius: what the step must be able to follow


def _make_positive(part: Any, remedy: str, may_be_zero: tuple[str, ...] = ()) -> None:
    """Turn all fields of a frozen dataclass into floats above 0, so that 120 and 120.0 are one scenario."""
    for field in (field for field in fields(part) if field.type is float):
        value = number(field.name, getattr(part, field.name), remedy)
        good = value > 0 or (value == 0 and field.name in may_be_zero)
        require(good, field.name, value, "is not finite and positive", remedy)
        object.__setattr__(part, field.name, value)


@dataclass(frozen=True)
class Numerics:
    """How a run is computed.

    Attributes
    ----------
    dt : time step, s
    force_tolerance : the social force ends, without a jump, where it has fallen to this, N
    integrator : "velocity_verlet" (as the papers print it), "predictor" (second order) or "semi_implicit" (long steps),
        see `engine.integrators`
    skin : how much farther than they reach pairs are listed, m; 0: adapted to how fast people move, for speed
        (changes a run by rounding only)
    """

    dt: float = 1e-3
    force_tolerance: float = 1e-3
    skin: float = 0.0
    integrator: str = "velocity_verlet"

    def __post_init__(self) -> None:
        _make_positive(self, "give a value above 0", may_be_zero=("skin",))
        known = ", ".join(INTEGRATORS)
        require(
            self.integrator in INTEGRATORS,
            "integrator",
            repr(self.integrator),
            "is not known",
            f"choose one of {known}",
        )


@dataclass(frozen=True)
class Stopping:
    """When a run ends before everybody is out.

    Attributes
    ----------
    patience : time without anybody getting out after which the exits count as blocked, s
    time_limit : s
    at_rest : end a run as frozen as soon as it is certain that nobody will get out in time (see `engine.rest`)
    """

    patience: float = 120.0
    time_limit: float = 1000.0
    at_rest: bool = True

    def __post_init__(self) -> None:
        _make_positive(self, "give a time above 0 s")
        require(isinstance(self.at_rest, bool), "at_rest", repr(self.at_rest), "is not true or false", "give one")


@dataclass(frozen=True)
class Record:
    """What is sampled along a run besides the exits.

    Attributes
    ----------
    every : sampling interval, a multiple of dt, s; 0 for no samples
    contacts : also who touches whom
    state : "whole": places, velocities, spins, and the springs of the contacts; or "places" alone, which keeps files
        small (a file has them to 1 mm) and is all that measures of contacts need
    """

    every: float = 0.0
    contacts: bool = False
    state: str = "whole"

    def __post_init__(self) -> None:
        good = isinstance(self.every, int | float | np.number) and math.isfinite(self.every) and self.every >= 0
        require(good, "record every", self.every, "is not a time of 0 s or more", "give a sampling interval")
        object.__setattr__(self, "every", float(self.every))
        wanted = self.every > 0 or not self.contacts
        require(wanted, "record contacts", "without `every`", "has no times to record at", "give a sampling interval")
        known = f"choose one of {', '.join(STATES)}"
        require(self.state in STATES, "record state", repr(self.state), "is not known", known)
        object.__setattr__(self, "contacts", bool(self.contacts))


@dataclass(frozen=True)
class Scenario:
    """One run: scene, crowd, model, numerics, stopping, record, seed.

    Raises
    ------
    BadInput
        If an exit is narrower than the largest person, dt is beyond what the laws allow,
        the sampling interval is no multiple of dt, or any part is out of its range.
    """

    scene: Scene
    crowd: crowds.Uniform | crowds.Given
    model: Model
    numerics: Numerics = Numerics()
    stopping: Stopping = Stopping()
    record: Record = Record()
    seed: int = 0

    def __post_init__(self) -> None:
        for name, kind in PART_TYPES.items():
            good = isinstance(getattr(self, name), kind)
            wanted = getattr(kind, "__name__", "Crowd")
            require(good, name, repr(getattr(self, name)), f"is no {wanted}", f"make one with {wanted}(...)")
        whole = isinstance(self.seed, int | np.integer) and 0 <= self.seed < 2**63
        require(whole, "seed", repr(self.seed), "is not a whole number of 0 or more", "number the runs 0, 1, 2 ...")
        object.__setattr__(self, "seed", int(self.seed))
        object.__setattr__(self, "model", models.checked(self.model))
        _check_exits(self.scene, self.crowd.largest_radius)
        _check_step(self)
        _check_sampling(self.record, self.numerics)

    def to_json(self) -> str:
        """The scenario as readable JSON, from which `from_json` makes it again."""
        return json.dumps(_plain(self), sort_keys=True)

    @staticmethod
    def from_json(text: str) -> "Scenario":
        """The scenario that `to_json` wrote."""
        return _built(json.loads(text))

    def canonical(self) -> str:
        """JSON with every float exact and every default filled in: equal for equal scenarios only."""
        return json.dumps(_exact(_plain(self)), sort_keys=True, separators=(",", ":"))


def _check_exits(scene: Scene, largest_radius: float) -> None:
    for line in scene.exits:
        require(
            line.width >= 2 * largest_radius * (1 - 1e-9),
            "exit width",
            f"{line.width:g} m",
            f"is narrower than the largest person ({2 * largest_radius:g} m)",
            "widen the exit or reduce the radii",
        )


def _check_sampling(record: Record, numerics: Numerics) -> None:
    steps = record.every / numerics.dt
    fits = abs(steps - round(steps)) <= 1e-6 * max(steps, 1.0)
    require(fits, "record every", f"{record.every} s", f"is no multiple of dt = {numerics.dt} s", "change one of them")


def _check_step(scenario: Scenario) -> None:
    limit, cause = step_limit(scenario)
    dt, steps = scenario.numerics.dt, scenario.stopping.time_limit / scenario.numerics.dt
    remedy = "reduce dt, or the strength of that law, or make persons heavier"
    require(dt <= limit, "dt", f"{dt:g} s", f"is beyond the {limit:.2g} s that the {cause} allows", remedy)
    remedy = "change one of them"
    require(1 <= steps <= MOST_STEPS, "time_limit", f"of {steps:.3g} steps", f"is not 1 to {MOST_STEPS:.0e}", remedy)


def step_limit(scenario: Scenario) -> tuple[float, str]:
    """Longest step that the laws of a scenario allow, s, and what sets it."""
    return longest_step(scenario.model, scenario.crowd, scenario.numerics.integrator)


def longest_step(model: Model, crowd: crowds.Uniform | crowds.Given, integrator: str) -> tuple[float, str]:
    """Longest step that the laws allow at a fifth of the smallest radius of overlap, s, and what sets it."""
    radius, mass = min(crowd.radius), min(crowd.mass)
    method, easier = INTEGRATORS[integrator], turning(model.rotation)
    overlap = ASSUMED_OVERLAP * radius
    limits = plain_step_limits(model, share(method), settles(method), overlap, radius, mass, easier)
    return min(zip(limits, CAUSES, strict=True))


def turning(rotation: Any) -> float:
    """How much easier a surface is to move than its body, which also turns: 1 + mass radius^2/inertia."""
    return 1.0 + 1.0 / rotation.shape if laws.turns(rotation) else 1.0


PART_TYPES: dict[str, Any] = {
    "scene": Scene,
    "crowd": crowds.Uniform | crowds.Given,
    "model": Model,
    "numerics": Numerics,
    "stopping": Stopping,
    "record": Record,
}

# --- Text form: dataclasses and laws as objects that name their type ------------------------------------

PARTS: dict[str, Any] = {
    part.__name__: part
    for part in (Scenario, Scene, Exit, crowds.Uniform, crowds.Given, Model, Numerics, Stopping, Record)
}


def _plain(part: Any) -> Any:
    if is_dataclass(part):
        return {"is": type(part).__name__} | {f.name: _plain(getattr(part, f.name)) for f in fields(part)}
    if hasattr(part, "_asdict"):
        return {"is": type(part).__name__} | {name: _plain(value) for name, value in part._asdict().items()}
    if isinstance(part, tuple):
        return [_plain(value) for value in part]
    return part.item() if isinstance(part, np.generic) else part


def _exact(plain: Any) -> Any:
    if isinstance(plain, dict):
        return {name: _exact(value) for name, value in plain.items()}
    if isinstance(plain, list):
        return [_exact(value) for value in plain]
    return plain.hex() if isinstance(plain, float) else plain


def _built(plain: Any) -> Any:
    if isinstance(plain, list):
        return tuple(map(_built, plain))
    if not isinstance(plain, dict):
        return plain
    name = plain.pop("is")
    known: dict[str, Any] = PARTS | _laws()
    require(name in known, "scenario part", repr(name), "is not known", "import the module that registers this law")
    return known[name](**{field: _built(value) for field, value in plain.items()})


def _laws() -> dict[str, type[NamedTuple]]:
    return {p.__name__: p for generics in laws.KINDS.values() for p in generics[0].laws}
