"""Which cases are run, and how they are spread over workers."""

from collections.abc import Iterator, Sequence
from functools import lru_cache

from studies.stress import families, kinds
from studies.stress.judge import CRASHED, HUNG, Case, Judgement, judge
from studies.stress.table import Result
from studies.stress.workers import Crashed, Hung, answers

PATIENCE = 120.0  # s that one case may take, compilation not counted
COMPILATION = 600.0  # s
QUICK_SCENES = 400
COMPILE = "compile"
Task = tuple[str, int]  # family and number of a case


def all_tasks() -> Iterator[Task]:
    """All cases of all families, then the random scenes."""
    for family in [*families.FAMILIES, families.RANDOM]:
        for number in range(len(cases(family))):
            yield family, number


def quick_tasks() -> Iterator[Task]:
    """The cases that are not slow, of `kinds.FEW`."""
    for family, number in all_tasks():
        if family == families.RANDOM and number >= QUICK_SCENES:
            return
        case = cases(family)[number]
        if case.kind in kinds.FEW and not case.slow:
            yield family, number


def run(tasks: list[Task], jobs: int) -> list[Result]:
    """Judge all cases, in `jobs` worker processes that compile the models first, or in this process."""
    if jobs:
        of_kind = {cases(family)[number].kind for family, number in tasks}
        compilations = [(COMPILE, number) for number, kind in enumerate(kinds.KINDS) if kind in of_kind]
        for _ in answers(work, compilations, jobs, COMPILATION):
            pass
    answered = answers(work, tasks, jobs, PATIENCE) if jobs else ((task, work(task)) for task in tasks)
    found = {task: _judgement(answer) for task, answer in answered}
    return [Result(*task, cases(task[0])[task[1]].label, cases(task[0])[task[1]].kind, found[task]) for task in tasks]


def work(task: Task) -> Judgement:
    """What a worker does: one case; or, for the family `COMPILE`, one step of a kind."""
    family, number = task
    if family == COMPILE:
        return judge(families.one_step(kinds.KINDS[number]))
    return judge(cases(family)[number])


@lru_cache
def cases(family: str) -> Sequence[Case]:
    """The cases of a family, made once."""
    return families.cases(family)


def _judgement(answer: Judgement | Hung | Crashed) -> Judgement:
    if isinstance(answer, Hung):
        return Judgement(HUNG, (f"no answer after {answer.patience:g} s",))
    if isinstance(answer, Crashed):
        return Judgement(CRASHED, (f"its process ended with exit code {answer.exit_code}",))
    return answer
