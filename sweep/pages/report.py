"""The page that reports a sweep."""

import html
import itertools
import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from engine import FINGERPRINT, OUTCOMES
from engine.rooms import ROOMS
from sweep.grid import CHOICE
from sweep.pages.cells import Cell, Value, axes_of, cells_of
from sweep.pages.figures import figures, outcomes, table
from sweep.pages.template import asset, filled, page, rows_of, version
from sweep.pages.words import WORDS, labelled, short
from sweep.storage.store import Store

SHOWN_FAILURES, SHOWN_PANELS = 200, 24


def report_page(ds: xr.Dataset, store: Store) -> str:
    """A self-contained HTML page of a sweep: grid, outcomes, figures, failures, provenance.

    Only runs in which everybody got out have a clearance time; how many others there are stands beside it.

    Parameters
    ----------
    ds : what `sweep.open_results` gives of the store
    store : for the manifest and the failures
    """
    cells = cells_of(ds)
    panels = _panels(ds, cells)
    title = f"Sweep of {ds.attrs.get('room', 'a room')}"
    words = {
        "title": html.escape(title),
        "summary": _summary(ds, store),
        "outcomes": "".join(outcomes(panel, given) for given, panel in panels[:SHOWN_PANELS]),
        "legend": _legend(),
        "more": _more(len(panels)),
        "figures": "".join(figures(panel, given) for given, panel in panels[:SHOWN_PANELS]),
        "table": table(cells),
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
        panels.append((", ".join(f"{name} = {short(value)}" for name, value in given.items()), inside))
    return panels


def _more(panels: int) -> str:
    hidden = panels - SHOWN_PANELS
    return f"<p>{hidden} more combinations of the further axes stand in the table alone.</p>" if hidden > 0 else ""


def _failures(store: Store) -> str:
    """One line for each file of a failed run: its parameters and its cause."""
    files = sorted(store.failed.glob("*.txt")) if store.failed.is_dir() else []
    if not files:
        return "<p>None.</p>"
    items = []
    for path in files[:SHOWN_FAILURES]:
        lines = path.read_text("utf-8", errors="replace").splitlines() or ["(empty)"]
        named = _after("parameters: ", lines) or path.stem
        again = _after("again: ", lines)
        command = f"<br><code>{html.escape(again)}</code>" if again else ""
        items.append(f"<li><b>{html.escape(named)}</b>: {html.escape(lines[0])}{command}</li>")
    more = f"<p>and {len(files) - SHOWN_FAILURES} more</p>" if len(files) > SHOWN_FAILURES else ""
    where = "<p>Of all grids swept into this store; in full in its folder <code>failed/</code>.</p>"
    return f"<ul>{''.join(items)}</ul>{more}{where}"


def _after(word: str, lines: list[str]) -> str:
    """The rest of the first line that begins with a word."""
    return next((line.removeprefix(word) for line in lines if line.startswith(word)), "")


def _grid(ds: xr.Dataset) -> list[tuple[str, str]]:
    axes = [(labelled(str(name)), _listed(ds[name].values.tolist())) for name in ds.outcome.dims]
    return [("room", str(ds.attrs.get("room", "unknown"))), *axes, *_parameters(ds, "constants", "held")]


def _parameters(ds: xr.Dataset, attribute: str, word: str) -> list[tuple[str, str]]:
    plain = _json(ds, attribute)
    defaults = ", ".join(f"{name} = {short(value)}" for name, value in _json(ds, "defaults").items())
    held = [(labelled(name), f"{short(value)} ({word})") for name, value in plain.items()]
    return [*held, ("defaults", defaults)]


def _provenance(ds: xr.Dataset, store: Store) -> list[tuple[str, str]]:
    entries = list(store.finished().values())
    found = [
        ("engine", str(ds.attrs.get("engine_fingerprint", "unknown"))),
        *(("also runs of engines", ", ".join(_json(ds, name))) for name in ["accepted_engines"] if name in ds.attrs),
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
        parts = [f"room = {_toml(room)}", f"store = {_toml(store.path.name)}"]
        parts += [f"{CHOICE} = false"] if grid.get(CHOICE) is False else []
        parts += ["", "[axes]"]
        parts += [f"{name} = {_toml(values)}" for name, values in axes.items()]
        held = [f"{name} = {_toml(value)}" for name, value in constants.items()]
        parts += ["", "[constants]", *held] if held else []
        said = "As <code>grid.toml</code>; <code>jamsweep sweep grid.toml</code> runs what the store lacks."
    else:
        keywords = ", ".join(f"{name}={value!r}" for name, value in {**axes, **constants}.items())
        module, _, function = room.partition(":")
        parts = [f"from {module} import {function}", "from sweep import Grid, sweep", ""]
        own = f", {CHOICE}=False" if grid.get(CHOICE) is False else ""
        parts += [f"sweep(Grid({function}, {keywords}{own}), store={store.path.name!r})"]
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


def _listed(values: Sequence[Value]) -> str:
    few = list(values) if len(values) <= 24 else [*values[:3], "...", *values[-2:]]
    return f"{', '.join(map(short, few))} ({len(values)})"
