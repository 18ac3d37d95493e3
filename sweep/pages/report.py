"""The page that reports a sweep."""

import html
import itertools
import json
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from engine import FINGERPRINT, OUTCOMES
from engine.rooms import ROOMS
from sweep.pages.cells import Cell, Value, axes_of, cells_of
from sweep.pages.svg import Point, Series, chart, key, outcome_table
from sweep.pages.template import asset, filled, page, rows_of, version
from sweep.schema import PARAMETERS
from sweep.storage.store import Store

WORDS = {
    "all_out": "all out",
    "blocked": "blocked",
    "frozen": "frozen",
    "time_limit": "time limit",
    "unstable": "unstable",
    "missing": "missing",
}
SHOWN_FAILURES = 200


def report_page(ds: xr.Dataset, store: Store) -> str:
    """A self-contained HTML page of a sweep: grid, outcomes, figures, failures, provenance.

    Only runs in which everybody got out have a clearance time; how many others there are stands beside it.

    Parameters
    ----------
    ds : what `sweep.open_results` gives of the store
    store : for the manifest and the failures
    """
    cells = cells_of(ds)
    title = f"Sweep of {ds.attrs.get('room', 'a room')}"
    words = {
        "title": html.escape(title),
        "summary": _summary(ds, store),
        "outcomes": "".join(_outcomes(panel, given) for given, panel in _panels(ds, cells)),
        "legend": _legend(),
        "figures": "".join(_figures(ds, panel, given) for given, panel in _panels(ds, cells)),
        "table": _table(ds, cells),
        "failures": _failures(store),
        "grid": rows_of(_grid(ds)),
        "provenance": rows_of(_provenance(ds, store)),
        "again": _again(ds, store),
    }
    return page(title, filled(asset("report.html"), words), ("page.css", "report.css"), ("theme.js",))


def _summary(ds: xr.Dataset, store: Store) -> str:
    """Numbers of runs and their outcomes in a line, and whether the dataset is behind the store."""
    counts = {word: int((ds.outcome == code).sum()) for code, word in enumerate(OUTCOMES)}
    total = sum(counts.values())
    said = ", ".join(f"<b>{counts[word]}</b> {name}" for word, name in WORDS.items() if counts[word])
    line = f"{total - counts['missing']} of {total} runs done: {said}."
    behind = len(store.finished()) > total - counts["missing"] and counts["missing"]
    remedy = " The store holds more runs than this dataset: <code>jamsweep gather</code> brings those of the grid in."
    return line + (remedy if behind else "")


def _panels(ds: xr.Dataset, cells: list[Cell]) -> list[tuple[str, list[Cell]]]:
    """The cells parted by the third axis and later ones: what is given, and its cells."""
    further = list(axes_of(ds).items())[2:]
    panels = []
    for values in itertools.product(*(values for _, values in further)):
        given = dict(zip((name for name, _ in further), values, strict=True))
        inside = [cell for cell in cells if given.items() <= cell.at.items()]
        panels.append((", ".join(f"{name} = {_short(value)}" for name, value in given.items()), inside))
    return panels


def _outcomes(cells: list[Cell], given: str) -> str:
    names = list(cells[0].at)
    first, second = [*names, "", ""][:2]
    columns, rows = _values(cells, first), _values(cells, second)
    counts = [[_at(cells, {first: c, second: r}).counts for c in columns] for r in rows]
    across = _labelled(first) if first else "all runs"
    table = outcome_table(_named(rows), _named(columns), counts, second, across)
    return f"<figure>{_given(given)}{table}</figure>"


