"""Which variant of Lin, Ma & Lo (2016) the published numbers support."""

from pathlib import Path

from studies.presentation import figures
from studies.variants import page, sweeps
from studies.variants.figure import plot
from studies.variants.score import scored

DOCS = Path("docs")
THINNED = (
    "\n\nFour variants and three seeds: it shows that all works; docs/variants.md has the verdicts of the full study."
)


def main(quick: bool = False, jobs: int = 2, docs: bool = False) -> None:
    """Sweep what is missing, score all variants, draw the figure, print the table; with `docs` write the page.

    The quick form has some of the full one's variants and seeds.
    """
    ds = sweeps.run(sweeps.QUICK_SEEDS, jobs, sweeps.QUICK_VARIANTS) if quick else sweeps.run(sweeps.SEEDS, jobs)
    found = scored(ds)
    figures.draw(plot, found, sweeps.FOLDER / "figure.png")
    text = page.text(found) + (THINNED if quick else "")
    (sweeps.FOLDER / "table.txt").write_text(text + "\n", "utf-8")
    print(text, f"\n{sweeps.FOLDER / 'figure.png'}", sep="\n")
    if docs:
        figures.draw(plot, found, DOCS / "variants.png")
        (DOCS / "variants.md").write_text(page.page(found), "utf-8")
