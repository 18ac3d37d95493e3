"""Real crowds at a gate beside simulated ones: who is out when, and how long one waits for the next.

The experiments are described in doi 10.1098/rsif.2019.0871: 75 persons in a corridor 5.6 m wide, a gate of 0.5 m. Their
trajectories are in the Pedestrian Dynamics Data Archive of Forschungszentrum Jülich, doi 10.34735/ped.2018.1 (files
such as 040_c_56_h-.txt); they are not part of this project. `DATA` names a folder with any number of them; other
experiments need their own `--line` and `--towards`.

The line crosses the middle of the gate's passage. At its mouth (y = 0) some heads pass beside a line that is hardly
wider than the gate and are missed, and gaps between crossings are longer there than between persons who come through.

Scaling: discs are wider than bodies, so lengths are measured in bodies. The gate is 0.5 m / 0.3 m (body depth) = 1.67
bodies wide and the corridor 18.7; for Lin's discs (0.6 m on average) that is 1.0 m in a room of 11.2 m, for Parisi's
(0.54 m) 0.9 m in 10.08 m. Times are not scaled; the last panel has delays over their mean, which needs no scale of
time.
"""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from engine import BadInput, rooms
from engine.errors import require
from studies import measures
from studies.measures.uncertainty import bootstrap_interval, resampling_weights
from studies.presentation import figures
from studies.presentation.verdicts import columns, interval
from sweep import Grid, SweepStopped, sweep
from sweep.imports import crossings, read_trajectories
from sweep.imports.trajectories import SUFFIXES
from sweep.storage.durable import replace_durably

FOLDER = Path("results/real-crowds")
PERSONS, GATE, CORRIDOR, BODY = 75, 0.5, 5.6, 0.3  # of the experiments; m
LINE, TOWARDS = ((-0.5, -0.5), (0.5, -0.5)), (0.0, -1.0)  # m, in the coordinates of their files
DISC = {"lin_room": 0.6, "parisi_room": 0.54}  # m, mean diameters: 2 x 0.25 to 0.35 m, 2 x 0.25 to 0.29 m
WORDS = {"lin_room": "Lin", "parisi_room": "Parisi"}
V_D, SEEDS, QUICK_SEEDS = [1.0, 2.0], 20, 3  # m/s
AT = np.round(np.arange(0.0, 8.001, 0.02), 2)  # s
OVER_MEAN = np.round(np.arange(0.0, 8.001, 0.02), 2)  # delays over the mean delay
RESAMPLES = 2000
HEAD = ("crowd", "runs", "unfinished", "out", "flow / s-1", "median gap / s", "95 % gap / s", "longest / s")
COLOURS = {"Lin": figures.BLUE, "Parisi": figures.ORANGE}
LINES = ("-", "--", "-.", ":")
Line = tuple[tuple[float, float], tuple[float, float]]


def grid(room: str, quick: bool) -> Grid:
    """Crowds of discs at a gate as wide in bodies as the real one."""
    size, L = (round(length / BODY * DISC[room], 6) for length in (CORRIDOR, GATE))
    return Grid(getattr(rooms, room), v_d=V_D, seed=range(QUICK_SEEDS if quick else SEEDS), N=PERSONS, L=L, size=size)


def experiments(folder: Path, line: Line = LINE, towards: tuple[float, float] = TOWARDS) -> dict[str, xr.Dataset]:
    """The crossings of every file of trajectories in a folder, by the file's name.

    Raises
    ------
    BadInput
        If the folder is not there, has no such file, or one of them cannot be read or has nobody crossing the line.
    """
    require(folder.is_dir(), "DATA", f"'{folder}'", "is no folder", "name one with trajectories")
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)
    suffixes = ", ".join(SUFFIXES)
    require(bool(files), "DATA", f"'{folder}'", f"holds no trajectories ({suffixes})", "put some there")
    found = {path.stem: crossings(read_trajectories(path), line, towards) for path in files}
    for name, ds in found.items():
        remedy = "give --line and --towards"
        require(int(ds.N_out) > 1, "trajectories", f"'{name}'", f"have {int(ds.N_out)} crossings of {line} m", remedy)
    return {name: ds.expand_dims(seed=[0]) for name, ds in found.items()}


def simulated(quick: bool, jobs: int) -> dict[str, xr.Dataset]:
    """The runs of both models, by model and desired speed."""
    swept = {WORDS[room]: sweep(grid(room, quick), FOLDER / room, jobs=jobs) for room in DISC}
    return {f"{word}, {v_d:g} m/s": ds.sel(v_d=v_d) for word, ds in swept.items() for v_d in V_D}


