"""The page that plays a recorded run."""

import html
from typing import Any

import numpy as np
import xarray as xr

from sweep.pages.description import parameters_of, provenance_of, title_of
from sweep.pages.motion import box_of, check_playable, common_top, force_on_each, speeds, thinned
from sweep.pages.packing import in_multiples, packed
from sweep.pages.template import asset, filled, page, rows_of
from sweep.pages.touching import Contacts, contacts_of

MM, MM_PER_S, NEWTON = 1e-3, 1e-3, 1.0  # to which a page holds places (m), speeds (m/s) and forces (N)
SCRIPTS = ("decode.js", "colours.js", "recording.js", "arches.js", "view.js", "curve.js", "player.js")
STYLES = ("page.css", "player.css")


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
    check_playable(run)
    run = thinned(run, every)
    contacts = contacts_of(run)
    facts = {**_scene(run), **_motion(run), **_touch(contacts), "exits": _exits(run)}
    facts |= {"end": float(run.end_time), "comment": str(run.attrs.get("comment", ""))}
    title = title_of(run)
    body = asset("player.html")
    words = {"title": html.escape(title), "outcome": html.escape(facts["comment"])}
    words |= {"parameters": rows_of(parameters_of(run)), "provenance": rows_of(provenance_of(run, contacts, every))}
    return page(title, filled(body, words), STYLES, SCRIPTS, facts)


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
    return {name: run[source].values[good].tolist() for name, source in kept.items()}
