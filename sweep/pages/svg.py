"""Figures of a report as SVG, coloured by the page's style."""

import html
import math
from collections.abc import Sequence
from typing import NamedTuple

WIDTH, HEIGHT = 680, 330  # of a chart
LEFT, RIGHT, TOP, BOTTOM = 62, 16, 12, 46
MARKS = ("circle", "square", "diamond", "triangle", "down", "cross", "beam")  # 7, and 6 colours: 42 pairs
CORNERS: dict[str, list[tuple[float, float]]] = {
    "square": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
    "diamond": [(0, -1.3), (1.3, 0), (0, 1.3), (-1.3, 0)],
    "triangle": [(0, -1.2), (1.1, 0.9), (-1.1, 0.9)],
    "down": [(0, 1.2), (1.1, -0.9), (-1.1, -0.9)],
    "beam": [(-1.4, -0.5), (1.4, -0.5), (1.4, 0.5), (-1.4, 0.5)],
    "cross": [(-1, -1), (0, -0.4), (1, -1), (0.4, 0), (1, 1), (0, 0.4), (-1, 1), (-0.4, 0)],
}
MOST_COUNTS = 60  # marks with room for numbers of runs beside them
LETTERS = 56  # that fit below a chart
APART = 7.0  # px, by which series at the same value stand beside each other
CELL, ROW, NAMES = 92, 40, 74  # of an outcome table


class Point(NamedTuple):
    """Quantiles of the runs at one value of the axis; `note` tells them in words."""

    place: float
    low: float
    lower: float
    middle: float
    upper: float
    high: float
    note: str
    part: str = ""  # "7/10" where not all runs have the quantity: the mark is hollow, and says so


class Series(NamedTuple):
    """Points of one value of the second axis."""

    name: str
    points: Sequence[Point]


