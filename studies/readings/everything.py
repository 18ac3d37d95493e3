"""Which reading of Lin, Ma & Lo (2016) the published numbers support."""

from pathlib import Path

from studies.presentation import figures
from studies.readings import page, sweeps
from studies.readings.figure import plot
from studies.readings.score import scored

DOCS = Path("docs")
THINNED = (
    "\n\nFour readings and three seeds: it shows that all works; docs/readings.md has the verdicts of the full study."
)


def main(quick: bool = False, jobs: int = 2, docs: bool = False) -> None:
    """Sweep what is missing, score all readings, draw the figure, print the table; with `docs` write the page.

    The quick form has some of the full one's readings and seeds.
    """
    ds = sweeps.run(sweeps.QUICK_SEEDS, jobs, sweeps.QUICK_READINGS) if quick else sweeps.run(sweeps.SEEDS, jobs)
    found = scored(ds)
    figures.draw(plot, found, sweeps.FOLDER / "figure.png")
    text = page.text(found) + (THINNED if quick else "")
    (sweeps.FOLDER / "table.txt").write_text(text + "\n", "utf-8")
    print(text, f"\n{sweeps.FOLDER / 'figure.png'}", sep="\n")
    if docs:
        figures.draw(plot, found, DOCS / "readings.png")
        (DOCS / "readings.md").write_text(page.page(found), "utf-8")
