"""Table 1 of Parisi & Dorso (2005): evacuation times of 200 persons, and what A = 1000 N makes of them."""

import sys

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper

EACH, MEAN = 0.08, 0.04  # deviation tolerated at each v_d, and on average
VARIANTS = ("default", "printed")
LABELS = {"default": "$A$ = 2000 N (default)", "printed": "$A$ = 1000 N (as printed)"}


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Mean evacuation times over v_d and variant, their published values, t_eg, and the deviations."""
    v_d = [v for v in paper.EVACUATION_TIME if v in sweeps.speeds.v_d]
    columns = [_times(ds.sel(v_d=v_d)) for ds in (sweeps.speeds, sweeps.printed)]
    found = xr.concat([c.reset_coords(drop=True) for c in columns], "variant").assign_coords(variant=list(VARIANTS))
    published = xr.DataArray([paper.EVACUATION_TIME[v] for v in v_d], dims="v_d", attrs={"units": "s"})
    ratio = xr.DataArray([paper.RATIO[v] for v in v_d], dims="v_d", attrs={"units": "1"})
    free = paper.N * paper.SHOULDERS / found.v_d
    for end in ("", "_low", "_high"):
        found[f"ratio{end}"] = found[f"clearance_time{end}"] / free
    return found.assign(
        published=published, published_ratio=ratio, free=free, deviation=found.clearance_time / published - 1.0
    )


def _times(ds: xr.Dataset) -> xr.Dataset:
    times = measures.clearance(ds)
    out = times.clearance_time.where(measures.outcome_is(ds, "all_out"))
    return measures.mean_over(out, censored=times.censored)


def plot(found: xr.Dataset) -> Figure:
    """Times left, their ratio to the geometric time right, for both variants and as published."""
    figure, axes = plt.subplots(1, 2, figsize=(figures.PAGE, artefact.HEIGHT))
    for axis, name, published, words in (
        (axes[0], "clearance_time", found.published, "evacuation time $t_e$ / s"),
        (axes[1], "ratio", found.published_ratio, "$t_e / t_{eg}$"),
    ):
        for k, variant in enumerate(VARIANTS):
            artefact.points(axis, found.sel(variant=variant), name, k, f"{LABELS[variant]}, 95 %")
        axis.plot(found.v_d, published, "x", color="black", ms=5, zorder=5, label="published (Table 1)")
        axis.set(xlabel=artefact.V_D, ylabel=words, ylim=(0, None))
    axes[1].legend(loc="lower right")
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Each time, their mean deviation, and the ratios."""
    here, printed = (found.sel(variant=variant) for variant in VARIANTS)
    return [
        *(_time(here.sel(v_d=v_d)) for v_d in found.v_d.values),
        _mean(here, "t_e on average, A = 2000 N"),
        *(_ratio(here.sel(v_d=v_d)) for v_d in found.v_d.values),
        _mean(printed, "t_e on average, A = 1000 N as printed"),
    ]


def _time(cell: xr.Dataset) -> Verdict:
    text = f"{artefact.said(cell, 'clearance_time', 1)} s, {100 * float(cell.deviation):+.1f} %"
    said = f"{float(cell.published):g} s +- {100 * EACH:.0f} %"
    return Verdict(f"t_e at {float(cell.v_d):g} m/s", said, text, bool(abs(cell.deviation) <= EACH))


def _ratio(cell: xr.Dataset) -> Verdict:
    off = float(cell.ratio / cell.published_ratio - 1.0)
    said = f"{float(cell.published_ratio):.2f} +- {100 * EACH:.0f} %"
    text = f"{artefact.said(cell, 'ratio')}, {100 * off:+.1f} %"
    return Verdict(f"t_e/t_eg at {float(cell.v_d):g} m/s", said, text, abs(off) <= EACH)


def _mean(column: xr.Dataset, statement: str) -> Verdict:
    off = np.abs(column.deviation.values)
    text = f"off by {100 * off.mean():.1f} % on average, {100 * off.max():.1f} % at most"
    return Verdict(statement, f"within {100 * MEAN:.0f} %", text, bool(off.mean() <= MEAN))


def variants_table(found: xr.Dataset) -> str:
    """What A does to Table 1, as Markdown."""
    head = "| v_d (m/s) | published t_e (s) | A = 2000 N | | A = 1000 N | |\n|---|---|---|---|---|---|\n"
    rows = []
    for v_d in found.v_d.values:
        cells = [found.sel(v_d=v_d, variant=variant) for variant in VARIANTS]
        texts = [f"{artefact.said(c, 'clearance_time', 1)} | {100 * float(c.deviation):+.1f} %" for c in cells]
        rows.append(f"| {v_d:g} | {float(cells[0].published):g} | {' | '.join(texts)} |")
    return head + "\n".join(rows)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
