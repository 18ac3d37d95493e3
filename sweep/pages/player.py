"""The page that plays a recorded run."""

import html
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from engine import OUTCOMES
from engine.errors import require
from sweep.pages.packing import in_multiples, packed
from sweep.pages.template import asset, filled, page, rows_of, version
from sweep.pages.touching import Contacts, contacts_of

MM, MM_PER_S, NEWTON = 1e-3, 1e-3, 1.0  # to which a page holds places (m), speeds (m/s) and forces (N)
SCRIPTS = ("decode.js", "colours.js", "recording.js", "arches.js", "view.js", "curve.js", "player.js")
STYLES = ("page.css", "player.css")
NEEDED = ("exit_time", "exit_person", "radius", "wall", "door", "outcome")  # of a run file
MARGIN = 1.5  # m, beyond walls and persons
COMMON = 0.99  # share of values that the scale of colours spans


def player_page(run: xr.Dataset, every: int = 1) -> str:
    """A self-contained HTML page that plays a run.

    Parameters
    ----------
    run : one run with samples, as `sweep.read_run` and `sweep.to_dataset` give it
    every : int
        Show each sample of this many.

    Raises
    ------
    BadInput
        If the dataset is no run, or the run has no samples.
    """
    run = thinned(run, every)
    contacts = contacts_of(run)
    facts = {**_scene(run), **_motion(run), **_touch(contacts), "exits": _exits(run)}
    facts |= {"end": float(run.end_time), "comment": str(run.attrs.get("comment", ""))}
    title = _title(run)
    body = asset("player.html")
    words = {"title": html.escape(title), "outcome": html.escape(facts["comment"])}
    words |= {"parameters": rows_of(_parameters(run)), "provenance": rows_of(_provenance(run, contacts, every))}
    return page(title, filled(body, words), STYLES, SCRIPTS, facts)


def check_playable(run: xr.Dataset, name: str = "dataset") -> None:
    """Raise `BadInput` unless this is one run, and it has samples."""
    whole = all(part in run.variables for part in NEEDED) and run.outcome.ndim == 0
    require(whole, "run file", f"'{name}'", "holds no run", "name a file that `jamsweep run ... -o` wrote")
    remedy = "run it again with `--every 0.1`, and `--contacts` to see who touches whom"
    require("time" in run and run.sizes["sample"] > 0, "run", f"'{name}'", "has no samples to play", remedy)


def thinned(run: xr.Dataset, every: int) -> xr.Dataset:
    """The run with each sample of so many, and their contacts.

    Raises
    ------
    BadInput
        If the dataset is no run, or the run has no samples.
    """
    check_playable(run)
    if every == 1:
        return run
    kept = np.arange(0, run.sizes["sample"], every)
    selected = {"sample": kept}
    if "row_size" in run:
        of_sample = np.repeat(np.arange(run.sizes["sample"]), run.row_size.values)
        selected["contact"] = np.flatnonzero(of_sample % every == 0)
    return run.isel(selected)


def speeds(run: xr.Dataset) -> np.ndarray:
    """Speed of each person at each sample, m/s: recorded, or the way to the next sample over its time."""
    if "vx" in run:
        return np.hypot(run.vx.values, run.vy.values)
    x, y, time = run.x.values, run.y.values, run.time.values
    if time.size < 2:
        return np.where(np.isfinite(x), 0.0, np.nan)
    ahead = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0)) / np.diff(time)[:, None]
    last = np.vstack([np.full(x.shape[1], np.nan), ahead])
    found = np.where(np.isfinite(np.vstack([ahead, ahead[-1:]])), np.vstack([ahead, ahead[-1:]]), last)
    return np.where(np.isfinite(x), np.where(np.isfinite(found), found, 0.0), np.nan)


def force_on_each(contacts: Contacts, persons: int) -> np.ndarray:
    """Sum of the normal contact forces on each person at each sample, N: (samples, persons)."""
    samples = contacts.row_size.size
    force = np.zeros((samples, persons))
    if contacts.force is not None:
        sample = np.repeat(np.arange(samples), contacts.row_size)
        np.add.at(force, (sample, contacts.i), contacts.force)
        pair = contacts.j >= 0
        np.add.at(force, (sample[pair], contacts.j[pair]), contacts.force[pair])
    return force


def common_top(values: np.ndarray, least: float) -> float:
    """A round number that nearly all positive values lie below, for the top of a scale."""
    positive = values[np.isfinite(values) & (values > 0)]
    top = max(float(np.quantile(positive, COMMON)) if positive.size else 0.0, least)
    step = 10.0 ** np.floor(np.log10(top)) / 2
    return float(np.ceil(top / step - 1e-9) * step)


def box_of(run: xr.Dataset) -> tuple[float, float, float, float]:
    """What a picture shows, m: walls, doors and all places, with a margin: x0, y0, x1, y1."""
    lines = np.concatenate([run.wall.values, run.door.values]).reshape(-1, 2)
    x = np.concatenate([lines[:, 0], run.x.values[np.isfinite(run.x.values)]])
    y = np.concatenate([lines[:, 1], run.y.values[np.isfinite(run.y.values)]])
    return (
        float(x.min()) - MARGIN,
        float(y.min()) - MARGIN,
        float(x.max()) + MARGIN,
        float(y.max()) + MARGIN,
    )


