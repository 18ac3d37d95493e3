"""Command line: `python -m studies.readings [--quick] [--docs] [--jobs N]`."""

import argparse

from studies.readings.everything import main

parser = argparse.ArgumentParser("python -m studies.readings", description="Readings against published numbers.")
parser.add_argument("--quick", action="store_true", help="four readings, three seeds")
parser.add_argument("--docs", action="store_true", help="also write docs/readings.md and its figure")
parser.add_argument("--jobs", type=int, default=2, help="worker processes")
main(**vars(parser.parse_args()))