def measure(crowds: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Exits, survival of the delays and their median and 95 % of every crowd (seed, exit), along `crowd`."""
    found = [_measured(ds).expand_dims(crowd=[name]) for name, ds in crowds.items()]
    return xr.concat(found, "crowd", join="outer", coords="minimal", compat="override", combine_attrs="drop_conflicts")


def _measured(ds: xr.Dataset) -> xr.Dataset:
    ds = ds.drop_vars([name for name in ds.coords if not ds[name].dims])  # parameters: each crowd has its own
    gaps = measures.delays(ds).delay
    mean = float(gaps.mean())
    survival = measures.delay_survival(ds, AT, first=1, last=None)
    scaled = measures.delay_survival(ds.assign(exit_time=ds.exit_time / mean), OVER_MEAN, first=1, last=None)
    scaled = scaled[["delay_survival", "delay_survival_low", "delay_survival_high"]].rename(time="over_mean")
    scaled["over_mean"].attrs = {"units": "1", "long_name": "delay over the mean delay"}
    first, last = ds.exit_time.min("exit"), ds.exit_time.max("exit")
    flow = ((ds.N_out - 1) / (last - first)).where(ds.N_out > 1).rename("flow")
    flow.attrs = {"units": "s-1", "long_name": "flow from the first to the last exit"}
    flows = measures.mean_over(flow, censored=measures.clearance(ds).censored)
    return xr.Dataset(
        {
            "exit_time": ds.exit_time,
            **survival.data_vars,
            **{f"{name}_over_mean": values for name, values in scaled.items()},
            **{name: flows[name] for name in ("flow", "flow_low", "flow_high")},
            "persons": ds.persons.max(),
            "persons_out": ds.N_out.sum(),
            "persons_all": ds.persons.sum(),
            "longest_gap": gaps.max(),
            **_quantiles(gaps),
        }
    )


def _quantiles(gaps: xr.DataArray) -> dict[str, float]:
    """Median and 95 % of the pooled delays (seed, exit), with bootstrap intervals over runs; nan for one run."""
    rows: list[NDArray[np.float64]] = [row[np.isfinite(row)] for row in gaps.transpose("seed", "exit").values]
    pooled, shares = np.concatenate(rows), {"median_gap": 0.5, "gap_95": 0.95}
    found = {name: float(np.quantile(pooled, share)) for name, share in shares.items()}
    limits = np.full((2, len(shares)), np.nan)
    if len(rows) > 1:
        drawn = resampling_weights(len(rows), RESAMPLES, 0).astype(np.int64)
        samples = [np.concatenate([np.tile(row, k) for row, k in zip(rows, times, strict=True)]) for times in drawn]
        limits = bootstrap_interval(np.array([np.quantile(s, [*shares.values()]) for s in samples]), len(rows), 0.95)
    for k, name in enumerate(shares):
        found |= {f"{name}_low": float(limits[0, k]), f"{name}_high": float(limits[1, k])}
    return found


# --- Figure and table ---------------------------------------------------------------------------------------


def plot(found: xr.Dataset) -> Figure:
    """Who is out when, survival of the delays, and the same over the mean delay."""
    figure, axes = plt.subplots(1, 3, figsize=(figures.PAGE, 3.3))
    real = 0
    for name in found.crowd.values.tolist():
        one, model = found.sel(crowd=name), name.partition(",")[0]
        colour = COLOURS.get(model, "black")
        line = LINES[real % len(LINES)] if model not in COLOURS else LINES[_speed_of(name)]
        real += model not in COLOURS
        _discharge(axes[0], one, colour, line, name)
        _survival(axes[1], one, "delay_survival", "time", colour, line)
        _survival(axes[2], one, "delay_survival_over_mean", "over_mean", colour, line)
    axes[0].set(xlabel="time since the first exit / s", ylabel="persons out", ylim=(0, None), xlim=(0, None))
    axes[1].set(xlabel="delay $t$ / s", ylabel="share of delays longer than $t$")
    axes[2].set(xlabel="delay / mean delay", ylabel="share of longer delays")
    for axis in axes[1:]:
        axis.set(yscale="log", ylim=(2e-3, 1.1), xlim=(0, 6))
    axes[0].plot([], [], "x", ms=3, color=figures.GREY, label="ended with persons inside")
    legend = figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    for handle in legend.legend_handles:
        if handle is not None:
            handle.set_alpha(1.0)
    figure.suptitle(scaling(), fontsize=7)
    return figure


def scaling() -> str:
    """The widths of the gate, of bodies and discs, in words."""
    discs = (f"{WORDS[room]} {GATE / BODY * disc:.2g} m for discs of {disc:g} m" for room, disc in DISC.items())
    return f"gate {GATE / BODY:.2f} bodies wide: experiment {GATE:g} m for {BODY:g} m, {', '.join(discs)}; bands 95 %"


def _speed_of(name: str) -> int:
    return [f"{v_d:g} m/s" for v_d in V_D].index(name.partition(", ")[2])


def _discharge(axis: Axes, one: xr.Dataset, colour: str, line: str, name: str) -> None:
    """Every run; a cross where one of them ended with persons inside."""
    for k, times in enumerate(one.exit_time.values):
        t = np.sort(times[np.isfinite(times)])
        if not t.size:
            continue
        alone = int(one.runs) == 1
        width, alpha = (1.4, 1.0) if alone else (0.5, 0.5)
        label = name if k == 0 else None
        axis.plot(t - t[0], np.arange(1, t.size + 1), color=colour, ls=line, lw=width, alpha=alpha, label=label)
        if t.size < int(one.persons):
            axis.plot(t[-1] - t[0], t.size, "x", ms=3, color=colour)


def _survival(axis: Axes, one: xr.Dataset, name: str, along: str, colour: str, line: str) -> None:
    end = "_over_mean" if name.endswith("_over_mean") else ""
    low, high = (one[f"delay_survival_{side}{end}"] for side in ("low", "high"))
    axis.fill_between(one[along], low, high, color=colour, alpha=0.2, lw=0)
    shown = one[name].where(one[name] > 0)
    axis.plot(one[along], shown, color=colour, ls=line, lw=1.0)


def table(found: xr.Dataset) -> str:
    """Flow and gaps of every crowd; intervals of 95 % over runs, none for a single one."""
    return columns([HEAD, *(_row(found.sel(crowd=name)) for name in found.crowd.values)])


def _row(one: xr.Dataset) -> tuple[str, ...]:
    estimates = (_said(one, name) for name in ("flow", "median_gap", "gap_95"))
    out = f"{int(one.persons_out)} of {int(one.persons_all)}"
    return str(one.crowd.item()), str(int(one.runs)), str(int(one.censored)), out, *estimates, f"{one.longest_gap:.2f}"


def _said(one: xr.Dataset, name: str) -> str:
    at, low, high = (float(one[f"{name}{end}"]) for end in ("", "_low", "_high"))
    return interval(at, low, high, 2) if np.isfinite(low) else f"{at:.2f}"


def main(
    quick: bool = False,
    jobs: int = 2,
    data: str = "",
    line: Line = LINE,
    towards: tuple[float, float] = TOWARDS,
) -> None:
    """Read the experiments, sweep what is missing of the simulated crowds, draw the figure and print the table.

    Raises
    ------
    BadInput
        If there are no experiments to read.
    """
    remedy = "say make study-real-crowds DATA=folder, with files of the Pedestrian Dynamics Data Archive"
    require(data != "", "DATA", "''", "names no folder of trajectories", remedy)
    real = experiments(Path(data), line, towards)
    found = measure(real | simulated(quick, jobs))
    FOLDER.mkdir(parents=True, exist_ok=True)
    replace_durably(FOLDER / "dataset.nc", found.to_netcdf)
    figures.draw(plot, found, FOLDER / "figure.png")
    text = f"{table(found)}\n\n{scaling()}"
    (FOLDER / "table.txt").write_text(text + "\n", "utf-8")
    print(text, f"\n{FOLDER / 'figure.png'}", sep="\n")


def _command() -> None:
    parser = argparse.ArgumentParser("python -m studies.real_crowds", description="Real crowds beside simulated ones.")
    parser.add_argument("--data", default="", help="folder with trajectories")
    parser.add_argument("--quick", action="store_true", help="three runs a simulated crowd")
    parser.add_argument("--jobs", type=int, default=2, help="worker processes")
    numbers = [value for end in LINE for value in end]
    parser.add_argument("--line", type=float, nargs=4, default=numbers, metavar=("X0", "Y0", "X1", "Y1"), help="m")
    parser.add_argument("--towards", type=float, nargs=2, default=TOWARDS, metavar=("DX", "DY"), help="way out")
    given = vars(parser.parse_args())
    x0, y0, x1, y1 = given.pop("line")
    try:
        main(**given | {"line": ((x0, y0), (x1, y1)), "towards": tuple(given["towards"])})
    except (BadInput, SweepStopped) as error:
        print(f"real-crowds: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    _command()
