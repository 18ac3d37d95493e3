"""Settings of the numerics, and scenarios under them."""

from typing import NamedTuple

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


def under(setting: Setting, scenario: Scenario) -> Scenario:
    """The scenario computed so.

    Raises
    ------
    BadInput
        If the laws do not allow the step.
    """
    return scenario.with_options(**setting._asdict())


def chosen(room: str) -> dict[str, Setting]:
    """The settings that the accuracies choose for a room, by level, and the paper's."""
    levels = {level: setting_of(ROOMS[room](accuracy=level)) for level in LEVELS}
    return levels | {PAPER: setting_of(ROOMS[room](numerics=PAPER))}
