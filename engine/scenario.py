"""A scenario: the frozen description of one run, checked once, with a canonical text form."""

import json
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from engine import crowd as crowds
from engine import models
from engine.errors import require
from engine.kernel import laws
from engine.kernel.laws.custom import cached_by_laws, fingerprint_of, stands_outside
from engine.kernel.laws.social_force import is_repulsion
from engine.models import Model
from engine.options import Numerics, Options, longest_step, numerics_of
from engine.scene import Exit, Scene

MAX_STEPS = 1e12
DEFAULTS = Options()


@dataclass(frozen=True)
class Scenario:
    """One run: scene, crowd, model, how it is run, seed.

    Attributes
    ----------
    scene : Scene
        Walls and exits.
    crowd : Uniform or Given
        Who is there, see `Crowd`.
    model : Model
        The laws of force.
    options : Options
        How it is computed, stopped and recorded.
    seed : int
        Number of the run; random numbers follow from it.
    paper : Numerics or None
        Those of the paper that the scene is from, for `numerics="paper"`.
    numerics : Numerics
        Those that hold; they follow from the options.

    Raises
    ------
    BadInput
        If an exit is narrower than the largest person, dt is beyond what the laws allow, the sampling interval is
        shorter than dt, or any part is out of its range.
    """

    scene: Scene
    crowd: crowds.Uniform | crowds.Given
    model: Model
    options: Options = DEFAULTS
    seed: int = 0
    paper: Numerics | None = field(default=None, compare=False)
    numerics: Numerics = field(init=False)

    def __post_init__(self) -> None:
        for name, kind in PART_TYPES.items():
            good = isinstance(getattr(self, name), kind)
            wanted = getattr(kind, "__name__", "Crowd")
            require(good, name, repr(getattr(self, name)), f"is no {wanted}", f"make one with {wanted}(...)")
        whole = isinstance(self.seed, int | np.integer) and 0 <= self.seed < 2**63
        require(whole, "seed", repr(self.seed), "is not a whole number of 0 or more", "number the runs 0, 1, 2 ...")
        object.__setattr__(self, "seed", int(self.seed))
        object.__setattr__(self, "model", models.validated(self.model))
        object.__setattr__(self, "numerics", numerics_of(self.options, self.model, self.crowd, self.paper))
        _check_exits(self.scene, self.crowd.largest_radius)
        _check_step(self)
        _check_social_forces(self.model, self.numerics.force_tolerance)
        every, dt = self.options.record_every, self.numerics.dt
        remedy = "give a longer interval or a smaller dt"
        often = every == 0.0 or every >= dt * (1.0 - 1e-9)
        require(often, "record_every", f"{every:g} s", f"is shorter than the time step of {dt:g} s", remedy)

    def with_options(self, **options: Any) -> "Scenario":
        """The same scenario under some other options: `with_options(time_limit=60.0)`."""
        return replace(self, options=replace(self.options, **options))

    @property
    def law_fingerprint(self) -> str:
        """Hash of what the laws of one's own in the model compute; "" where all are the engine's."""
        return fingerprint_of(self.model)

    def to_json(self) -> str:
        """The scenario as readable JSON, from which `from_json` makes it again."""
        return json.dumps(self._described(), sort_keys=True)

    @staticmethod
    def from_json(text: str) -> "Scenario":
        """The scenario that `to_json` wrote; its numerics stand in the options."""
        return _built(json.loads(text))

    def canonical(self) -> str:
        """JSON with every float exact and every default filled in: equal for equal scenarios only."""
        return json.dumps(_exact(self._described()), sort_keys=True, separators=(",", ":"))

    def _described(self) -> dict[str, Any]:
        """All parts; the options name the numerics that hold, whatever they followed from."""
        numerics, accuracy = Options.numerics, Options.accuracy
        options = replace(self.options, numerics=numerics, accuracy=accuracy, **self.numerics._asdict())
        plain: dict[str, Any] = _plain(self)
        return plain | {"options": _plain(options)}


def _check_exits(scene: Scene, largest_radius: float) -> None:
    for line in scene.exits:
        require(
            line.width >= 2 * largest_radius * (1 - 1e-9),
            "exit width",
            f"{line.width:g} m",
            f"is narrower than the largest person ({2 * largest_radius:g} m)",
            "widen the exit or reduce the radii",
        )


def _check_step(scenario: Scenario) -> None:
    limit, cause = step_limit(scenario)
    dt, steps = scenario.numerics.dt, scenario.options.time_limit / scenario.numerics.dt
    remedy = "reduce dt, or the strength of that law, or make persons heavier"
    require(dt <= limit, "dt", f"{dt:g} s", f"is beyond the {limit:.2g} s that the {cause} allows", remedy)
    good = 1 <= steps <= MAX_STEPS
    require(good, "time_limit", f"of {steps:.3g} steps", f"is not 1 to {MAX_STEPS:.0e}", "change one of them")


@cached_by_laws
def _is_repulsion(law: tuple[Any], tolerance: float) -> bool:
    return is_repulsion(law[0], tolerance)


def _check_social_forces(model: Model, tolerance: float) -> None:
    for kind in ("social", "wall_social"):
        law = getattr(model, kind)
        remedy = "give a law that falls with the gap, or raise force_tolerance"
        is_one = _is_repulsion((law,), tolerance)
        require(is_one, kind, law, f"is no repulsion that falls below {tolerance:g} N with the gap", remedy)


def step_limit(scenario: Scenario) -> tuple[float, str]:
    """Longest step that the laws of a scenario allow, s, and what sets it."""
    return longest_step(scenario.model, scenario.crowd, scenario.numerics.integrator)


PART_TYPES: dict[str, Any] = {
    "scene": Scene,
    "crowd": crowds.Uniform | crowds.Given,
    "model": Model,
    "options": Options,
}

# --- Text form: dataclasses and laws as objects that name their type ------------------------------------

PARTS: dict[str, Any] = {
    part.__name__: part for part in (Scenario, Scene, Exit, crowds.Uniform, crowds.Given, Model, Options)
}


def _plain(part: Any) -> Any:
    if is_dataclass(part):
        return {"is": type(part).__name__} | {
            f.name: _plain(getattr(part, f.name)) for f in fields(part) if f.compare and f.init
        }
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
    """Laws by name; one of the engine's stands before others that were registered under its name."""
    kinds = [kind for call in laws.KINDS.values() for kind in call.laws]
    return {kind.__name__: kind for kind in sorted(kinds, key=stands_outside, reverse=True)}
