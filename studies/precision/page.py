"""Results -> tables in Markdown, and the page of the docs."""

import datetime
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from studies.precision.bias import CONFIDENCE, LONG_DELAYS, MARGIN, NOT_SHOWN, SHOWN, Bias
from studies.precision.cells import Judged
from studies.precision.conservation import SIDE, SPEED, Drift
from studies.precision.conservation import N as GAS_N
from studies.precision.friction import DURATION, Friction
from studies.precision.front import pareto
from studies.precision.levels import Level, SpeedUp
from studies.precision.positions import Found, Point
from studies.precision.savings import JAMMED, Saving
from studies.precision.savings import V_D as SAVINGS_V_D
from studies.precision.savings import N as SAVINGS_N
from studies.precision.settings import Setting, chosen
from studies.presentation.machine import machine
from sweep.numerics import BETWEEN, QUANTITIES, Comparison

FIGURES = {
    "accuracy.png": "Root mean square error of the positions before chaos against CPU time",
    "accuracy-bias.png": "Bias of the statistics against the reference, with intervals",
    "accuracy-energy.png": "Drift of the energy of a passive, lossless crowd against the step",
}


class Results(NamedTuple):
    """All that was measured."""

    positions: list[Found]
    drifts: list[Drift]
    judged: list[Judged]
    frictions: list[Friction]
    levels: list[Level]
    speed_ups: list[SpeedUp]
    savings: list[Saving]

    def broken(self) -> list[str]:
        """What did not run: no findings, but defects."""
        failed = [f"{j.missing} runs of {j.cell}, {j.trial.name}, failed" for j in self.judged if j.missing]
        lost = [f"{f.case}: the reference is nowhere" for f in self.positions if any(map(_is_nan, f.floors))]
        return failed + lost


def _is_nan(point: Point) -> bool:
    return any(map(math.isnan, point.errors))


def tables(results: Results) -> str:
    """All tables, each under its heading."""
    parts = [
        ("Levels", _levels(results)),
        ("Friction at a step and at a quarter of it", _frictions(results.frictions)),
        ("Error of the positions before chaos", "\n\n".join(map(_positions, results.positions))),
        ("Energy where it is conserved", _drifts(results.drifts)),
        ("Bias of the statistics", _biases(results.judged)),
        ("What skipping saves", _savings(results.savings)),
    ]
    return "\n\n".join(f"## {heading}\n\n{text}" for heading, text in parts)


def page(results: Results, command: str) -> str:
    """docs/accuracy.md: what the default gets wrong, and what the levels cost."""
    return f"""# Accuracy

What the default numerics get wrong in seven crowds, against the same laws at a quarter of the time step, with a force
tolerance of 1 mN (the reference).

{_certificate(results)}

Each entry is default over reference, less 1, with its {CONFIDENCE:.0%} interval; blocked share: the difference,
in percentage points. "shown": the interval lies within +-{MARGIN:.0%} (delays above 2 s: +-{LONG_DELAYS[2.0]:.0%}), so
that the two are the same within that margin. "open": the interval reaches beyond; more seeds would decide, and until
then the number is not certified. "NO": it lies outside. Friction is that of the contacts between persons, weighted by
slip speed, at the step of the default and of the reference, each against a quarter of that step. Seeds decide nothing
about a jam. Delays: from the 10th exit to four fifths of the crowd.

![{FIGURES["accuracy.png"]}](accuracy.png)

{_levels(results)}

- "2%" is the default and is about statistics; "1mm" and "0.1mm" about positions before chaos.
- `jamsweep check-numerics ROOM ...` asks any room, also your own, whether its friction depends on the step.
- `numerics="paper"` has the paper's step and integrator, velocity Verlet as printed, first order with friction.
- All tables: [accuracy_tables.md](accuracy_tables.md), measured with `{command}`; the methods:
  [numerics.md](numerics.md).
"""


def _certificate(results: Results) -> str:
    tested = [j for j in results.judged if j.biases]
    quantities = [b.quantity for b in tested[0].biases]
    head = ("crowd", "runs", "friction: default", "reference", *quantities)
    rows = []
    for j in tested:
        frictions = [
            _friction(c) for f in results.frictions if f.cell == j.cell for c in f.comparisons if _weighted_persons(c)
        ]
        biases = [f"{_percent(b)[0]} {_percent(b)[1]} {_word(b)}" for b in j.biases]
        rows.append((str(j.cell), str(j.biases[0].pairs), *frictions, *biases))
    return _table(head, rows)


def _word(bias: Bias) -> str:
    return {SHOWN: "shown", NOT_SHOWN: "open"}.get(bias.verdict, "NO")


