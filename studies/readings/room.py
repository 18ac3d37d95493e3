"""The readings that are compared: the engine's eight, and what the paper's text leaves open besides."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

from engine import Scenario, rooms
from engine.accuracy import numerics_for
from engine.errors import require
from engine.laws import Absent, Exponential
from engine.models import Model

DEFAULT = "RK"


class Reading(NamedTuple):
    """A way to read the paper: keywords of `lin_room`, and a change of the model that no keyword makes."""

    text: str
    keywords: dict[str, Any]
    change: Callable[[Model], Model] | None = None


def _no_wall_push(model: Model) -> Model:
    return model._replace(wall_social=Absent())


def _kinetic_everywhere(model: Model) -> Model:
    return model._replace(sliding=model.wall_sliding)


def _wall_held(model: Model) -> Model:
    return model._replace(wall_social=Exponential(300.0, model.social.B))


READINGS: dict[str, Reading] = {
    "RK": Reading("persons: spring reset on slip; walls: kinetic, tanh", {"reading": "RK"}),
    "RS": Reading("persons: spring reset; walls: kinetic, sign", {"reading": "RS"}),
    "W": Reading("both: spring kept at the Coulomb limit", {"reading": "W"}),
    "W01": Reading("as W, walls with mu = 0.1", {"reading": "W01"}),
    "R02": Reading("both: spring reset, walls with mu = 0.2", {"reading": "R02"}),
    "WK": Reading("persons: spring kept; walls: kinetic, tanh", {"reading": "WK"}),
    "WR": Reading("both: spring reset", {"reading": "WR"}),
    "B": Reading("as W, walls do not push socially", {"reading": "B"}),
    "RK-iso": Reading("as RK, social force the same all round (phi = 0)", {"reading": "RK", "phi": 0.0}),
    "RK-disc": Reading("as RK, inertia of a disc (0.5 m r^2)", {"reading": "RK", "inertia": "disc"}),
    "RK-wall": Reading("as RK, walls do not push socially", {"reading": "RK"}, _no_wall_push),
    "RK-A": Reading("as RK, walls push with A = 300 N whatever A is", {"reading": "RK"}, _wall_held),
    "RK-dt": Reading("as RK, the paper's step and integrator", {"reading": "RK", "numerics": "paper"}),
    "KK": Reading("both: kinetic, tanh, no springs", {"reading": "RK"}, _kinetic_everywhere),
}


def reading_room(reading: str, v_d: float, N: int, seed: int, A: float = 300.0, turning: bool = True) -> Scenario:
    """The room of Lin, Ma & Lo (2016) under one of `READINGS`.

    Parameters
    ----------
    reading : a key of `READINGS`
    v_d : desired speed of everybody, m/s
    N : number of persons
    seed : number of the run; the same seed means the same bodies and places in all readings
    A : strength of the social force, N
    turning : whether people turn (Fig. 5 has runs in which they do not)

    Raises
    ------
    BadInput
        If the reading is not known, or `lin_room` refuses a parameter.
    """
    require(reading in READINGS, "reading", repr(reading), "is not known", f"choose one of {', '.join(READINGS)}")
    _, keywords, change = READINGS[reading]
    still = {} if turning else {"inertia": "none"}
    scenario = rooms.lin_room(v_d=v_d, N=N, seed=seed, A=A, **(keywords | still))
    if change is None:
        return scenario
    model = change(scenario.model)
    numerics = numerics_for("accurate", "2%", model, scenario.crowd, rooms.LIN_2016)
    return replace(scenario, model=model, numerics=numerics)
