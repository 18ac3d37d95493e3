"""Options of a run: how any scenario is computed, stopped and recorded."""

import functools
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, TypeVar, get_type_hints

from engine.errors import number, require
from engine.kernel.integrators import INTEGRATORS
from engine.kernel.laws.custom import cached_by_laws
from engine.kernel.stability import CAUSES, step_limits

Made = TypeVar("Made")
RECORDS = ("full", "positions")  # what of each person is recorded
ASSUMED_OVERLAP = 0.2  # of the smallest radius: what the step must be able to follow
STABLE = 0.75  # of the longest stable step: what is taken of it


class Numerics(NamedTuple):
    """How the equations of motion are solved.

    Attributes
    ----------
    dt : float
        Time step, s.
    force_tolerance : float
        The social force ends, without a jump, where it has fallen to this, N.
    integrator : str
        "velocity_verlet" (as the papers print it), "predictor" (second order) or "theta" (second order, long steps),
        see `engine.kernel.integrators`.
    solver_tolerance : float
        Change of a velocity at which "theta" counts its contacts as solved, m/s.
    """

    dt: float
    force_tolerance: float
    integrator: str
    solver_tolerance: float = 1e-3


class Level(NamedTuple):
    """How an accuracy is reached."""

    integrator: str
    longest_step: float  # s
    force_tolerance: float  # N
    solver_tolerance: float  # m/s


LEVELS = {
    "2%": Level("theta", 8e-3, 0.3, 1e-3),
    "1mm": Level("theta", 5e-3, 1e-2, 1e-4),
    "0.1mm": Level("theta", 1e-3, 1e-3, 1e-5),
}
ACCURATE, PAPER = "accurate", "paper"


@dataclass(frozen=True)
class Options:
    """How a run is computed, stopped and recorded; every room has these keywords besides its own.

    Attributes
    ----------
    numerics : str
        "accurate" for those that follow from `accuracy`, "paper" for those of the paper that a room is from.
    accuracy : str
        Error that is tolerated: "2%", bias of the statistics (mean clearance time, blocked fraction, mean delay);
        "1mm" or "0.1mm", root mean square error of the positions before chaos. `make study-accuracy` measures what
        they leave.
    dt, force_tolerance, integrator, solver_tolerance : float, float, str, float or None
        Where given they hold instead, see `Numerics` (s, N, m/s).
    skin : float
        How much farther than they interact pairs are listed, m; 0: adapted to how fast people move, for speed (changes
        a run by rounding only).
    blocked_after : float
        Time without anybody getting out after which the exits count as blocked, s.
    time_limit : float
        Time at which a run is ended, s.
    stop_at_rest : bool
        End a run as frozen as soon as it is certain that nobody will get out in time (`engine.kernel.rest`).
    record_every : float
        Sampling interval, s; 0 for no samples. Samples are taken at the nearest steps, whose times they carry, and
        never change the run.
    contacts : bool
        Record also who is in contact, and with what force.
    record : str
        "full": positions, velocities, spins, and springs and forces of the contacts; or "positions" alone, which keeps
        files small (a file has them to 1 mm) and is all that measures of contacts need.

    Raises
    ------
    BadInput
        If a value is out of its range or not known.
    """

    numerics: str = ACCURATE
    accuracy: str = "2%"
    dt: float | None = None
    force_tolerance: float | None = None
    integrator: str | None = None
    solver_tolerance: float | None = None
    skin: float = 0.0
    blocked_after: float = 120.0
    time_limit: float = 1000.0
    stop_at_rest: bool = True
    record_every: float = 0.0
    contacts: bool = False
    record: str = "full"

    def __post_init__(self) -> None:
        _be_a_word(self, "numerics", (ACCURATE, PAPER))
        _be_a_word(self, "accuracy", tuple(LEVELS))
        _be_a_word(self, "record", RECORDS)
        if self.integrator is not None:
            _be_a_word(self, "integrator", tuple(INTEGRATORS))
        for name in ("dt", "force_tolerance", "solver_tolerance", "blocked_after", "time_limit"):
            _be_a_number(self, name, may_be_zero=False)
        for name in ("skin", "record_every"):
            _be_a_number(self, name, may_be_zero=True)
        for name in ("stop_at_rest", "contacts"):
            value = getattr(self, name)
            require(isinstance(value, bool), name, repr(value), "is not true or false", "give one of them")
        wanted = self.record_every > 0 or not self.contacts
        require(wanted, "contacts", "without record_every", "have no times to record at", "give a sampling interval")


