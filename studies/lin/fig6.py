"""Figure 6 of Lin, Ma & Lo (2016): 200 persons at 0, 30, 60 and 120 s, to scale, with the forces of contacts."""

import sys

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from engine import models
from studies.lin import artefact
from studies.lin.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.verdicts import Verdict
from studies.published import lin2016 as paper

COLOURS = "cividis"  # even in lightness, and the same to colour-blind readers
WIDEST, STRONGEST = 2.5, 500.0  # points, for a force of so many N; stronger ones are no wider
SHOWN = (100.0, 250.0, 500.0)  # N, in the legend
FULL_COLOUR = 0.5  # of the desired speed: hardly anybody in the crowd is as fast
ROOM = 15.0  # m
HEIGHT = 4.3  # in
PER_EXIT = 0.25  # of the persons out by a time: tolerance of the published flow


def measure(sweeps: Sweeps) -> xr.Dataset:
    """The four samples of the run, with the speed of everybody and the normal force of each contact."""
    run = sweeps.snapshots
    k = [int(np.abs(run.time.values - t).argmin()) for t in paper.FIG6_TIMES if t <= run.time.values[-1] + 1.0]
    ends = run.row_size.values.cumsum()
    rows = [slice(int(ends[j] - run.row_size.values[j]), int(ends[j])) for j in k]
    shot = np.concatenate([np.full(s.stop - s.start, n) for n, s in enumerate(rows)])
    i, j = (np.concatenate([run[name].values[s] for s in rows]) for name in ("contact_i", "contact_j"))
    now = run.isel(sample=k)
    ax, ay, bx, by, force = contact_lines(now, shot, i, j)
    found = xr.Dataset(
        {
            "time": now.time,
            "x": now.x,
            "y": now.y,
            "speed": np.hypot(now.vx, now.vy).assign_attrs(units="m s-1"),
            "radius": now.radius,
            "wall": now.wall,
            "door": now.door,
            "shot": ("contact", shot),
            "line": (("contact", "end"), np.stack([ax, ay, bx, by], axis=1)),
            "force": ("contact", force, {"units": "N", "long_name": "normal force, without damping"}),
            "exit_time": run.exit_time,
        }
    )
    return found.assign_attrs(v_d=float(run.v_d_person.values[0]))


