"""Faster-to-frozen beside faster-is-slower: the models of both papers in the rooms of both papers."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Model, Scenario, models, rooms
from engine.errors import require
from studies import measures
from studies.lin.artefact import blocked_words, cells
from studies.presentation import figures
from studies.presentation.artefact import THINNED
from studies.presentation.estimates import V_D, larger, said
from studies.presentation.verdicts import Verdict, interval, table
from sweep import Grid, sweep

FOLDER = Path("results/faster_to_frozen")
N = 200  # persons, as in both papers
MODELS: dict[str, Callable[[], Model]] = {"lin": models.lin_dem, "parisi": models.parisi_dorso}
ROOMS: dict[str, Callable[..., Scenario]] = {"lin": rooms.lin_room, "parisi": rooms.parisi_room}
MODEL_NAMES = {"lin": "Lin's model", "parisi": "Parisi's model"}
ROOM_NAMES = {"lin": "15 m room, 1 m exit", "parisi": "20 m room, 1.2 m exit"}
HEIGHT = 4.4  # in
FOREVER = 1e9  # s: a crowd that blocked does not get out sooner than any other (Lin et al.: its time is infinite)
TOP = 0.93  # of the panel's height, where blocked shares stand
LEAST_RUNS = measures.Rules().least_runs  # out of a cell, for an interval to be drawn


def either_room(model: str, room: str, v_d: float, seed: int = 0) -> Scenario:
    """The model of one paper in the room, with the crowd, of the other or of the same: each "lin" or "parisi".

    The crowd (radii, masses, spread of desired speeds, first velocities) goes with the room, and so does how far
    those who are out are still felt.

    Raises
    ------
    BadInput
        If the model or the room is neither.
    """
    for name, word in (("model", model), ("room", room)):
        require(word in MODELS, name, repr(word), "is not known", f"choose one of {', '.join(MODELS)}")
    return replace(ROOMS[room](v_d=v_d, N=N, seed=seed), model=MODELS[model]())


KINDS = {"model": list(MODELS), "room": list(ROOMS)}
GRID = Grid(either_room, **KINDS, v_d=[0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0], seed=range(8))
QUICK = Grid(either_room, **KINDS, v_d=[0.8, 1.5, 3.0], seed=range(2))


def measure(ds: xr.Dataset) -> xr.Dataset:
    """Clearance times of the runs that got out, blocked shares, where time is least and where blocking begins."""
    stuck = measures.outcome_is(ds, "blocked", "frozen")
    least = measures.faster_is_slower(ds.assign(end_time=ds.end_time.where(~stuck, FOREVER)), N)
    states = measures.states(ds)
    names = [name for name in states if str(name).startswith("phase_separation_from")]
    minimum = {name: least[name] for name in least if str(name).startswith("v_dt")}
    return cells(ds).assign(minimum).assign(states[names].data_vars)


# --- Figure -------------------------------------------------------------------------------------------------


def plot(found: xr.Dataset) -> Figure:
    """A panel for each model (row) and room (column): every run, means, blocked shares, and both boundaries."""
    figure, grid = figures.grid(2, 2, figures.PAGE, HEIGHT)
    for axes, model in zip(grid, MODELS, strict=True):
        for axis, room in zip(axes, ROOMS, strict=True):
            _panel(axis, found.sel(model=model, room=room))
            axis.set_title(f"{MODEL_NAMES[model]}, {ROOM_NAMES[room]}")
        axes[0].set_ylabel("clearance time / s")
    for axis in grid[-1]:
        axis.set_xlabel(V_D)
    axis.set(xscale="log", yscale="log", ylim=(20, 2000))
    axis.set_xticks([0.6, 1, 2, 4, 6], ["0.6", "1", "2", "4", "6"])
    axis.set_xticks([], minor=True)
    axis.set_yticks([20, 50, 100, 200, 500, 1000], ["20", "50", "100", "200", "500", "1000"])
    axis.set_yticks([], minor=True)
    figure.legend(*grid[0][0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _panel(axis: Axes, column: xr.Dataset) -> None:
    for k, v_d in enumerate(column.v_d.values):
        times = column.time_of_run.sel(v_d=v_d).values
        times = times[np.isfinite(times)]
        spread = v_d * (1 + np.linspace(-0.03, 0.03, times.size))
        axis.plot(spread, times, ".", ms=2.5, color=figures.GREY, label="one run that got out" if k == 0 else None)
    mean = column.clearance_time
    told = column.out >= LEAST_RUNS
    arms = np.abs([mean - column.clearance_time_low.where(told), column.clearance_time_high.where(told) - mean])
    label = f"their mean, 95 % from {LEAST_RUNS} runs"
    axis.errorbar(column.v_d, mean, arms, fmt="o-", ms=3, color="black", capsize=2, lw=1, label=label)
    _shares(axis, column)
    _range(axis, column, "v_dt", 0.14, figures.BLUE, "D", "least time, 95 %")
    _range(axis, column, "phase_separation_from", 0.06, figures.ORANGE, "s", "blocking begins, 95 %")


def _shares(axis: Axes, column: xr.Dataset) -> None:
    """Numbers of blocked runs along the top."""
    axis.plot([], [], "x", ms=4, color=figures.ORANGE, label="blocked runs, of all")
    at = axis.get_xaxis_transform()
    for v_d, blocked, runs in zip(column.v_d.values, column.blocked.values, column.runs.values, strict=True):
        if blocked:
            axis.plot([v_d], [TOP], "x", ms=4, color=figures.ORANGE, transform=at)
            text = (v_d, TOP - 0.03)
            axis.annotate(
                f"{blocked}/{runs}", text, xycoords=at, ha="center", va="top", fontsize=6, color=figures.ORANGE
            )


def _range(axis: Axes, column: xr.Dataset, name: str, height: float, colour: str, marker: str, label: str) -> None:
    """A boundary and its interval, cut at the ends of the scan, at a height of the panel."""
    at, low, high = (float(column[f"{name}{end}"]) for end in ("", "_low", "_high"))
    style: dict[str, Any] = {"fmt": marker, "ms": 3.5, "capsize": 2, "lw": 1, "color": colour}
    if np.isfinite(at):
        arms = [[at - max(low, float(column.v_d[0]))], [min(high, float(column.v_d[-1])) - at]]
        axis.errorbar([at], [height], xerr=arms, transform=axis.get_xaxis_transform(), **style)
    axis.errorbar([], [], xerr=[[], []], label=label, **style)


# --- Verdicts -----------------------------------------------------------------------------------------------


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """For each model and room, whether it shows the one effect and the other.

    Expected is what each paper says of its own model; of the other room neither says anything.
    """
    columns = [(model, room) for model in MODELS for room in ROOMS]
    return [
        *(_slower(found.sel(model=m, room=r), m, r) for m, r in columns),
        *(_frozen(found.sel(model=m, room=r), m, r) for m, r in columns),
    ]


def _where(model: str, room: str) -> str:
    return f"{MODEL_NAMES[model]}, {ROOM_NAMES[room]}"


def _slower(column: xr.Dataset, model: str, room: str) -> Verdict:
    """A minimum inside the range, and at the fastest v_d above it whose runs all got out a time that is longer."""
    statement = f"faster is slower: {_where(model, room)}"
    expected = "yes, least at 2 m/s" if model == room == "parisi" else "not said"
    at, low, high = (float(column[f"v_dt{end}"]) for end in ("", "_low", "_high"))
    if not np.isfinite(at):
        return Verdict(statement, expected, f"undecided ({_decision(column, 'v_dt')})", None)
    least = column.sel(v_d=at)
    free = column.where((column.out == column.runs) & (column.out >= LEAST_RUNS) & (column.v_d > at), drop=True)
    text = f"least at {interval(at, low, high, 2)} m/s, {_time(least)}"
    if not free.v_d.size:
        return Verdict(statement, expected, f"{text}; above it not one v_d at which all got out", None)
    fastest = free.isel(v_d=-1)
    return Verdict(
        statement,
        expected,
        f"{text}; {_time(fastest)} at {float(fastest.v_d):g} m/s",
        larger(fastest, least, "clearance_time"),
    )


def _time(cell: xr.Dataset) -> str:
    return f"{said(cell, 'clearance_time', 0)} s"


def _frozen(column: xr.Dataset, model: str, room: str) -> Verdict:
    """The blocked share at the fastest v_d against that at the slowest, and from where blocking is established."""
    statement = f"faster to frozen: {_where(model, room)}"
    expected = "yes, from 1.6 m/s" if model == room == "lin" else "not said"
    slow, fast = column.isel(v_d=0), column.isel(v_d=-1)
    shares = f"{blocked_words(slow)} at {float(slow.v_d):g}, {blocked_words(fast)} at {float(fast.v_d):g} m/s"
    at, low, high = (float(column[f"phase_separation_from{end}"]) for end in ("", "_low", "_high"))
    rises = larger(fast, slow, "blocked_share")
    begins = f"begins at {interval(at, low, high, 2)} m/s" if np.isfinite(at) else _decision(column)
    begins = "falls with v_d" if rises is False else begins
    none = at == np.inf and int(column.blocked.sum()) == 0
    return Verdict(statement, expected, f"{shares}; {begins}", False if none else rises)


def _decision(column: xr.Dataset, name: str = "phase_separation_from") -> str:
    flag = column[f"{name}_decision"]
    return str(flag.attrs["flag_meanings"].split()[int(flag)]).replace("_", " ")


def main(quick: bool = False, jobs: int = 2) -> None:
    """Sweep what is missing, draw the figure, print which model shows which effect."""
    found = measure(sweep(QUICK if quick else GRID, FOLDER, jobs=jobs))
    figures.draw(plot, found, FOLDER / "figure.png")
    text = table(verdicts(found)) + THINNED * quick
    (FOLDER / "table.txt").write_text(text + "\n", "utf-8")
    print(text, f"\n{FOLDER / 'figure.png'}", sep="\n")
