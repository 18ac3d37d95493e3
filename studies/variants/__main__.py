"""Command line: `python -m studies.variants [--quick] [--docs] [--jobs N]`."""

import argparse

from studies.variants.everything import main

parser = argparse.ArgumentParser("python -m studies.variants", description="Variants against published numbers.")
parser.add_argument("--quick", action="store_true", help="four variants, three seeds")
parser.add_argument("--docs", action="store_true", help="also write docs/variants.md and its figure")
parser.add_argument("--jobs", type=int, default=2, help="worker processes")
main(**vars(parser.parse_args()))