def _be_a_word(options: Options, name: str, known: tuple[str, ...]) -> None:
    value = getattr(options, name)
    require(value in known, name, repr(value), "is not known", f"choose one of {', '.join(known)}")


def _be_a_number(options: Options, name: str, may_be_zero: bool) -> None:
    """Turn a value into a float, so that 120 and 120.0 are one option."""
    given, remedy = getattr(options, name), "give a value of 0 or more" if may_be_zero else "give a value above 0"
    if given is None:
        return
    value = number(name, given, remedy)
    good = value > 0 or (value == 0 and may_be_zero)
    require(good, name, value, f"is not finite and {'not negative' if may_be_zero else 'positive'}", remedy)
    object.__setattr__(options, name, value)


def numerics_of(options: Options, model: Any, crowd: Any, paper: Numerics | None) -> Numerics:
    """Step, force tolerance and integrator of a scenario, from the accuracy where they are not given.

    A given integrator without a step takes that of the accuracy, or what is stable of it.

    Raises
    ------
    BadInput
        If the paper's numerics are wanted of a room that is from none.
    """
    if options.numerics == PAPER:
        known = "are not known for this room"
        require(paper is not None, "numerics", "'paper'", known, "choose 'accurate', or give dt and integrator")
        assert paper is not None
        dt, tolerance, integrator, solver_tolerance = paper
    else:
        level = LEVELS[options.accuracy]
        integrator, tolerance = options.integrator or level.integrator, level.force_tolerance
        solver_tolerance = level.solver_tolerance
        dt = _round_down(min(STABLE * longest_step(model, crowd, integrator)[0], level.longest_step))
    return Numerics(
        dt if options.dt is None else options.dt,
        tolerance if options.force_tolerance is None else options.force_tolerance,
        options.integrator or integrator,
        options.solver_tolerance or solver_tolerance,
    )


def longest_step(model: Any, crowd: Any, integrator: str) -> tuple[float, str]:
    """Longest step that the laws allow at a fifth of the smallest radius of overlap, s, and what sets it."""
    longest: tuple[float, str] = _longest_step(model, integrator, min(crowd.radius), min(crowd.mass))
    return longest


@cached_by_laws
def _longest_step(model: Any, integrator: str, radius: float, mass: float) -> tuple[float, str]:
    limits = step_limits(model, INTEGRATORS[integrator], ASSUMED_OVERLAP * radius, radius, mass)
    return min(zip(limits, CAUSES, strict=True))


def _round_down(step: float) -> float:
    """The largest of 1, 2, 4, 5, 8 times a power of ten, which divide a second, that is not above."""
    power = 10.0 ** math.floor(math.log10(step) + 1e-9)
    return float(f"{max(m for m in (1, 2, 4, 5, 8) if m * power <= step * (1 + 1e-9)) * power:.1g}")


def with_options(room: Callable[..., Made]) -> Callable[..., Made]:
    """Give a room the options as keywords, besides its own; one of the same name stays the room's.

    @with_options
    def my_room(v_d: float = 1.0, N: int = 50, seed: int = 0) -> Scenario: ...
    my_room(N=20, time_limit=60.0)
    """
    if getattr(room, "has_options", False):
        return room
    own = inspect.signature(room)
    keyword = inspect.Parameter.KEYWORD_ONLY
    added = [
        inspect.Parameter(field.name, keyword, default=field.default)
        for field in fields(Options)
        if field.name not in own.parameters
    ]

    @functools.wraps(room)
    def wrapped(*args: Any, **keywords: Any) -> Any:
        given = {p.name: keywords.pop(p.name) for p in added if p.name in keywords}
        scenario: Any = room(*args, **keywords)
        return scenario.with_options(**given) if given else scenario

    parameters = sorted([*own.parameters.values(), *added], key=lambda p: p.kind)  # "**keywords" come last
    wrapped.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
    hints = get_type_hints(Options)
    wrapped.__annotations__ = {**get_type_hints(room), **{p.name: hints[p.name] for p in added}}
    wrapped.has_options = True  # type: ignore[attr-defined]  # so that it is not wrapped again
    return wrapped