def _scene(run: xr.Dataset) -> dict[str, Any]:
    return {
        "box": box_of(run),
        "walls": run.wall.values.tolist(),
        "doors": run.door.values.tolist(),
        "radius": np.round(run.radius.values, 6).tolist(),
    }


def _motion(run: xr.Dataset) -> dict[str, Any]:
    moving = speeds(run)
    return {
        "time": np.round(run.time.values, 6).tolist(),
        "x": packed(in_multiples(run.x.values.T, MM), differences=True),
        "y": packed(in_multiples(run.y.values.T, MM), differences=True),
        "speed": packed(in_multiples(moving.T, MM_PER_S), differences=True),
        "speedTop": common_top(moving, 0.1),
    }


def _touch(contacts: Contacts) -> dict[str, Any]:
    persons = int(max(contacts.i.max(initial=0), contacts.j.max(initial=0))) + 1
    force = None if contacts.force is None else packed(in_multiples(contacts.force, NEWTON))
    return {
        "rowSize": packed(contacts.row_size),
        "contactI": packed(contacts.i, differences=True),
        "contactJ": packed(contacts.j),
        "contactForce": force,
        "forceTop": common_top(force_on_each(contacts, persons), 100.0),
    }


def _exits(run: xr.Dataset) -> dict[str, list[float]]:
    good = np.isfinite(run.exit_time.values)
    kept = {"time": "exit_time", "person": "exit_person", "x": "exit_x", "y": "exit_y"}
    return {name: np.round(run[source].values[good], 6).tolist() for name, source in kept.items()}


def _title(run: xr.Dataset) -> str:
    persons, speed = run.sizes["person"], float(run.v_d_person.mean())
    return f"{persons} persons, desired speed {speed:.3g} m/s, seed {_scenario(run).get('seed', 'unknown')}"


def _scenario(run: xr.Dataset) -> dict[str, Any]:
    try:
        plain = json.loads(run.attrs.get("scenario", "{}"))
    except ValueError:
        return {}
    return plain if isinstance(plain, dict) else {}


def _parameters(run: xr.Dataset) -> list[tuple[str, str]]:
    """Laws, crowd and numerics as the run's own description has them, one line a part."""
    radius, mass = run.radius.values, run.mass.values
    doors = np.hypot(*(run.door.values[:, 2:] - run.door.values[:, :2]).T)
    own = [
        ("persons", f"{run.sizes['person']}, radius {_range(radius)} m, mass {_range(mass)} kg"),
        ("desired speed", f"{_range(run.v_d_person.values)} m/s"),
        ("exits", ", ".join(f"{width:.3g} m" for width in doors) or "none"),
    ]
    scenario = _scenario(run)
    laws = scenario.get("model", {})
    described = [(kind, _spoken(law)) for kind, law in laws.items() if isinstance(law, dict) and kind != "is"]
    rest = [(part, _spoken(scenario[part])) for part in ("numerics", "stopping", "record") if part in scenario]
    return [*own, *((kind.replace("_", " "), text) for kind, text in described), *rest, ("seed", _seed(scenario))]


def _seed(scenario: Mapping[str, Any]) -> str:
    return str(scenario.get("seed", "unknown"))


def _range(values: np.ndarray) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{low:.3g}" if f"{low:.3g}" == f"{high:.3g}" else f"{low:.3g} to {high:.3g}"


def _spoken(part: Mapping[str, Any]) -> str:
    """A part of a scenario: "Hertz: k_n 3.56e+06 Pa, g_n 0.8"."""
    values = ", ".join(f"{name} {_short(value)}" for name, value in part.items() if name != "is")
    kind = str(part.get("is", ""))
    return f"{kind}: {values}" if values else kind


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _provenance(run: xr.Dataset, contacts: Contacts, every: int) -> list[tuple[str, str]]:
    outcome = OUTCOMES[int(run.outcome)] if 0 <= int(run.outcome) < len(OUTCOMES) else "unknown"
    time = run.time.values
    step = f", one each {time[1] - time[0]:.4g} s" if time.size > 1 else ""
    part = f" (each of {every} recorded)" if every > 1 else ""
    law = "elastic part of the normal contact law at the overlap of the recorded places"
    known = {name: str(run.attrs[name]) for name in run.attrs if name.endswith("version") or name in ("run_key",)}
    return [
        ("outcome", f"{outcome} after {float(run.end_time):.4g} s, {run.exit_time.count().item()} persons out"),
        ("samples", f"{time.size}{step}{part}; places in this page to 1 mm, between samples interpolated"),
        ("speed", "recorded" if "vx" in run else "from the places of successive samples"),
        ("contacts", "recorded" if contacts.recorded else "none recorded; found from places and radii"),
        ("contact force", "law not known to this engine" if contacts.force is None else f"on a person, sum of: {law}"),
        ("engine", str(run.attrs.get("engine_fingerprint", "unknown"))),
        *((name.replace("_", " "), value) for name, value in known.items()),
        ("page made by", f"jamsweep {version()}"),
    ]
