"""Judgements -> the table, what it says of the goals, and the page in the docs."""

import datetime
from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from engine import OUTCOMES
from studies.presentation.machine import machine
from studies.stress import kinds
from studies.stress.checks import FIRST_ORDER_SWING, LOSSLESS_DRIFT, MOMENTUM, PASSIVE_RISE
from studies.stress.judge import CRASHED, FAILED, HUNG, REFUSED, SOFT, STIFF, Judgement

HEAD = (
    "family",
    "runs",
    "outcomes",
    "worst overlap, smallest radii",
    "worst energy error, of the allowed",
    "violations",
)
ORDER = (*OUTCOMES, REFUSED, FAILED, HUNG, CRASHED)
SHOWN = 40  # of each list


class Result(NamedTuple):
    """One case and what came of it."""

    family: str
    number: int
    label: str
    kind: kinds.Kind
    judgement: Judgement

    @property
    def command(self) -> str:
        """What runs it again."""
        return f"python -m studies.stress --scene {self.family}:{self.number}"


def table(results: list[Result]) -> str:
    """The table in Markdown, goals and findings below."""
    families = list(dict.fromkeys(result.family for result in results))
    rows = [_row(family, [r for r in results if r.family == family]) for family in families]
    lines = [HEAD, tuple("---" for _ in HEAD), *rows]
    text = "\n".join(f"| {' | '.join(line)} |" for line in lines)
    return "\n\n".join(part for part in (text, _bullets(goals(results)), findings(results), _bullets(notes())) if part)


def _row(family: str, results: list[Result]) -> tuple[str, ...]:
    found = Counter(result.judgement.outcome for result in results)
    outcomes = ", ".join(f"{found[name]} {name}" for name in ORDER if found[name])
    overlaps = [r.judgement.overlap for r in results if r.judgement.overlap == r.judgement.overlap]
    rises = [r.judgement.rise for r in results if r.judgement.rise == r.judgement.rise]
    violations = sum(bool(r.judgement.violations) for r in results)
    return (family, str(len(results)), outcomes, _worst(overlaps), _worst(rises), str(violations))


def _worst(values: list[float]) -> str:
    return f"{max(values):.3g}" if values else ""


def goals(results: list[Result]) -> list[str]:
    """What was to hold, and whether it did."""
    violations = sum(bool(result.judgement.violations) for result in results)
    nameless = sum(result.judgement.outcome in (FAILED, HUNG, CRASHED) for result in results)
    unstable = Counter(cause for result in results for cause in (STIFF, SOFT) if cause in result.judgement.note)
    below = "unstable runs below the longest step allowed"
    return [
        _goal("runs that end without a named outcome", nameless),
        _goal("runs that break an invariant", violations),
        _goal(f"{below}, where {STIFF}", unstable[STIFF]),
        f"{below}, where {SOFT}: {unstable[SOFT]}",
    ]


def _goal(what: str, count: int) -> str:
    return f"{what}: {count} (goal 0: {'NOT met' if count else 'met'})"


def findings(results: list[Result]) -> str:
    """Every violation and every unstable run, with the command that repeats it."""
    violated = [f"{_name(r)}: {'; '.join(r.judgement.violations)}" for r in results if r.judgement.violations]
    unstable = [f"{_name(r)}: {r.judgement.note}" for r in results if r.judgement.note]
    parts = [("Violations", violated), ("Unstable runs", unstable)]
    return "\n\n".join(f"{head}:\n\n{_bullets(_first(lines))}" for head, lines in parts if lines)


def _name(result: Result) -> str:
    return f"{' / '.join(result.kind)}, {result.label} (`{result.command}`)"


def _first(lines: list[str]) -> list[str]:
    return lines if len(lines) <= SHOWN else [*lines[:SHOWN], f"and {len(lines) - SHOWN} more"]


def notes() -> list[str]:
    """What was tried and what the columns mean."""
    return [
        f"Models: {', '.join(kinds.MODELS)}; integrators: {', '.join(kinds.INTEGRATORS)}.",
        "In every run: nothing is nan or infinite, nobody's way crosses a wall, nobody is deeper in another than the "
        "smallest radius, everybody leaves once and by an exit, the outcome says what is so; what is refused is "
        "refused in one line.",
        f"Energy of undriven crowds, at every step: where nothing is lost it may drift by {LOSSLESS_DRIFT:.3g} "
        f"(dt/limit)^2 of itself, and where there is friction or damping rise by {PASSIVE_RISE:g} dt/limit (with "
        f"integrators of first order by {FIRST_ORDER_SWING:g} dt/limit in both cases); work that pressing does on "
        "Mindlin's spring is counted. Momentum without walls "
        f"may change by {MOMENTUM:g} of the sum of mass times speed.",
        "An unstable run below the longest step allowed is a finding, not a violation. Who is thrown may break through "
        "if the run says so.",
    ]


def _bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def page(text: str, command: str, duration: float) -> str:
    """The page of the docs; `duration` in s."""
    today = datetime.date.today().isoformat()
    return f"# Stress\n\nRun on {today} with `{command}` in {duration / 60:.1f} minutes on: {machine()}.\n\n{text}\n"
