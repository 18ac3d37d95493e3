"""Figure 7 of Lin, Ma & Lo (2016): leaving curves and clearance times of 200 persons against desired speed."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies.lin import artefact, leaving
from studies.lin.sweeps import Sweeps
from studies.presentation.estimates import NEAR, at, each
from studies.presentation.verdicts import Verdict
from studies.published import lin2016 as paper

PLATEAU = (1.2, 1.6)  # m/s: inside the published range of 1.0 to 1.8, whose ends have statements of their own


def measure(sweeps: Sweeps) -> xr.Dataset:
    """All runs of 200 persons."""
    return leaving.measure(sweeps, paper.FIG7_N)


def plot(found: xr.Dataset) -> Figure:
    """Both panels, with the published times."""
    plateau = dict.fromkeys(at(found, *PLATEAU).v_d.values.tolist(), paper.FIG7_PLATEAU_CLEARANCE_TIME)
    return leaving.plot(found, paper.FIG7_CLEARANCE_TIME | plateau)


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Published times, their fall up to 1 m/s, the plateau, and total blockage."""
    listed = {v: t for v, t in paper.FIG7_CLEARANCE_TIME.items() if v in found.v_d.values}
    return [
        *(artefact.published_time(f"clearance time at {v} m/s", found.sel(v_d=v), t) for v, t in listed.items()),
        falls(found),
        *(
            artefact.published_time(f"clearance time at {v:g} m/s", found.sel(v_d=v), paper.FIG7_PLATEAU_CLEARANCE_TIME)
            for v in at(found, *PLATEAU).v_d.values
        ),
        _blocked(found),
    ]


def falls(found: xr.Dataset) -> Verdict:
    """Clearance time falls in the smooth state."""
    cells = at(found, *paper.SMOOTH_V_D)
    falling = bool((np.diff(cells.clearance_time.values) < 0).all()) if cells.v_d.size > 1 else None
    return Verdict(
        "clearance time falls from 0.6 to 1.0 m/s", "falling", f"{each(cells, 'clearance_time', 0)} s", falling
    )


def _blocked(found: xr.Dataset) -> Verdict:
    """Every run blocks from 1.8 m/s on: no where a run got out, open where there is no such cell."""
    cells = found.sel(v_d=found.v_d >= paper.FIG7_BLOCKED_FROM - NEAR)
    text = ", ".join(f"{v:g} m/s: {artefact.blocked_words(cells.sel(v_d=v))}" for v in cells.v_d.values)
    every = bool((cells.blocked == cells.runs).all()) if cells.v_d.size else None
    return Verdict(f"every run blocks from {paper.FIG7_BLOCKED_FROM} m/s", "all", text, every)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
