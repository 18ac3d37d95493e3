"""Settings of the numerics, and scenarios under them."""

import math
from typing import Any, NamedTuple

from engine import Scenario
from engine.options import LEVELS
from engine.rooms import ROOMS

PAPER = "paper"


class Setting(NamedTuple):
    """How a scenario is computed."""

    integrator: str
    dt: float  # s
    force_tolerance: float  # N
    skin: float = 0.0  # m; 0: adapted

    def __str__(self) -> str:
        """In one line."""
        skin = f", skin {self.skin:g} m" if self.skin else ""
        return f"{self.integrator}, {self.dt:g} s, {self.force_tolerance:g} N{skin}"


def setting_of(scenario: Scenario) -> Setting:
    """The setting that a scenario has."""
    numerics = scenario.numerics
    return Setting(numerics.integrator, numerics.dt, numerics.force_tolerance, scenario.options.skin)


def keywords_of(setting: Setting) -> dict[str, Any]:
    """As options; contacts are solved as exactly as at the level of that force tolerance."""
    exact = min(LEVELS.values(), key=lambda level: abs(math.log(level.force_tolerance / setting.force_tolerance)))
    return setting._asdict() | {"solver_tolerance": exact.solver_tolerance}


def under(setting: Setting, scenario: Scenario) -> Scenario:
    """The scenario computed so.

    Raises
    ------
    BadInput
        If the laws do not allow the step.
    """
    return scenario.with_options(**keywords_of(setting))


def chosen(room: str) -> dict[str, Setting]:
    """The settings that the accuracies choose for a room, by level, and the paper's."""
    levels = {level: setting_of(ROOMS[room](accuracy=level)) for level in LEVELS}
    return levels | {PAPER: setting_of(ROOMS[room](numerics=PAPER))}