def _figures(ds: xr.Dataset, cells: list[Cell], given: str) -> str:
    names = list(cells[0].at)
    if not names:
        return ""
    first, second = [*names, ""][:2]
    values = _values(cells, first)
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)
    places = [float(str(value)) if numbers else float(k) for k, value in enumerate(values)]
    time = [_series(cells, "clearance", "s", first, second, one, places) for one in _values(cells, second)]
    out = [_series(cells, "share_out", "", first, second, one, places) for one in _values(cells, second)]
    x = _labelled(first)
    signs = key([one.name for one in time]) if second else ""
    parts = [
        (
            "Clearance time of the runs in which all got out",
            chart(time, places, _named(values), x, "clearance time, s"),
        ),
        ("Share of the persons who got out, all runs", chart(out, places, _named(values), x, "share out", 1.0)),
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
    return Series(f"{second} = {_short(one)}" if second else "", points)


def _note(cell: Cell, quantiles: tuple[float, ...], units: str) -> str:
    low, lower, middle, upper, high = (f"{value:.3g}" for value in quantiles)
    where = ", ".join(f"{name} = {_short(value)}" for name, value in cell.at.items())
    runs = ", ".join(f"{cell.counts[word]} {name}" for word, name in WORDS.items() if cell.counts[word])
    return f"{where}: median {middle} {units}, quartiles {lower} to {upper}, range {low} to {high}; {runs}"


def _table(ds: xr.Dataset, cells: list[Cell]) -> str:
    axes = list(axes_of(ds))
    shown = [word for word in WORDS if any(cell.counts[word] for cell in cells)]
    heads = [*map(_labelled, axes), "runs", *(WORDS[word] for word in shown)]
    heads += ["clearance time, s: median", "quartiles", "range"]
    rows = []
    for cell in cells:
        values = [*_named(list(cell.at.values())), str(cell.runs), *(str(cell.counts[word]) for word in shown)]
        if cell.clearance:
            low, lower, middle, upper, high = (f"{value:.1f}" for value in cell.clearance)
            values += [middle, f"{lower} to {upper}", f"{low} to {high}"]
        else:
            values += ["none", "", ""]
        rows.append("<tr>" + "".join(f"<td>{html.escape(value)}</td>" for value in values) + "</tr>")
    head = "".join(f'<th scope="col">{html.escape(name)}</th>' for name in heads)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _failures(store: Store) -> str:
    """One line for each file of a failed run: its parameters and its cause."""
    files = sorted(store.failed.glob("*.txt")) if store.failed.is_dir() else []
    if not files:
        return "<p>None.</p>"
    items = []
    for path in files[:SHOWN_FAILURES]:
        lines = path.read_text("utf-8", errors="replace").splitlines() or ["(empty)"]
        named = next(
            (line.removeprefix("parameters: ") for line in lines if line.startswith("parameters: ")), path.stem
        )
        items.append(f"<li><b>{html.escape(named)}</b>: {html.escape(lines[0])}</li>")
    more = f"<p>and {len(files) - SHOWN_FAILURES} more</p>" if len(files) > SHOWN_FAILURES else ""
    return f"<ul>{''.join(items)}</ul>{more}<p>In full in <code>failed/</code> of the store.</p>"


def _grid(ds: xr.Dataset) -> list[tuple[str, str]]:
    axes = [(_labelled(str(name)), _listed(ds[name].values.tolist())) for name in ds.outcome.dims]
    return [("room", str(ds.attrs.get("room", "unknown"))), *axes, *_parameters(ds, "constants", "held")]


def _parameters(ds: xr.Dataset, attribute: str, word: str) -> list[tuple[str, str]]:
    plain = _json(ds, attribute)
    defaults = ", ".join(f"{name} = {_short(value)}" for name, value in _json(ds, "defaults").items())
    held = [(_labelled(name), f"{_short(value)} ({word})") for name, value in plain.items()]
    return [*held, ("defaults", defaults)]


def _provenance(ds: xr.Dataset, store: Store) -> list[tuple[str, str]]:
    entries = list(store.finished().values())
    found = [
        ("engine", str(ds.attrs.get("engine_fingerprint", "unknown"))),
        ("schema version", str(ds.attrs.get("schema_version", "unknown"))),
        ("random numbers", str(ds.attrs.get("random_numbers", ""))),
        ("runs in the store", str(len(entries))),
    ]
    if entries:
        seconds = np.array([entry.duration for entry in entries])
        low, middle, high = np.quantile(seconds, (0.0, 0.5, 1.0))
        hosts = sorted({entry.host for entry in entries})
        found += [
            ("computed on", f"{', '.join(hosts)} ({len(hosts)} host{'s' * (len(hosts) > 1)})"),
            ("from, to", f"{min(e.when for e in entries)}, {max(e.when for e in entries)}"),
            (
                "time of computing",
                f"{_spoken(seconds.sum())} in all; {low:.3g} to {high:.3g} s a run, median {middle:.3g} s",
            ),
            ("size", f"{sum(entry.size for entry in entries) / 1e6:.1f} MB"),
        ]
    return [*found, ("page made by", f"jamsweep {version()}")]


def _spoken(seconds: float) -> str:
    return (
        f"{seconds:.3g} s"
        if seconds < 120
        else f"{seconds / 60:.3g} min"
        if seconds < 7200
        else f"{seconds / 3600:.3g} h"
    )


def _again(ds: xr.Dataset, store: Store) -> str:
    """What runs the sweep again, or what is missing of it."""
    grid = _json(ds, "grid")
    room, axes, constants = grid.get("room", ""), grid.get("axes", {}), grid.get("constants", {})
    if not room:
        return "<p>The dataset does not say.</p>"
    if room in ROOMS:
        parts = [f"room = {_toml(room)}", f"store = {_toml(store.path.name)}", "", "[axes]"]
        parts += [f"{name} = {_toml(values)}" for name, values in axes.items()]
        held = [f"{name} = {_toml(value)}" for name, value in constants.items()]
        parts += ["", "[constants]", *held] if held else []
        said = "As <code>grid.toml</code>; <code>jamsweep sweep grid.toml</code> runs what the store lacks."
    else:
        keywords = ", ".join(f"{name}={value!r}" for name, value in {**axes, **constants}.items())
        module, _, function = room.partition(":")
        parts = [f"from {module} import {function}", "from sweep import Grid, sweep", ""]
        parts += [f"sweep(Grid({function}, {keywords}), store={store.path.name!r})"]
        said = "In Python; runs what the store lacks."
    other = ds.attrs.get("engine_fingerprint") != FINGERPRINT
    said += f" The engine installed here is {FINGERPRINT}: it would run all of them anew." if other else ""
    return f"<p>{said}</p><pre>{html.escape(chr(10).join(parts))}</pre>"


def _toml(value: Any) -> str:
    """A value of TOML, which writes words, numbers and lists of them as JSON does."""
    return json.dumps(value)


def _legend() -> str:
    signs = "".join(f'<span><i class="o-{word}"></i>{name}</span>' for word, name in WORDS.items())
    return f'<p class="key">{signs}</p>'


def _json(ds: xr.Dataset, attribute: str) -> dict[str, Any]:
    try:
        plain = json.loads(ds.attrs.get(attribute, "{}"))
    except ValueError:
        return {}
    return plain if isinstance(plain, dict) else {}


def _given(given: str) -> str:
    return f"<h3>{html.escape(given)}</h3>" if given else ""


def _values(cells: list[Cell], name: str) -> list[Value | None]:
    """Values of an axis; one, nothing, where there is no such axis."""
    return list(dict.fromkeys(cell.at.get(name) for cell in cells))


def _at(cells: list[Cell], at: dict[str, Value | None]) -> Cell:
    return next(cell for cell in cells if all(cell.at.get(name) == value for name, value in at.items()))


def _labelled(name: str) -> str:
    units, _ = PARAMETERS.get(name, ("1", ""))
    return name if units == "1" else f"{name}, {spoken_units(units)}"


def spoken_units(units: str) -> str:
    """Units as a reader has them: "m s-1" is "m/s", "kg m-1 s-1" is "kg/(m s)"."""
    parts = [re.fullmatch(r"([A-Za-z]+)(-?\d*)", part) for part in units.split()]
    if not all(parts):
        return units
    found = [(part[1], int(part[2] or 1)) for part in parts if part]
    over, under = (
        [f"{name}{abs(power) if abs(power) > 1 else ''}" for name, power in found if (power > 0) == above]
        for above in (True, False)
    )
    below = f"({' '.join(under)})" if len(under) > 1 else "".join(under)
    return f"{' '.join(over) or '1'}/{below}" if under else " ".join(over)


def _named(values: Sequence[Value | None]) -> list[str]:
    return ["" if value is None else _short(value) for value in values]


def _listed(values: Sequence[Value]) -> str:
    few = list(values) if len(values) <= 24 else [*values[:3], "...", *values[-2:]]
    return f"{', '.join(map(_short, few))} ({len(values)})"


def _short(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
