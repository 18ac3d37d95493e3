"""A run in words: title, parameters, provenance."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from engine import OUTCOMES
from sweep.pages.template import version
from sweep.pages.touching import Contacts

Pairs = list[tuple[str, str]]


def title_of(run: xr.Dataset) -> str:
    """The crowd and its seed."""
    persons, speed = run.sizes["person"], float(run.v_d_person.mean())
    return f"{persons} persons, desired speed {speed:.3g} m/s, seed {_scenario(run).get('seed', 'unknown')}"


def parameters_of(run: xr.Dataset) -> Pairs:
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
    if "options" in scenario:
        described.append(("options", _spoken(scenario["options"] | {"is": ""})))
    return [*own, *((kind.replace("_", " "), text) for kind, text in described), ("seed", _seed(scenario))]


def provenance_of(run: xr.Dataset, contacts: Contacts, every: int) -> Pairs:
    """How the run ended, what of it the page shows and how exactly, and what computed it."""
    outcome = OUTCOMES[int(run.outcome)] if 0 <= int(run.outcome) < len(OUTCOMES) else "unknown"
    time = run.time.values
    step = f", one each {time[1] - time[0]:.4g} s" if time.size > 1 else ""
    part = f" (each of {every} recorded)" if every > 1 else ""
    known = {name: str(run.attrs[name]) for name in run.attrs if name.endswith("version") or name in ("run_key",)}
    return [
        ("outcome", f"{outcome} after {float(run.end_time):.4g} s, {run.exit_time.count().item()} persons out"),
        ("samples", f"{time.size}{step}{part}; positions in this page to 1 mm, between samples interpolated"),
        ("speed", "recorded" if "vx" in run else "from the positions of successive samples"),
        ("contacts", "recorded" if contacts.recorded else "none recorded; found from positions and radii"),
        (
            "contact force",
            "not recorded" if contacts.force is None else "on a person, sum of the recorded normal forces",
        ),
        ("engine", str(run.attrs.get("engine_fingerprint", "unknown"))),
        *((name.replace("_", " "), value) for name, value in known.items()),
        ("page made by", f"jamsweep {version()}"),
    ]


def _scenario(run: xr.Dataset) -> dict[str, Any]:
    try:
        plain = json.loads(run.attrs.get("scenario", "{}"))
    except ValueError:
        return {}
    return plain if isinstance(plain, dict) else {}


def _seed(scenario: Mapping[str, Any]) -> str:
    return str(scenario.get("seed", "unknown"))


def _range(values: np.ndarray) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{low:.3g}" if f"{low:.3g}" == f"{high:.3g}" else f"{low:.3g} to {high:.3g}"


def _spoken(part: Mapping[str, Any]) -> str:
    """A part of a scenario: "Hertz: k_n 3.56e+06 Pa, g_n 0.8"."""
    values = ", ".join(f"{name} {_short(value)}" for name, value in part.items() if name != "is")
    kind = str(part.get("is", ""))
    return f"{kind}: {values}" if values and kind else values or kind


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
