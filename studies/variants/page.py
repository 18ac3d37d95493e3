"""The table and the page: what each variant scores, what is ruled out, and what the default rests on."""

import numpy as np
import xarray as xr

from studies.presentation.verdicts import columns, interval
from studies.variants.room import DEFAULT, VARIANTS
from studies.variants.score import CONFIDENCE, LEAST_SEEDS, TOO_FEW, verdicts
from studies.variants.targets import FITTED, HELD_OUT, MOST, SHARE, SHARE_OF_RANGE, SHOWN, TARGETS

ENDS = ("", "_low", "_high")
Rows = list[tuple[str, ...]]


def ranked(found: xr.Dataset) -> list[str]:
    """Names of the variants, the best score first."""
    score = found.score.sel(group="all")
    return [str(name) for name in score.sortby(score).variant.values]


def score_rows(found: xr.Dataset) -> Rows:
    """One row for each variant, the best first; the head is the first."""
    words = verdicts(found)
    best = ranked(found)[0]
    rows: Rows = [("variant", "score", FITTED, HELD_OUT, f"less {best}", "blocked / runs", "verdict")]
    for name in ranked(found):
        of = found.sel(variant=name)
        scores = [_words(of.sel(group=group), "score") for group in ("all", FITTED, HELD_OUT)]
        apart = _words(of.sel(group="all", other=best), "difference") if name != best else ""
        lost = f", {int(of.not_run)} unstable" if of.not_run else ""
        rows.append((name, *scores, apart, f"{int(of.blocked)} / {int(of.runs)}{lost}", words[name]))
    return rows


def _words(of: xr.Dataset, name: str) -> str:
    mean, low, high = (float(of[f"{name}{end}"]) for end in ENDS)
    return interval(mean, low, high, 1)


def found_rows(found: xr.Dataset, names: list[str]) -> Rows:
    """One row for each published statement: what some variants have, and what that adds to their scores."""
    rows: Rows = [("figure", "published statement", "tolerance", "use", *names)]
    for target, of in zip(TARGETS, found.transpose("target", ...).term.target, strict=True):
        row = found.sel(target=of)
        values = [_value(row.sel(variant=name), target.digits) for name in names]
        rows.append((target.figure, target.statement, target.tolerance, target.group, *values))
    return rows


def _value(of: xr.Dataset, digits: int) -> str:
    value, term = float(of.found), float(of.term)
    return f"{value:.{digits}f} ({term:.1f})" if np.isfinite(value) else f"none out ({term:.1f})"


def pairs_not_told_apart(found: xr.Dataset) -> list[str]:
    """Pairs of variants whose paired difference of scores has an interval that holds 0, "reset = kept"."""
    of_all, names = found.sel(group="all"), ranked(found)
    pairs = [(a, b) for k, a in enumerate(names) for b in names[k + 1 :]]
    same = [of_all.sel(variant=a, other=b) for a, b in pairs]
    held = [bool(of.difference_low <= 0.0 <= of.difference_high) for of in same]
    return [f"{a} = {b}" for (a, b), holds in zip(pairs, held, strict=True) if holds]


def why_default(found: xr.Dataset) -> str:
    """What the runs say about the default, in a sentence or two."""
    words, best = verdicts(found), ranked(found)[0]
    if words[DEFAULT] == "best":
        rivals = [name for name, word in words.items() if word == "not told apart"]
        more = f"; {', '.join(rivals)} cannot be told apart from it" if rivals else ""
        return f"The default, {DEFAULT}, has the best score{more}."
    apart = _words(found.sel(group="all", variant=DEFAULT, other=best), "difference")
    if words[DEFAULT] == TOO_FEW:
        return f"Too few seeds to judge the default, {DEFAULT}."
    if words[DEFAULT] == "ruled out":
        return f"The default, {DEFAULT}, is RULED OUT: its score is above that of {best} by {apart}."
    return (
        f"The default, {DEFAULT}, cannot be told apart from the best, {best}: its score is above by {apart}."
        " It stays the default: of laws that the published numbers cannot tell apart it is the simplest."
    )


