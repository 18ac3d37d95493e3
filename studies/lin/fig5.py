"""Figure 5 of Lin, Ma & Lo (2016): leaving of 100 persons who rotate or do not, at 1 and 2 m/s."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.lin import artefact
from studies.lin.sweeps import ROTATION, Sweeps
from studies.presentation import figures
from studies.presentation.estimates import said
from studies.presentation.verdicts import Verdict, interval
from studies.published import lin2016 as paper

ON, OFF = ROTATION
SAME = 0.1  # of the clearance time: what "basically the same" is taken to allow
STYLES = {ON: (figures.BLUE, "-", "with rotation"), OFF: (figures.ORANGE, "--", "without rotation")}
LEVEL = 0.05  # of the test


def measure(sweeps: Sweeps) -> xr.Dataset:
    """All runs, clearance times, blocked shares, and their differences between runs of the same seed."""
    ds = sweeps.rotation
    found = artefact.cells(ds)
    time = found.time_of_run.where(np.isfinite(found.time_of_run))
    longer = (time.sel(inertia=OFF, drop=True) / time.sel(inertia=ON, drop=True)).rename("longer")
    longer.attrs = {"units": "1", "long_name": "clearance time without rotation over that with it"}
    ratios = measures.mean_over(longer).rename(runs="pairs_out").drop_vars("censored")
    paired = measures.paired_blocking(ds, "inertia", OFF, ON)
    return found.assign(ratios.data_vars).assign(paired.data_vars).assign(artefact.runs_of(ds).data_vars)


def plot(found: xr.Dataset) -> Figure:
    """Every run, with and without rotation; crosses where one blocked."""
    figure, axes = figures.stacked(found.v_d.size, height=artefact.HEIGHT)
    for axis, v_d in zip(axes, found.v_d.values, strict=True):
        for inertia, (colour, line, label) in STYLES.items():
            cell = found.sel(v_d=v_d, inertia=inertia)
            artefact.leaving(axis, cell, colour, line, 0.5)
            axis.plot([], [], ls=line, color=colour, lw=1.2, label=label)
        kinds = [found.sel(v_d=v_d, inertia=kind) for kind in STYLES]
        shares = " and ".join(f"{int(of.blocked)} of {int(of.runs)}" for of in kinds)
        axis.set_title(f"{v_d:g} m/s; blocked: {shares}", loc="left")
        axis.set_ylabel("persons out")
        artefact.grey_cross(axis, "blocked from here on")
    longest = np.nanmax(found.exit_time.values)
    axes[-1].set(xlabel="time / s", xlim=(0, 1.05 * longest), ylim=(0, paper.FIG5_N * 1.05))
    artefact.labelled(axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Rotation changes nothing at 1 m/s and keeps the exit from clogging at 2 m/s."""
    slow = found.sel(v_d=paper.FIG5_V_D_SAME)
    fast = found.sel(v_d=paper.FIG5_V_D_CLOGS_MORE_WITHOUT_ROTATION)
    return [_same_time(slow), _same_share(slow), _clogs_more(fast)]


def _same_time(cell: xr.Dataset) -> Verdict:
    ratio, low, high = (float(cell[f"longer{end}"]) for end in ("", "_low", "_high"))
    statement, expected = "1 m/s: clearance time without rotation over that with it", f"1 +- {SAME:g}"
    if not np.isfinite([low, high]).all():
        return Verdict(statement, expected, "too few pairs of runs out", None)
    inside, beyond = low >= 1 - SAME and high <= 1 + SAME, low > 1 + SAME or high < 1 - SAME
    text = f"{interval(ratio, low, high, 2)}, {int(cell.pairs_out)} pairs"
    return Verdict(statement, expected, text, True if inside else (False if beyond else None))


def _words(cell: xr.Dataset) -> str:
    """Blocked runs of both kinds, difference of the shares, test."""
    kinds = {kind: cell.sel(inertia=kind) for kind in (OFF, ON)}
    numbers = " and ".join(f"{int(of.blocked)} of {int(of.runs)}" for of in kinds.values())
    p = f"p = {float(cell.p_value):.1g}" if cell.p_value >= 1e-4 else "p < 1e-4"
    return f"{numbers}, difference {said(cell, 'difference')}, {p}"


def _same_share(cell: xr.Dataset) -> Verdict:
    differs = bool(cell.p_value < LEVEL)
    near = bool(cell.difference_high <= SAME and cell.difference_low >= -SAME)
    statement = "1 m/s: blocked runs without and with rotation"
    return Verdict(statement, f"as many (+- {SAME:g} of share)", _words(cell), False if differs else (near or None))


def _clogs_more(cell: xr.Dataset) -> Verdict:
    differs, more = bool(cell.p_value < LEVEL), bool(cell.difference > 0)
    statement = "2 m/s: blocked runs without and with rotation"
    return Verdict(statement, "more without", _words(cell), more if differs else None)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
