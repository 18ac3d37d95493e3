"""Figure 6 of Parisi & Dorso (2005): a blocking cluster from the runs, drawn to scale; sizes and lifetimes of all."""

import sys

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from engine.errors import require
from studies import measures
from studies.parisi import artefact
from studies.parisi.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import parisi2005 as paper

V_D, SEED = 4.0, 0  # of the run that is drawn
DRAWN_SIZE = (4, 7)  # persons, of the arch that is drawn: the longest-lived of these
FRAME = (3.2, 0.5, 2.0)  # m: inwards, outwards and to the sides of the door's centre
MOSTLY = 0.8


def measure(sweeps: Sweeps) -> xr.Dataset:
    """The run at the sample in the middle of the arch's life, and the arches of all runs above the threshold."""
    run = sweeps.run(V_D, SEED)
    log = measures.arches(run, clean=True)
    ends = np.cumsum(log.arch_size.values)
    fits = (log.arch_size >= DRAWN_SIZE[0]) & (log.arch_size <= DRAWN_SIZE[1])
    require(bool(fits.any()), "run", f"at {V_D:g} m/s, seed {SEED}", "has no arch to draw", "draw another")
    which = int(log.lifetime.where(fits).fillna(0.0).argmax("arch"))
    arch = log.isel(arch=which)
    person = log.arch_person.values[ends[which] - int(arch.arch_size) : ends[which]]
    k = int(np.abs(run.time.values - float(arch.begin_time + arch.lifetime / 2)).argmin())
    now = run.isel(sample=k)
    begin = int(run.row_size.values[:k].sum())
    rows = slice(begin, begin + int(now.row_size))
    fast = artefact.at(sweeps.speed_counts, paper.V_DT + 0.1, np.inf).sum(["seed", "v_d"])
    lasts = artefact.at(sweeps.speed_counts, paper.V_DT + 0.1, np.inf).longest_lifetime
    return xr.Dataset(
        {
            "x": now.x,
            "y": now.y,
            "radius": now.radius,
            "wall": now.wall,
            "door": now.door,
            "contact_i": ("touch", run.contact_i.values[rows]),
            "contact_j": ("touch", run.contact_j.values[rows]),
            "arch": ("member", person),
            "lifetime": arch.lifetime,
            "arch_count": fast.arch_count,
            "longest_lifetime": lasts.max(["seed", "v_d", "arch_size"]),
            "longest_of_sizes": lasts.max(["seed", "v_d"]),
        },
    )


def plot(found: xr.Dataset) -> Figure:
    """Everybody near the door as a disc of true size, the arch and the walls it leans on drawn heavily."""
    figure, (axis,) = figures.panels(1, figures.COLUMN, 3.3)
    x0, y0, x1, y1 = found.door.values[0]
    centre = (x0 + x1) / 2, (y0 + y1) / 2
    for wall in found.wall.values:
        axis.plot(wall[::2], wall[1::2], color="black", lw=3.5, solid_capstyle="butt")
    arch = set(found.arch.values.tolist())
    for k, (x, y, radius) in enumerate(zip(found.x.values, found.y.values, found.radius.values, strict=True)):
        if np.isfinite(x):
            colour = figures.ORANGE if k in arch else "white"
            edge, width = ("black", 1.8) if k in arch else (figures.GREY, 0.7)
            axis.add_patch(Circle((x, y), radius, fc=colour, ec=edge, lw=width, alpha=0.9))
            if k in arch:
                axis.plot([x], [y], ".", color="black", ms=3)
    for i, j in zip(found.contact_i.values, found.contact_j.values, strict=True):
        if i in arch and j in arch:
            axis.plot(found.x.values[[i, j]], found.y.values[[i, j]], color="black", lw=1.2)
    axis.plot([x0, x1], [y0, y1], color=figures.BLUE, lw=1, ls=":")
    inwards, outwards, aside = FRAME
    axis.set(
        xlim=(centre[0] - inwards, centre[0] + outwards),
        ylim=(centre[1] - aside, centre[1] + aside),
        xlabel="$x$ / m",
        ylabel="$y$ / m",
    )
    axis.set_aspect("equal")
    axis.set_title(f"{V_D:g} m/s, seed {SEED}: {len(arch)} persons, shut for {float(found.lifetime):.2f} s")
    keys = [
        Line2D([], [], marker="o", ls="", mfc=figures.ORANGE, mec="black", label="in the arch"),
        Line2D([], [], marker="o", ls="", mfc="white", mec=figures.GREY, label="others"),
        Line2D([], [], color=figures.BLUE, lw=1, ls=":", label="door"),
    ]
    figure.legend(handles=keys, loc="outside lower center", ncols=3)
    return figure


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """How many persons the arches have, and how long they last."""
    low, high = paper.ARCH_PERSONS
    return [
        *(_sizes(found.arch_count.sel(kind=kind), str(kind), low, high) for kind in ("clean", "any")),
        _lifetime(found),
    ]


def _sizes(count: xr.DataArray, kind: str, low: int, high: int) -> Verdict:
    share = float(count.sel(arch_size=slice(low, high)).sum() / count.sum())
    below = float(count.sel(arch_size=slice(None, low - 1)).sum() / count.sum())
    text = f"{share:.0%} of {int(count.sum())}, {below:.0%} fewer, {1 - share - below:.0%} more"
    statement = f"blocking clusters ({kind}) of {low} to {high} persons, above 2 m/s"
    return Verdict(statement, f"all (above {MOSTLY:.0%})", text, share > MOSTLY)


def _lifetime(found: xr.Dataset) -> Verdict:
    longest = float(found.longest_lifetime.sel(kind="clean"))
    near = longest >= 0.5 * paper.ARCH_LASTS or None  # a maximum grows with the number of runs
    holds = False if longest > 2 * paper.ARCH_LASTS else near
    statement = "longest life of one (clean), above 2 m/s"
    return Verdict(statement, f"up to {paper.ARCH_LASTS:g} s", f"{longest:.1f} s", holds)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
