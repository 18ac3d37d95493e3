"""The levels of `engine.options`: what they choose, what error that makes, what time it saves."""

from collections.abc import Iterable
from statistics import median
from typing import NamedTuple

from engine import Scenario
from engine.options import LEVELS
from engine.rooms import ROOMS
from studies.precision import positions
from studies.precision.clock import compile_kernel, timed
from studies.precision.settings import PAPER, Setting, chosen

STATISTICS = "2%"  # the level that is about statistics
PROMISED = {"1mm": 1e-3, "0.1mm": 1e-4}  # m


class Level(NamedTuple):
    """A level of a room beside the paper's numerics."""

    room: str
    name: str
    setting: Setting
    errors: list[tuple[positions.Case, float, float]]  # median error and the floor of the case, m
    saved: list[float]  # CPU time in the jam of the paper's numerics over its own, one for each case

    @property
    def promise(self) -> str:
        """Whether the errors are below what the level says."""
        if self.name not in PROMISED:
            return "see the statistics" if self.name == STATISTICS else ""
        wrong = [error for _, error, floor in self.errors if max(error, floor) > PROMISED[self.name]]
        return "kept" if not wrong else f"NOT kept in {len(wrong)} of {len(self.errors)} cases"


def levels(found: Iterable[positions.Found]) -> list[Level]:
    """All levels and the paper's numerics, for all rooms that were measured."""
    found = list(found)
    rooms = dict.fromkeys(f.case.room for f in found)
    return [_level(room, name, found) for room in rooms for name in (*LEVELS, PAPER)]


def _level(room: str, name: str, found: list[positions.Found]) -> Level:
    setting, paper = chosen(room)[name], chosen(room)[PAPER]
    here = [f for f in found if f.case.room == room]
    errors = [(f.case, f.at(setting).error, f.floor) for f in here]
    saved = [f.at(paper).cost / f.at(setting).cost for f in here]
    return Level(room, name, setting, errors, saved)


class SpeedUp(NamedTuple):
    """CPU time of whole runs: the paper's numerics and the default's."""

    room: str
    v_d: float  # m/s
    N: int
    paper: list[float]  # s, one for each seed
    default: list[float]  # s

    @property
    def ratio(self) -> float:
        """Median over the seeds of how many times faster the default is."""
        return median(p / d for p, d in zip(self.paper, self.default, strict=True))


def speed_up(room: str, v_d: float, N: int, seeds: int) -> SpeedUp:
    """Time whole runs with both numerics in turn."""
    pairs = [_both(room, v_d, N, seed) for seed in range(seeds)]
    compile_kernel(pairs[0][0])
    compile_kernel(pairs[0][1])
    times = [[timed(scenario)[0] for scenario in pair] for pair in pairs]
    return SpeedUp(room, v_d, N, [p for p, _ in times], [d for _, d in times])


def _both(room: str, v_d: float, N: int, seed: int) -> tuple[Scenario, Scenario]:
    build = ROOMS[room]
    return build(v_d=v_d, N=N, seed=seed, numerics=PAPER), build(v_d=v_d, N=N, seed=seed)
