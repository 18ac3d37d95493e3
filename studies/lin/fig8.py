"""Figure 8 of Lin, Ma & Lo (2016): leaving curves and clearance times of 300 persons against desired speed."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies.lin import artefact, leaving
from studies.lin.fig7 import falls
from studies.lin.sweeps import Sweeps
from studies.presentation.estimates import at
from studies.presentation.verdicts import Verdict
from studies.published import lin2016 as paper

BISTABLE = (1.6, 2.0)  # m/s: the phase separation state as the paper scans it


def measure(sweeps: Sweeps) -> xr.Dataset:
    """All runs of 300 persons."""
    return leaving.measure(sweeps, paper.FIG8_N)


def plot(found: xr.Dataset) -> Figure:
    """Both panels; the paper states no times of 300 persons."""
    return leaving.plot(found)


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """The results agree with those of 200 persons: time falls, then does not, then runs block or do not."""
    return [falls(found), _no_faster(found), _bistable(found)]


def _no_faster(found: xr.Dataset) -> Verdict:
    """From 1.0 to 1.4 m/s the mean time changes by less than the tolerance; beyond, most runs block."""
    cells = at(found, 1.0, 1.4)
    mean = cells.clearance_time.values
    if not np.isfinite(mean).all() or cells.v_d.size < 2:
        return Verdict("1.0 to 1.4 m/s: no shorter with v_d", "no trend", "some cell has no run out", None)
    change = float(mean[-1] / mean[0] - 1)
    ends = [float(cells.clearance_time_low[-1] / mean[0] - 1), float(cells.clearance_time_high[-1] / mean[0] - 1)]
    holds = True if ends[0] > -artefact.TOLERANCE else (False if ends[1] < -artefact.TOLERANCE else None)
    text = f"{change:+.0%} [{ends[0]:+.0%}, {ends[1]:+.0%}]"
    return Verdict("1.0 to 1.4 m/s: no shorter with v_d", f"less than -{artefact.TOLERANCE:.0%}", text, holds)


def _bistable(found: xr.Dataset) -> Verdict:
    """Runs of one v_d both block and get out, in the phase separation state."""
    cells = at(found, *BISTABLE)
    text = ", ".join(
        f"{float(v):g}: {int(k)} of {int(n)}" for v, k, n in zip(cells.v_d, cells.blocked, cells.runs, strict=True)
    )
    mixed = bool(((cells.blocked > 0) & (cells.blocked < cells.runs)).any()) if cells.v_d.size else None
    return Verdict("runs both blocked and free at one v_d from 1.6 m/s", "yes", f"blocked at {text}", mixed)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
