"""Command line: `python -m studies.torture [--quick] [NAME ...]`: all of it, or the parts named."""

import argparse
import importlib
import importlib.util
import sys
import time

PARTS = ("damage", "disks", "scale", "dask_cluster", "kills")


def main(arguments: list[str]) -> int:
    """Run the parts; each prints a line of counts, then what went wrong. 1 if anything did, else 0."""
    there = [part for part in PARTS if importlib.util.find_spec(f"studies.torture.{part}")]
    parser = argparse.ArgumentParser("python -m studies.torture", description="What a sweep must live through.")
    parser.add_argument("--quick", action="store_true", help="thinned: under a minute and a half")
    parser.add_argument("parts", nargs="*", metavar="NAME", help=f"of {', '.join(there)}; all by default")
    chosen = parser.parse_args(arguments)
    unknown = sorted(set(chosen.parts) - set(there))
    if unknown:
        parser.error(f"{unknown[0]} is no part: choose from {', '.join(there)}")
    problems = []
    for part in chosen.parts or there:
        begin = time.monotonic()
        found = importlib.import_module(f"studies.torture.{part}").main(chosen.quick)
        problems += [f"{part}: {problem}" for problem in found]
        print(f"  {part} took {time.monotonic() - begin:.0f} s", flush=True)
    print(*problems, sep="\n")
    return int(bool(problems))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
