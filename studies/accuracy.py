"""Work and precision: what the accuracies of `engine.options` leave of error and save of time.

`make study-accuracy`, or `python -m studies.accuracy [--quick] [--docs] [--jobs N] [--more N]`.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Any

from engine.rooms import ROOMS
from studies.precision import cells, conservation, friction, levels, positions, savings
from studies.precision.clock import compile_all, spread
from studies.precision.drawing import draw
from studies.precision.page import Results, page, raw, tables
from studies.precision.plans import FULL, QUICK, Plan, times_more
from studies.precision.settings import Setting
from sweep.report import tell

FOLDER, DOCS = Path("results/accuracy"), Path("docs")


def measure(plan: Plan, store: Path, jobs: int) -> Results:
    """Run all parts of a plan; whole runs are kept in the store and not run again."""
    settings = positions.product(plan.integrators, plan.steps, plan.tolerances)
    _say("compiling the kernels")
    checks = [c for case in plan.cases for c in (case.reference, *case.checks)]
    rooms: dict[str, Any] = {case.room: ROOMS[case.room]() for case in plan.cases}
    kinds = [Setting(s.integrator, 1e-4, 1e-3) for s in (*settings, *checks)]
    spread(compile_all, [(room, kinds) for room in rooms.values()], jobs)
    _say("positions before chaos")
    found = positions.measure(plan.cases, settings, plan.seeds, plan.stretch, jobs)
    _say("energy where it is conserved")
    drifts = conservation.measure(plan.integrators, plan.steps, plan.gas_time, jobs)
    _say("statistics of whole runs")
    judged = [j for cell in plan.cells for j in cells.judge(cell, store, jobs)]
    _say("friction at a step and at a quarter of it")
    frictions = friction.measure(plan.cells, plan.friction_seeds, jobs)
    _say("whole runs with the paper's numerics and the default")
    speed_ups = spread(levels.speed_up, plan.speed_ups, jobs)
    _say("what skipping saves")
    saved = savings.measure(plan.stretch, plan.repeats, plan.compiling)
    return Results(found, drifts, judged, frictions, levels.levels(found), speed_ups, saved)


def main(quick: bool = False, jobs: int = 2, docs: bool = False, more: int = 1) -> None:
    """Measure, draw, print the tables; an exit code of 1 where a run failed.

    Parameters
    ----------
    docs : also write docs/accuracy.md, docs/accuracy_tables.md and their figures
    more : times the seeds of the statistics
    """
    begin = time.monotonic()
    folder = FOLDER / "quick" if quick else FOLDER
    results = measure(times_more(QUICK if quick else FULL, more), FOLDER, jobs)
    folder.mkdir(parents=True, exist_ok=True)
    text = tables(results)
    options = f"{' QUICK=1' if quick else ''}{f' MORE={more}' if more > 1 else ''}"
    command = f"make study-accuracy{options} JOBS={jobs}{' DOCS=1' if docs else ''}"
    written = {
        "accuracy.md": page(results, command),
        "accuracy_tables.md": raw(text, command, time.monotonic() - begin),
    }
    for place in [folder, *([DOCS] if docs else [])]:
        draw(results, place)
        for name, content in written.items():
            (place / name).write_text(content, "utf-8")
    print(text, f"\n{folder / 'accuracy.md'}", sep="\n")
    if broken := results.broken():
        sys.exit("broken: " + "; ".join(broken))


def _say(what: str) -> None:
    tell(f"{time.strftime('%H:%M:%S')} {what} ...")


if __name__ == "__main__":
    parser = argparse.ArgumentParser("python -m studies.accuracy", description="Work and precision.")
    parser.add_argument("--quick", action="store_true", help="a thinned form that shows that all works")
    parser.add_argument("--docs", action="store_true", help="also write docs/accuracy.md and its figures")
    parser.add_argument("--jobs", type=int, default=2, help="worker processes")
    parser.add_argument("--more", type=int, default=1, help="times the seeds of the statistics")
    main(**vars(parser.parse_args()))
