"""Command line: `python -m studies.stress [--quick] [--docs] [--jobs N] [--scene NUMBER or FAMILY:NUMBER]`."""

import argparse
import sys
import time
from pathlib import Path

from studies.stress import families
from studies.stress.judge import judge
from studies.stress.table import page, table
from studies.stress.tasks import Task, all_tasks, cases, quick_tasks, run

FOLDER, PAGE = Path("results/stress"), Path("docs/stress.md")


def main(arguments: list[str]) -> int:
    """Run, print the table and write it to results/stress/table.md; 1 if an invariant is broken, else 0."""
    chosen = _options(arguments)
    if chosen.scene is not None:
        return _again(*chosen.scene)
    begin = time.monotonic()
    tasks = list(quick_tasks() if chosen.quick else all_tasks())
    results = run(tasks, chosen.jobs)
    text = table(results)
    written = page(text, " ".join(["python -m studies.stress", *arguments]), time.monotonic() - begin)
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "table.md").write_text(written, "utf-8")
    if chosen.docs:
        PAGE.write_text(written, "utf-8")
    print(text, f"\n{FOLDER / 'table.md'}", sep="\n")
    return int(any(result.judgement.violations for result in results))


def _options(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser("python -m studies.stress", description="The engine at its edges.")
    parser.add_argument("--quick", action="store_true", help="each model and integrator once, fewer cases")
    parser.add_argument("--docs", action="store_true", help=f"also write {PAGE}")
    parser.add_argument("--jobs", type=int, default=2, help="worker processes; 0: in this one, without a time-out")
    parser.add_argument("--scene", type=_task, metavar="[FAMILY:]NUMBER", help="one case again; random by number alone")
    chosen = parser.parse_args(arguments)
    if chosen.jobs < 0:
        parser.error(f"--jobs {chosen.jobs} is below 0")
    return chosen


def _task(text: str) -> Task:
    """The case that "1234" or "places:3" names."""
    family, _, number = text.rpartition(":")
    task = (family or families.RANDOM, int(number))
    known = [*families.FAMILIES, families.RANDOM]
    if task[0] not in known or not 0 <= task[1] < len(cases(task[0])):
        raise argparse.ArgumentTypeError(f"{text} is no case: give a number, or one of {', '.join(known)} and a number")
    return task


def _again(family: str, number: int) -> int:
    """Run one case in this process and say all about it."""
    case = cases(family)[number]
    judgement = judge(case)
    print(f"{family}:{number}, {' / '.join(case.kind)}, {case.label}: {judgement.outcome}")
    print(f"overlap {judgement.overlap:.3g} radii, energy error {judgement.rise:.3g} of the allowed")
    for line in (*judgement.violations, *([judgement.note] if judgement.note else [])):
        print(f"- {line}")
    return int(bool(judgement.violations))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