def text(found: xr.Dataset) -> str:
    """What the study prints."""
    seeds = (
        f"{found.attrs['seeds']} seeds; intervals of {CONFIDENCE:.0%}, {found.attrs['resamples']} resamples of seeds"
    )
    best = ranked(found)[:4]
    same = pairs_not_told_apart(found)
    return "\n\n".join(
        [
            columns(score_rows(found)),
            seeds,
            columns(found_rows(found, best)),
            f"not told apart ({len(same)} pairs): {'; '.join(same) or 'none'}",
            why_default(found),
        ]
    )


def markdown(rows: Rows) -> str:
    """Rows as a table of a page."""
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]])


def _keywords(name: str) -> str:
    return ", ".join(f"`{key}={value!r}`" for key, value in VARIANTS[name].items()) or "none: the default"


def page(found: xr.Dataset) -> str:
    """docs/variants.md."""
    kinds: Rows = [("variant", "keywords of `rooms.lin_room`"), *((name, _keywords(name)) for name in VARIANTS)]
    words = verdicts(found)
    out = [name for name in ranked(found) if words[name] == "ruled out"]
    alike = [name for name in ranked(found) if words[name] == "not told apart"]
    same = pairs_not_told_apart(found)
    return f"""# Variants of Lin, Ma & Lo (2016)

The paper leaves open what slip does to the tangential spring, and more. `make study-variants` runs
{len(VARIANTS)} variants over the same {found.attrs["seeds"]} seeds and holds each against {len(TARGETS)} published
numbers with one score. `make study-variants DOCS=1` writes this page.

{why_default(found)} Ruled out: {"; ".join(out) or "none"}.
Not told apart from the best: {"; ".join(alike) or "none"}.

![Scores of the variants and what adds to them](variants.png)

## What is compared

{markdown(kinds)}

A name is the friction between persons, with its coefficient, and behind the stroke that at walls where it differs from
the default. Friction is a spring that is kept at the Coulomb limit when it slips ("kept"), or starts anew: from what it
is beyond the limit ("reset"), a sawtooth of mean mu F_n/2, or from zero, with the limit acting for a whole step
("reset_to_zero"), which at 1 ms, the paper's step, is that sawtooth and some 20 % more; or it has no spring:
mu tanh(v_t/0.01 m/s) ("kinetic"), mu sign(v_t) ("coulomb"). Without rotation `inertia="none"` takes the
place of what a variant says. Variants that need a law that the engine lacks are not among them: beta against the
velocity, or a social force that ends at contact.

## The score

A sum over the published statements, 0 where all are met exactly, so that less is better:

- numbers: ((found - published)/tolerance)^2, at most {MOST:.0f}, so that no statement decides alone. The tolerance
  is {SHARE:.0%} of a clearance time or a mean flow and
  {SHARE_OF_RANGE:.0%} of the upper end of a range of flows in 10 s. Means are over the runs that got out; where no
  run does, a statement about them adds {MOST:.0f}.
- blocking: -2 ln of the probability that {SHOWN} further runs all block, or all get out, as published: the
  beta-binomial predictive of the runs at hand with Jeffreys' prior. That the paper shows {SHOWN} runs is assumed, it
  says "several". For "clogs more without rotation" it is -2 ln of the posterior probability of that.

Intervals resample seeds, the same ones in all cells and variants, since a seed means the same bodies and positions
everywhere; differences are paired. A variant is ruled out when the interval of its score less the best one's lies
above 0; with fewer than {LEAST_SEEDS} seeds nothing is. The tolerances are choices, and
{len(VARIANTS) - 1} comparisons at 95 % may rule out one that is as good.

Table 1 prints mu = 0.5 for all contacts. A spring that is reset keeps that number and halves it in effect; one that is
kept has to say 0.3 between persons, and needs no care with the time step. Of laws that cannot be told apart the
default is the simpler. It was chosen after its authors had seen these numbers. The statements of Figures 4 and 7 are
those that it was fitted to; Figures 5, 9 and 10 are scored apart, as held out. They are no proof either: they had been
read as well, and the flows of Figure 10 follow in part from the clearance times of Figure 7.

## Scores

{markdown(score_rows(found))}

## Statement by statement

Found, and in brackets what it adds to the score, of the four best.

{markdown(found_rows(found, ranked(found)[:4]))}

## Pairs that cannot be told apart

{"; ".join(same) or "None"}.
"""
