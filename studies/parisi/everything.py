"""All figures and Table 1 of Parisi & Dorso (2005): `make study-parisi`; with DOCS=1 also docs/parisi.md."""

import os
import time
from importlib import import_module
from pathlib import Path

from studies.parisi import artefact, table1
from studies.parisi.sweeps import EVERY, Sweeps
from studies.presentation.page import sections
from studies.presentation.verdicts import Verdict, table
from studies.published import parisi2005 as paper

ARTEFACTS = ("table1", *(f"fig{k}" for k in range(1, 11)))
PAGE = Path("docs/parisi.md")
INTRODUCTION = f"""# Parisi & Dorso (2005), reproduced

Written by `make study-parisi DOCS=1`: {paper.RUNS} runs at each desired speed and at each width of the door, contacts
sampled every {EVERY:g} s. Intervals are of 95 %; a blocking cluster is *clean* if it encloses nobody, and only then
shuts the exit. The paper's figures were not digitised: published numbers are those of its text and Table 1.

Two values the paper leaves open were chosen so that Table 1 comes out: the strength of the social force, A = 2000 N as
Helbing's group has it, while the paper prints 1000 N; and 80 kg a person. The table of evacuation times therefore shows
that the model can give these numbers; the clusters, arches and delays below were not fitted.

Where no sample of any run has a cluster, the upper limit drawn is that of a share of 0 among as many runs. At 4 m/s
Table 1 prints t_e/t_eg = 3.10, though its own times give 81.3/27 = 3.01.

## What A = 1000 N, as printed, does to Table 1

"""


def make_one(name: str, sweeps: Sweeps) -> list[Verdict]:
    """Draw the figure of this name and give its verdicts."""
    return artefact.make(import_module(f"studies.parisi.{name}"), sweeps)


def page(found: dict[str, list[Verdict]], variants: str) -> str:
    """The page of the documents."""
    return f"{INTRODUCTION}{variants}\n\n{sections(found)}"


def main(quick: bool = False, jobs: int = 2) -> None:
    """Run what is missing, draw everything, print all verdicts."""
    begin = time.monotonic()
    sweeps = Sweeps(quick, jobs)
    sweeps.folder.mkdir(parents=True, exist_ok=True)
    found = {name: make_one(name, sweeps) for name in ARTEFACTS}
    text = table(verdict for several in found.values() for verdict in several)
    (sweeps.folder / "table.txt").write_text(text + "\n", "utf-8")
    print(text + (artefact.THINNED if quick else ""))
    print(f"\n{len(found)} pictures in {sweeps.folder} after {time.monotonic() - begin:.0f} s")
    if os.environ.get("DOCS") and not quick:
        PAGE.write_text(page(found, table1.variants_table(table1.measure(sweeps))), "utf-8")
        print(PAGE)