def chart(
    series: Sequence[Series],
    places: Sequence[float],
    names: Sequence[str],
    x_label: str,
    y_label: str,
    top: float | None = None,
) -> str:
    """Medians against an axis, with a thick bar from quartile to quartile and a thin one from least to most.

    Parameters
    ----------
    series : what to draw; each with a colour and a mark of its own
    places, names : where the axis' values stand, and what they are called
    x_label, y_label : with units
    top : of the vertical axis; what the data need if not given
    """
    highest = top or max((p.high for s in series for p in s.points), default=1.0) * 1.1 or 1.0
    low, high = min(places), max(places)
    reach = (high - low) or 1.0

    def px(place: float) -> float:
        return LEFT + 28 + (place - low) / reach * (WIDTH - LEFT - RIGHT - 56)

    def py(value: float) -> float:
        return HEIGHT - BOTTOM - value / highest * (HEIGHT - TOP - BOTTOM)

    parts = [_frame(y_label, x_label)]
    for tick in ticks(highest):
        parts.append(f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{py(tick):.1f}" y2="{py(tick):.1f}"/>')
        parts.append(_text(LEFT - 8, py(tick) + 4, f"{tick:g}", "end"))
    apart = math.ceil(len(names) * max(map(len, names)) / LETTERS)
    named = list(zip(places, names, strict=True))[::apart]
    parts += [_text(px(p), HEIGHT - BOTTOM + 18, n, "middle") for p, n in named]
    roomy = len(series) * len(names) <= MOST_COUNTS
    for k, one in enumerate(series):
        shift = (k - (len(series) - 1) / 2) * APART
        drawn = [(px(p.place) + shift, p) for p in one.points]
        line = " ".join(f"{x:.1f},{py(p.middle):.1f}" for x, p in drawn)
        parts.append(f'<g class="series s{k % 6}"><polyline points="{line}"/>')
        for x, p in drawn:
            title = f"<title>{html.escape(p.note)}</title>"
            thin = f'<line class="thin" x1="{x:.1f}" x2="{x:.1f}" y1="{py(p.low):.1f}" y2="{py(p.high):.1f}"/>'
            thick = f'<line class="thick" x1="{x:.1f}" x2="{x:.1f}" y1="{py(p.lower):.1f}" y2="{py(p.upper):.1f}"/>'
            count = _text(x, max(py(p.high) - 9, TOP + 4), p.part, "middle") if p.part and roomy else ""
            some = ' class="some"' if p.part else ""
            parts.append(f"<g{some}>{title}{thin}{thick}{_mark(k, x, py(p.middle))}{count}</g>")
        parts.append("</g>")
    label = html.escape(f"{y_label} against {x_label}")
    return f'<svg class="chart" role="img" aria-label="{label}" viewBox="0 0 {WIDTH} {HEIGHT}">{"".join(parts)}</svg>'


def key(names: Sequence[str]) -> str:
    """What the marks of the series mean."""
    signs = "".join(
        f'<span><svg class="mark" viewBox="0 0 16 16" aria-hidden="true"><g class="series s{k % 6}">'
        f"{_mark(k, 8, 8)}</g></svg>{html.escape(name)}</span>"
        for k, name in enumerate(names)
    )
    return f'<p class="key">{signs}</p>'


def outcome_table(
    rows: Sequence[str], columns: Sequence[str], counts: Sequence[Sequence[dict[str, int]]], corner: str, across: str
) -> str:
    """How the runs of each cell ended: a bar shared out among outcomes, over the number that got all out.

    Parameters
    ----------
    rows, columns : names of the cells' rows and columns
    counts : outcome -> number of runs, for each row and column
    corner, across : what rows and columns are
    """
    width, height = NAMES + CELL * len(columns) + 4, 2 * 20 + ROW * len(rows)
    parts = [_text(0, 34, corner, "start"), _text(NAMES, 14, across, "start")]
    parts += [_text(NAMES + CELL * (k + 0.5) - 4, 34, name, "middle") for k, name in enumerate(columns)]
    for r, name in enumerate(rows):
        y = 42 + ROW * r
        parts.append(_text(NAMES - 12, y + 20, name, "end"))
        parts += [_bar(NAMES + CELL * c, y, counts[r][c], f"{name}, {columns[c]}") for c in range(len(columns))]
    label = html.escape(f"Outcomes for each {corner} and {across}")
    box = f'width="{width}" height="{height + 4}" viewBox="0 0 {width} {height + 4}"'
    return f'<svg class="outcomes" role="img" aria-label="{label}" {box}>{"".join(parts)}</svg>'


def ticks(top: float, about: int = 5) -> list[float]:
    """Round numbers from 0 to `top`, about so many."""
    raw = top / about
    ten = 10.0 ** math.floor(math.log10(raw))
    step = next(part * ten for part in (1, 2, 5, 10) if part * ten >= raw * (1 - 1e-9))
    return [float(f"{k * step:.12g}") for k in range(int(top / step + 1e-9) + 1)]


def _bar(x: float, y: float, counts: dict[str, int], where: str) -> str:
    total = sum(counts.values())
    said = ", ".join(f"{number} {outcome}" for outcome, number in counts.items() if number)
    parts, at = [f"<title>{html.escape(f'{where}: {said}')}</title>"], x
    order = sorted(counts, key=lambda outcome: (outcome != "all_out", outcome == "missing"))
    for outcome in order:
        wide = (CELL - 8) * counts[outcome] / max(total, 1)
        if wide:
            parts.append(f'<rect class="o-{outcome}" x="{at:.1f}" y="{y + 18}" width="{wide:.1f}" height="14"/>')
        at += wide
    parts.append(_text(x + (CELL - 8) / 2, y + 13, f"{counts['all_out']} of {total}", "middle"))
    return f"<g>{''.join(parts)}</g>"


def _frame(y_label: str, x_label: str) -> str:
    middle = (TOP + HEIGHT - BOTTOM) / 2
    turned = f'transform="rotate(-90 16 {middle})"'
    return (
        f'<line class="axis" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{HEIGHT - BOTTOM}" y2="{HEIGHT - BOTTOM}"/>'
        + _text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_label, "middle")
        + f'<text x="16" y="{middle}" text-anchor="middle" {turned}>{html.escape(y_label)}</text>'
    )


def _text(x: float, y: float, words: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{html.escape(words)}</text>'


def _mark(k: int, x: float, y: float) -> str:
    kind, a = MARKS[k % len(MARKS)], 5.0
    if kind == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{a}"/>'
    corners = " ".join(f"{x + a * u:.1f},{y + a * v:.1f}" for u, v in CORNERS[kind])
    return f'<polygon points="{corners}"/>'
