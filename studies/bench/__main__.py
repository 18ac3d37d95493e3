"""Command line: `python -m studies.bench [--quick] [--only NAME] [--docs]`."""

import argparse
import sys
from pathlib import Path

from studies.bench.compare import REPEATS, compare
from studies.bench.packing import SIZES
from studies.bench.peers import NAMES, load
from studies.bench.table import page, table

FOLDER, PAGE = Path("results/bench"), Path("docs/benchmark.md")
QUICK_SIZES, QUICK_REPEATS = SIZES[:3], 3


def main(arguments: list[str]) -> None:
    """Measure, print the table and write it to results/bench/table.md; with --docs to docs/benchmark.md too."""
    parser = argparse.ArgumentParser("python -m studies.bench", description="This engine beside its peers.")
    parser.add_argument("--quick", action="store_true", help="N = 100, 200, 1000 only, fewer repeats")
    parser.add_argument("--only", choices=NAMES, help="one code alone")
    parser.add_argument("--docs", action="store_true", help=f"also write {PAGE}")
    chosen = parser.parse_args(arguments)
    sizes = QUICK_SIZES if chosen.quick else SIZES
    repeats = dict.fromkeys(sizes, QUICK_REPEATS) if chosen.quick else REPEATS
    peers = [load(name) for name in ([chosen.only] if chosen.only else NAMES)]
    text = table(compare(peers, sizes, repeats))
    written = page(text, " ".join(["python -m studies.bench", *arguments]))
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "table.md").write_text(written, "utf-8")
    if chosen.docs:
        PAGE.write_text(written, "utf-8")
    print(text, f"\n{FOLDER / 'table.md'}", sep="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
