"""What becomes of one figure of a paper: its picture in the folder of the paper's sweeps, and its verdicts."""

from pathlib import Path
from types import ModuleType
from typing import Protocol

from studies.presentation import figures
from studies.presentation.verdicts import Verdict, table

THINNED = "\n\nThinned: few seeds and fewer values; it shows that all works."


class Swept(Protocol):
    """The sweeps of a paper, of which only the figure's own `measure` knows more."""

    quick: bool
    folder: Path


def name_of(artefact: ModuleType) -> str:
    """The figure's name: fig4 of studies.lin.fig4."""
    return artefact.__name__.rpartition(".")[2]


def make(artefact: ModuleType, sweeps: Swept) -> list[Verdict]:
    """Draw one figure and give its verdicts."""
    sweeps.folder.mkdir(parents=True, exist_ok=True)
    found = artefact.measure(sweeps)
    figures.draw(artefact.plot, found, sweeps.folder / f"{name_of(artefact)}.png")
    verdicts: list[Verdict] = artefact.verdicts(found)
    return verdicts


def main(artefact: ModuleType, sweeps: Swept) -> None:
    """Run what is missing, draw one figure, write and print its verdicts."""
    text = table(make(artefact, sweeps)) + THINNED * sweeps.quick
    path = sweeps.folder / name_of(artefact)
    path.with_suffix(".txt").write_text(text + "\n", "utf-8")
    print(text, f"\n{path}.png", sep="\n")
