"""Figures 4 to 10 of Lin, Ma & Lo (2016) and the hazard of blocking: `make study-lin`; with DOCS=1 also docs/lin.md."""

import os
import time
from importlib import import_module
from pathlib import Path
from shutil import copyfile

from studies.lin.sweeps import ROTATION_SEEDS, SEEDS, STRENGTH_SEEDS, Sweeps
from studies.presentation.artefact import THINNED, make
from studies.presentation.page import sections
from studies.presentation.verdicts import Verdict, table

ARTEFACTS = (*(f"fig{k}" for k in range(4, 11)), "hazard")
PAGE = Path("docs/lin.md")
PICTURES = {"fig7": "lin_fig7.png", "hazard": "lin_hazard.png"}  # of the page
INTRODUCTION = f"""# Lin, Ma & Lo (2016), reproduced

Written by `make study-lin DOCS=1` with the default variant of what the paper leaves open (`models.lin_dem`): {SEEDS}
runs at each desired speed and crowd size for Figures 7 to 10, which share them, {STRENGTH_SEEDS} at each strength of
the social force for Figure 4, {ROTATION_SEEDS} pairs with and without rotation for Figure 5. Intervals are of 95 %; a
mean is over the runs that got out, and how many did not is said. The figures of the paper were not digitised: published
numbers are those of its text. The default variant was chosen by its agreement with them, so that agreement shows what
the model can give, and not that its authors' code had these laws.

Tolerances: 20 % of a clearance time, 10 % of a flow, of what is called the same, and of what changes barely. A range of
Figure 9 grows with the number of runs; its ends are held against those of pictures with one run for each speed and
crowd, as the paper's are. In fig10, phase separation begins at the speed from which at least 30 % of the runs block.

![Leaving curves and clearance times of 200 persons](lin_fig7.png)

## Blocking as a hazard per exit

Whoever gets out may be followed by nobody. If that were as likely after every exit, crowds of one size would tell how
often others block. The rows called hazard test this on runs that a law was not fitted to; what they call published is
the prediction. The hazard that grows with a power of the number of persons still inside, and is free at each
desired speed, has that power from the likelihood ratio.

![Hazard of blocking against persons inside; blocked shares and predictions](lin_hazard.png)
"""


def page(found: dict[str, list[Verdict]]) -> str:
    """The page of the documents."""
    return f"{INTRODUCTION}\n{sections(found)}"


def main(quick: bool = False, jobs: int = 2) -> None:
    """Run what is missing, draw everything, print all verdicts."""
    begin = time.monotonic()
    sweeps = Sweeps(quick, jobs)
    found = {name: make(import_module(f"studies.lin.{name}"), sweeps) for name in ARTEFACTS}
    text = table(verdict for several in found.values() for verdict in several)
    (sweeps.folder / "table.txt").write_text(text + "\n", "utf-8")
    print(text + THINNED * quick)
    print(f"\n{len(found)} pictures in {sweeps.folder} after {time.monotonic() - begin:.0f} s")
    if os.environ.get("DOCS") and not quick:
        PAGE.write_text(page(found), "utf-8")
        for name, picture in PICTURES.items():
            copyfile(sweeps.folder / f"{name}.png", PAGE.parent / picture)
        print(PAGE)
