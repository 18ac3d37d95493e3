"""A case: what is tried, what may come of it; and the judgement of what came."""

import math
import warnings
from collections.abc import Callable
from typing import NamedTuple

from engine import BadInput, Run, Scenario, simulate
from engine.scenario import step_limit
from studies.stress.checks import check
from studies.stress.kinds import Kind

REFUSED, FAILED, HUNG, CRASHED = "refused", "failed", "hung", "crashed"
# What made a run unstable
STIFF = "at a tenth of the step it is not"
SOFT = "at a tenth of the step it is too: the bodies give way"


class Case(NamedTuple):
    """Something to try."""

    kind: Kind  # model and integrator
    label: str
    build: Callable[[], Scenario]
    refused: bool | None = False  # whether it must be refused, with a line that has `named` in it; None: it may be
    named: str = ""
    wanted: tuple[str, ...] = ()  # outcomes of which one must come; none: any
    breakable: bool = False  # whether an unstable run is as good as any, since bodies are asked for too much
    slow: bool = False  # left out of the quick form


class Judgement(NamedTuple):
    """What came of a case."""

    outcome: str  # of the run, or one of the words above
    violations: tuple[str, ...] = ()
    overlap: float = math.nan  # smallest radii
    rise: float = math.nan  # of energy, as a share of what is allowed
    note: str = ""  # of an unstable run: who, and why


def judge(case: Case) -> Judgement:
    """Run a case; no exception leaves."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            scenario = case.build()
            return _judged(case, scenario, simulate(scenario))
    except BadInput as refusal:
        return _refused(case, str(refusal))
    except Exception as error:
        return Judgement(FAILED, (" ".join(f"{type(error).__name__}: {error}".split()),))


def _judged(case: Case, scenario: Scenario, run: Run) -> Judgement:
    found = check(run, step_limit(scenario)[0])
    violations = [*found.violations, *(["was not refused"] if case.refused else [])]
    if case.wanted and run.outcome not in case.wanted:
        violations.append(f"{run}, which should have been {' or '.join(case.wanted)}")
    note = _cause(run) if run.outcome == "unstable" and not case.breakable else ""
    return Judgement(run.outcome, tuple(violations), found.overlap, found.rise, note)


def _refused(case: Case, line: str) -> Judgement:
    said = []
    if case.refused is False:
        said.append(f"was refused: {line}")
    elif "\n" in line or ": " not in line or case.named not in line:
        said.append(f"the refusal is not one line that names {case.named or 'the remedy'}: {line!r}")
    return Judgement(REFUSED, tuple(said))


def _cause(run: Run) -> str:
    """Tell steps that contacts do not bear from bodies that give way."""
    shorter = simulate(run.scenario, dt=run.scenario.numerics.dt / 10, record_every=0.0, contacts=False)
    return f"{run}; {SOFT if shorter.outcome == 'unstable' else STIFF}"
