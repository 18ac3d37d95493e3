"""Figures and tables of a report, from the cells of its grid."""

import html

from sweep.pages.cells import Cell, Value
from sweep.pages.svg import Point, Series, chart, key, outcome_table
from sweep.pages.words import WORDS, counted, labelled, named, short


def outcomes(cells: list[Cell], given: str) -> str:
    """How the runs ended: the first axis across, the second down, the others `given` in words."""
    names = list(cells[0].at)
    first, second = [*names, "", ""][:2]
    columns, rows = _values(cells, first), _values(cells, second)
    counts = [[_at(cells, {first: c, second: r}).counts for c in columns] for r in rows]
    across = labelled(first) if first else "all runs"
    table = outcome_table(named(rows), named(columns), counts, second, across)
    return f"<figure>{_given(given)}{table}</figure>"


def figures(cells: list[Cell], given: str) -> str:
    """Clearance time and persons out against the first axis, a series for each value of the second."""
    names = list(cells[0].at)
    if not names:
        return ""
    first, second = [*names, ""][:2]
    values = _values(cells, first)
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)
    places = [float(str(value)) if numbers else float(k) for k, value in enumerate(values)]
    time = [_series(cells, "clearance", "s", first, second, one, places) for one in _values(cells, second)]
    out = [_series(cells, "share_out", "", first, second, one, places) for one in _values(cells, second)]
    x = labelled(first)
    signs = key([one.name for one in time]) if second else ""
    parts = [
        (
            "Clearance time of the runs in which all got out",
            chart(time, places, named(values), x, "clearance time, s"),
        ),
        ("Share of the persons who got out, all runs", chart(out, places, named(values), x, "share out", 1.0)),
    ]
    if not any(one.points for one in time):
        parts[0] = (parts[0][0] + ": there is none", "")
    drawn = "".join(f"<figure><figcaption>{caption}</figcaption>{drawing}</figure>" for caption, drawing in parts)
    return f'{_given(given)}{signs}<div class="pair">{drawn}</div>'


def _series(
    cells: list[Cell], what: str, units: str, first: str, second: str, one: Value | None, places: list[float]
) -> Series:
    points = []
    for place, value in zip(places, _values(cells, first), strict=True):
        cell = _at(cells, {first: value, second: one})
        quantiles = getattr(cell, what)
        if quantiles:
            low, lower, middle, upper, high = quantiles
            all_out = cell.counts["all_out"]
            part = f"{all_out}/{cell.runs}" if what == "clearance" and all_out < cell.runs else ""
            points.append(Point(place, low, lower, middle, upper, high, _note(cell, quantiles, units), part))
    return Series(f"{second} = {short(one)}" if second else "", points)


def _note(cell: Cell, quantiles: tuple[float, ...], units: str) -> str:
    low, lower, middle, upper, high = (f"{value:.3g}" for value in quantiles)
    where = ", ".join(f"{name} = {short(value)}" for name, value in cell.at.items())
    return f"{where}: median {middle} {units}, quartiles {lower} to {upper}, range {low} to {high}; {counted(cell)}"


def table(cells: list[Cell]) -> str:
    """All numbers of the figures, a row for each cell."""
    axes = list(cells[0].at)
    shown = [word for word in WORDS if any(cell.counts[word] for cell in cells)]
    heads = [*map(labelled, axes), "runs", *(WORDS[word] for word in shown)]
    heads += ["clearance time, s: median", "quartiles", "range"]
    rows = []
    for cell in cells:
        values = [*named(list(cell.at.values())), str(cell.runs), *(str(cell.counts[word]) for word in shown)]
        if cell.clearance:
            low, lower, middle, upper, high = (f"{value:.1f}" for value in cell.clearance)
            values += [middle, f"{lower} to {upper}", f"{low} to {high}"]
        else:
            values += ["none", "", ""]
        rows.append("<tr>" + "".join(f"<td>{html.escape(value)}</td>" for value in values) + "</tr>")
    head = "".join(f'<th scope="col">{html.escape(name)}</th>' for name in heads)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _given(given: str) -> str:
    return f"<h3>{html.escape(given)}</h3>" if given else ""


def _values(cells: list[Cell], name: str) -> list[Value | None]:
    """Values of an axis; one, nothing, where there is no such axis."""
    return list(dict.fromkeys(cell.at.get(name) for cell in cells))


def _at(cells: list[Cell], at: dict[str, Value | None]) -> Cell:
    return next(cell for cell in cells if all(cell.at.get(name) == value for name, value in at.items()))
