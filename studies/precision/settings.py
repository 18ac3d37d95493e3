"""Settings of the numerics, and scenarios under them."""

from dataclasses import replace
from typing import NamedTuple

from engine import Numerics, Scenario
from engine.accuracy import LEVELS
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


def setting_of(numerics: Numerics) -> Setting:
    """The setting that a scenario has."""
    return Setting(numerics.integrator, numerics.dt, numerics.force_tolerance, numerics.skin)


def under(setting: Setting, scenario: Scenario) -> Scenario:
    """The scenario computed so.

    Raises
    ------
    BadInput
        If the laws do not allow the step.
    """
    numerics = Numerics(setting.dt, setting.force_tolerance, setting.skin, setting.integrator)
    return replace(scenario, numerics=numerics)


def chosen(room: str) -> dict[str, Setting]:
    """The settings that `engine.accuracy` chooses for a room, by level, and the paper's."""
    levels = {level: setting_of(ROOMS[room](accuracy=level).numerics) for level in LEVELS}
    return levels | {PAPER: setting_of(ROOMS[room](numerics=PAPER).numerics)}