def _weighted_persons(c: Comparison) -> bool:
    return (c.between, c.quantity) == (BETWEEN[0], QUANTITIES[1])


def _friction(c: Comparison) -> str:
    word = {"yes": "shown"}.get(c.verdict(MARGIN), c.verdict(MARGIN))
    return f"{100 * c.difference:+.1f} % [{100 * c.low:+.1f}, {100 * c.high:+.1f}] {word}"


def raw(text: str, command: str, duration: float) -> str:
    """docs/accuracy_tables.md: all tables; `duration` in s."""
    today = datetime.date.today().isoformat()
    head = (
        f"# Tables of accuracy\n\nMeasured on {today} with `{command}` in {duration / 60:.1f} minutes on: {machine()}."
    )
    pictures = "\n\n".join(f"![{caption}]({name})" for name, caption in FIGURES.items())
    return f"{head}\n\nQuote the ratios: bare times are those of this machine on that day.\n\n{pictures}\n\n{text}\n"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


# --- Levels -------------------------------------------------------------------------------------------------


def _levels(results: Results) -> str:
    head = ("room", "level", "setting", "error of positions", "of the paper's CPU time", "holds")
    rows = [
        (
            level.room,
            level.name,
            str(level.setting),
            ", ".join(f"{1e3 * error:.2g} mm (v_d = {case.v_d:g} m/s)" for case, error, _ in level.errors),
            ", ".join(f"1/{saved:.3g}" for saved in level.saved),
            level.promise,
        )
        for level in results.levels
    ]
    notes = [
        "CPU time in the jam, for the desired speeds of the column before it; error: median over the seeds.",
        *(_speed_up(found) for found in results.speed_ups),
    ]
    return f"{_table(head, rows)}\n\n{_bullets(notes)}"


def _speed_up(found: SpeedUp) -> str:
    paper, default = sum(found.paper) / len(found.paper), sum(found.default) / len(found.default)
    return (
        f"Whole runs, {found.room}, v_d = {found.v_d:g} m/s, N = {found.N}: the default takes 1/{found.ratio:.3g} of "
        f'the CPU time of numerics="paper" (median of {len(found.paper)} seeds, in turn; {default:.2g} s and '
        f"{paper:.2g} s a run)."
    )


# --- Friction -----------------------------------------------------------------------------------------------


def _frictions(frictions: list[Friction]) -> str:
    head = ("crowd", "setting", "between", "quantity", "at dt", "at dt/4", "difference", "within 2 %")
    rows = [
        (str(f.cell), f"{f.trial.name}, {f.dt:g} s", c.between, c.quantity, f"{c.coarse:.4f}", f"{c.fine:.4f}", *told)
        for f in frictions
        for c in f.comparisons
        for told in [_friction(c).rpartition(" ")[::2]]
    ]
    notes = [
        f"Sums of abs(F_t) over those of abs(F_n), of all contacts and steps in {DURATION:g} s; intervals of "
        "90 %, seeds resampled.",
    ]
    return f"{_table(head, rows)}\n\n{_bullets(notes)}"


# --- Positions ----------------------------------------------------------------------------------------------


def _positions(found: Found) -> str:
    case = found.case
    names = {setting: name for name, setting in reversed(chosen(case.room).items())}
    front = {found.points[k].setting for k in pareto([(p.cost, p.error) for p in found.points])}
    rows = [(*_point(p), _marks(p, names, front, found.floor)) for p in sorted(found.points, key=lambda p: p.setting)]
    head = ("integrator, dt, force tolerance", "error, mm", "range, mm", "CPU s per simulated s", "")
    skins = [(*_point(p), "adapted" if p.setting.skin == 0.0 else "") for p in found.skins]
    floors = "; ".join(f"{p.setting}: {1e3 * p.error:.2g} mm" for p in found.floors) or "not measured"
    notes = [
        f"Root mean square over {case.N} persons, median and range of {len(found.points[0].errors)} seeds, against "
        f"{case.reference}. Other references part from it by: {floors}.",
        f"At that time {found.touching:.0f} of them touch another or a wall (mean over the seeds).",
        f"CPU time in the jam after {JAMMED:g} s. Front: nothing else is both cheaper and more exact.",
    ]
    if found.refused:
        notes.append(f"Refused, beyond the longest step: {_refused(found.refused)}.")
    return f"### {case}\n\n{_table(head, rows)}\n\nThe skin of the lists:\n\n{_table(head, skins)}\n\n{_bullets(notes)}"