def contact_lines(now: xr.Dataset, shot: np.ndarray, i: np.ndarray, j: np.ndarray) -> tuple[np.ndarray, ...]:
    """Ends of each contact's line, m, and its normal force k_n sqrt(R) overlap^1.5 (Eq. 3), N.

    Parameters
    ----------
    now : the samples, with x, y (sample, person), radius (person) and wall (wall, end)
    shot : (contacts,) int, the sample of each contact
    i, j : (contacts,) int, person and person, or -1 - w for wall w

    Returns
    -------
    Four coordinates and the force, (contacts,) each. A line leads from centre to centre, or to the nearest point of
    the wall.
    """
    x, y, r = now.x.values.astype(np.float64), now.y.values.astype(np.float64), now.radius.values
    ax, ay, wall = x[shot, i], y[shot, i], j < 0
    x0, y0, x1, y1 = now.wall.values[np.where(wall, -1 - j, 0)].T
    along = ((ax - x0) * (x1 - x0) + (ay - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2)
    along = along.clip(0.0, 1.0)
    other = np.where(wall, 0, j)
    bx = np.where(wall, x0 + along * (x1 - x0), x[shot, other])
    by = np.where(wall, y0 + along * (y1 - y0), y[shot, other])
    reach = r[i] + np.where(wall, 0.0, r[other])
    curvature = np.where(wall, r[i], r[i] * r[other] / (r[i] + r[other]))
    overlap = np.maximum(reach - np.hypot(ax - bx, ay - by), 0.0)
    return ax, ay, bx, by, models.lin_dem().normal.k_n * np.sqrt(curvature) * overlap**1.5


def plot(found: xr.Dataset) -> Figure:
    """Four panels: discs of true size coloured by speed, lines between those in touch as wide as they press."""
    figure, grid = figures.grid(2, 2, figures.COLUMN, HEIGHT)
    axes = [axis for row in grid for axis in row]
    fastest = FULL_COLOUR * found.attrs["v_d"]
    for k, axis in enumerate(axes):
        if k < found.sizes["sample"]:
            discs = _snapshot(axis, found.isel(sample=k), found.shot.values == k, fastest)
        axis.set_aspect("equal")
        axis.set(xlim=(-0.4, ROOM + 0.8), ylim=(-0.4, ROOM + 0.4), xticks=[0, 5, 10, 15], yticks=[0, 5, 10, 15])
        axis.spines[["left", "bottom"]].set_visible(False)
    artefact.labelled(axes)
    for row in grid:
        row[0].set_ylabel("$y$ / m")
    for axis in grid[-1]:
        axis.set_xlabel("$x$ / m")
    bar = figure.colorbar(discs, ax=axes, location="bottom", aspect=35, pad=0.02, extend="max", shrink=0.9)
    bar.set_label("speed / m s$^{-1}$")
    keys = [Line2D([], [], color=figures.ORANGE, lw=_width(F), label=f"{F:g} N") for F in SHOWN]
    figure.legend(handles=keys, title="force of a contact", title_fontsize=7, loc="outside lower center", ncols=3)
    return figure


def _width(force: float) -> float:
    return WIDEST * min(force / STRONGEST, 1.0)


def _snapshot(axis: Axes, now: xr.Dataset, of_shot: np.ndarray, fastest: float) -> EllipseCollection:
    for x0, y0, x1, y1 in now.wall.values:
        axis.plot([x0, x1], [y0, y1], color="black", lw=1.2, solid_capstyle="butt")
    for x0, y0, x1, y1 in now.door.values:
        axis.plot([x0, x1], [y0, y1], color=figures.ORANGE, lw=1.5, ls=":")
    here = np.isfinite(now.x.values)
    size = 2.0 * now.radius.values[here]
    places = np.stack([now.x.values[here], now.y.values[here]], axis=1)
    discs = EllipseCollection(
        size, size, np.zeros(size.size), units="xy", offsets=places, offset_transform=axis.transData, cmap=COLOURS
    )
    discs.set(array=now.speed.values[here], clim=(0.0, fastest), edgecolor="white", linewidth=0.15)
    axis.add_collection(discs)
    lines = now.line.values[of_shot].reshape(-1, 2, 2)
    widths = [_width(F) for F in now.force.values[of_shot]]
    axis.add_collection(LineCollection(list(lines), colors=figures.ORANGE, linewidths=widths, capstyle="round"))
    axis.set_title(f"{float(now.time):.0f} s, {int(here.sum())} inside", loc="left")
    return discs


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """The paper shows pictures only: how many are out is held against its clearance time of 210 s at 1 m/s."""
    flow = paper.FIG6_N / paper.FIG7_CLEARANCE_TIME[1.0]
    return [_out(found, t, flow) for t in paper.FIG6_TIMES[1:]] + [_at_rest(found)]


def _out(found: xr.Dataset, t: float, flow: float) -> Verdict:
    out, published = int((found.exit_time <= t).sum()), flow * t
    near = abs(out - published) <= PER_EXIT * published
    said = f"about {published:.0f} +- {100 * PER_EXIT:.0f} % (200 in 210 s)"
    return Verdict(f"persons out after {t:.0f} s at 1 m/s (one run)", said, f"{out}", near)


def _at_rest(found: xr.Dataset) -> Verdict:
    """Everybody starts apart: a picture of places in which bodies overlap at 0 s would be a wrong start."""
    touching = int((found.shot == 0).sum())
    return Verdict("placed at random, nobody touches at 0 s", "0 contacts", f"{touching} contacts", touching == 0)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
