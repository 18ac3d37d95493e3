"""The page of a paper's verdicts: what is not reproduced, what is open, and all of it."""

from collections.abc import Mapping, Sequence

from studies.presentation.verdicts import MARKS, Verdict

HEAD = "| where | statement | published | found | |\n|---|---|---|---|---|\n"


def sections(found: Mapping[str, Sequence[Verdict]]) -> str:
    """Verdicts by the name of their figure, as Markdown from "Not reproduced" to "All verdicts"."""
    verdicts = [(name, verdict) for name, several in found.items() for verdict in several]
    missed, undecided = (
        [f"- {v.statement}: published {v.published}; found {v.found}." for _, v in verdicts if v.holds is holds]
        for holds in (False, None)
    )
    rows = [f"| {name} | {v.statement} | {v.published} | {v.found} | {mark(v)} |" for name, v in verdicts]
    return "\n".join(
        [
            "## Not reproduced\n",
            *(missed or ["Nothing."]),
            *(["\n## Open\n", *undecided] if undecided else []),
            "\n## All verdicts\n",
            HEAD + "\n".join(rows),
            "",
        ]
    )


def mark(verdict: Verdict) -> str:
    """Yes, no or open, the no in bold."""
    word = MARKS[verdict.holds].lower()
    return f"**{word}**" if word == "no" else word