def _point(point: Point) -> tuple[str, str, str, str]:
    low, high = min(point.errors), max(point.errors)
    return (
        str(point.setting),
        f"{1e3 * point.error:.2g}",
        f"{1e3 * low:.2g} to {1e3 * high:.2g}",
        f"{point.cost:.3g}",
    )


def _marks(point: Point, names: dict[Setting, str], front: set[Setting], floor: float) -> str:
    words = [names[point.setting]] if point.setting in names else []
    words += ["front"] if point.setting in front else []
    words += ["at the floor"] if point.error < 3.0 * floor else []
    return ", ".join(words)


def _refused(settings: Iterable[Setting]) -> str:
    pairs = dict.fromkeys((s.integrator, s.dt) for s in settings)
    return ", ".join(f"{integrator} at {dt:g} s" for integrator, dt in pairs)


# --- Energy -------------------------------------------------------------------------------------------------


def _drifts(drifts: list[Drift]) -> str:
    head = ("contacts", "integrator", "dt, s", "drift", "swing", "outcome")
    rows = [
        (d.gas, d.setting.integrator, f"{d.setting.dt:g}", f"{d.drift:+.1e}", f"{d.swing:.1e}", d.outcome)
        for d in drifts
    ]
    notes = [
        f"{GAS_N} persons with social force in a closed box of {SIDE:g} m, {SPEED:g} m/s at the start, neither driven "
        "nor damped nor rubbed. Drift: mean of the last quarter of the run over that of the first, less 1; swing: "
        "standard deviation in time, as a part of the energy.",
        "The leapfrog's velocities stand half a step before its positions, which are taken back by as much.",
        "Steps beyond the longest one allowed are left out.",
    ]
    return f"{_table(head, rows)}\n\n{_bullets(notes)}"


# --- Statistics ---------------------------------------------------------------------------------------------


def _biases(judged: list[Judged]) -> str:
    cells = dict.fromkeys(j.cell for j in judged)
    parts = [_cell([j for j in judged if j.cell is cell]) for cell in cells]
    notes = [
        f"The same seeds with both settings. Relative bias of means, difference of blocked shares in percentage "
        f"points, with intervals of {CONFIDENCE:.0%} (bootstrap over seeds; shares: Newcombe 1998).",
        "shown: the interval lies within the margin; violated: wholly outside; not shown: the seeds do not "
        "decide. Used: runs that the statistic rests on, setting/reference.",
        "Blocked, unstable and time-limit runs are counted and never averaged into a clearance time. Delays: from the "
        "10th exit to four fifths of the crowd.",
    ]
    return "\n\n".join([*parts, _bullets(notes)])


def _cell(judged: list[Judged]) -> str:
    head = ("setting", "seeds", "statistic", "bias", f"{CONFIDENCE:.0%} interval", "used", "margin", "within it")
    trials = [
        (j.trial.name, "" if j.setting is None else str(j.setting), j.outcomes, "" if _refusal(j) else _time(j))
        for j in judged
    ]
    rows = [row for j in judged for row in _bias_rows(j)]
    settings = _table(("setting", "numerics", "outcomes", "s a run"), trials)
    return f"### {judged[0].cell}\n\nReference: {judged[0].trial.name}.\n\n{settings}\n\n{_table(head, rows)}"


def _refusal(judged: Judged) -> bool:
    return judged.setting is None


def _time(judged: Judged) -> str:
    return f"{judged.duration:.2g}"


def _bias_rows(judged: Judged) -> Iterator[tuple[str, ...]]:
    for b in judged.biases:
        used = f"{b.used[0]}/{b.used[1]}"
        yield (
            judged.trial.name,
            str(b.pairs),
            b.quantity,
            *_percent(b),
            used,
            f"{b.margin:.0%}",
            f"{b.verdict} with {b.pairs} seeds",
        )


def _percent(bias: Bias) -> tuple[str, str]:
    unit = "pp" if "blocked" in bias.quantity else "%"
    value, low, high = (100.0 * v for v in (bias.value, bias.low, bias.high))
    told = f"{value:+.2f} {unit}" if math.isfinite(value) else "undefined"
    return told, f"[{low:+.2f}, {high:+.2f}]" if math.isfinite(low + high) else "none"


# --- Savings ------------------------------------------------------------------------------------------------


def _savings(savings: list[Saving]) -> str:
    rows = [(s.what, f"{s.ratio:.2f}", s.remark) for s in savings]
    note = (
        f"CPU time of a step with it over without it, medians of turns, {SAVINGS_N} persons in Lin's room at "
        f"{SAVINGS_V_D:g} m/s from {JAMMED:g} s on, default numerics."
    )
    return f"{_table(('what', 'ratio', ''), rows)}\n\n{_bullets([note])}"
