"""What all figures of this paper share: their sweeps, their height, and how points are drawn and said."""

from types import ModuleType

from studies.parisi.sweeps import Sweeps
from studies.presentation.artefact import THINNED, make
from studies.presentation.artefact import main as draw_and_tell
from studies.presentation.estimates import NEAR, STYLES, V_D, at, each, larger, points, said, within

__all__ = [
    "HEIGHT",
    "NEAR",
    "STYLES",
    "THINNED",
    "V_D",
    "at",
    "each",
    "larger",
    "main",
    "make",
    "points",
    "said",
    "within",
]
HEIGHT = 2.6  # in


def main(artefact: ModuleType, quick: bool, jobs: int) -> None:
    """Run what is missing, draw one figure, print its verdicts."""
    draw_and_tell(artefact, Sweeps(quick, jobs))
