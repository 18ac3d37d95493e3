"""Blocking as a hazard per exit: does one crowd size tell how often others block? From the runs of Figures 7 to 10."""

import sys

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies import measures
from studies.lin import artefact
from studies.lin.sweeps import Sweeps
from studies.measures.blocking import run_counts
from studies.measures.hazard import CONSTANT, CROWD, POWERS, Law, fit, predicted
from studies.measures.uncertainty import poisson
from studies.presentation import figures
from studies.presentation.estimates import STYLES, V_D, said
from studies.presentation.verdicts import Verdict, interval

LEVEL, CLEAR = 0.05, 0.2  # of the test: below, a law is ruled out; between, left open
BINS = 6  # of persons inside
FASTEST = 4  # v_d that are drawn in the upper panel at most
LEAST = 1e-4  # per exit, lower end of the upper panel
HEIGHT = 5.4  # in
TRAINED = {"constant": ((100,), CONSTANT), "crowd": ((200,), POWERS)}  # crowds that a law is fitted to, and its powers


def measure(sweeps: Sweeps) -> xr.Dataset:
    """Laws fitted to one crowd size and what they predict of all sizes; chances by persons inside."""
    return judged(sweeps.speeds)


def judged(ds: xr.Dataset) -> xr.Dataset:
    """The same of any gathered dataset with the axes v_d, N and seed: any variant, any room."""
    counts = measures.chances(ds)
    runs = run_counts(ds, "seed")
    laws = {name: _fitted(counts, sizes, powers) for name, (sizes, powers) in TRAINED.items()}
    whole = {name: fit(counts.sum("N"), powers) for name, powers in (("constant", CONSTANT), ("crowd", POWERS))}
    made = [
        xr.concat(
            [_against(laws[name], int(N), runs.sel(N=N)) for N in ds.N.values], "N", coords="minimal", compat="override"
        )
        for name in laws
    ]
    found = xr.concat(made, "law", coords="minimal", compat="override")
    found = found.assign_coords(law=list(laws), N=ds.N.values, v_d=ds.v_d.values)
    powers = [whole["crowd"].power, whole["crowd"].power_low, whole["crowd"].power_high]
    gain = 2.0 * (whole["crowd"].log_likelihood - whole["constant"].log_likelihood)
    shares = measures.blocked_share(ds)
    return (
        found.assign(shares.data_vars)
        .assign(counts.data_vars)
        .assign(
            power=("limit", powers),
            trained_power=("limit", [laws["crowd"].power, laws["crowd"].power_low, laws["crowd"].power_high]),
            rate=("v_d", whole["crowd"].rate),
            gain=gain,
        )
    )


def _fitted(counts: xr.Dataset, sizes: tuple[int, ...], powers: tuple[float, ...]) -> Law:
    return fit(counts.sel(N=list(sizes)).sum("N"), powers)


def _against(law: Law, N: int, runs: xr.Dataset) -> xr.Dataset:
    return predicted(law, N, runs.blocked.values, runs.runs.values)


# --- Figure -------------------------------------------------------------------------------------------------


def plot(found: xr.Dataset) -> Figure:
    """Above, hazard per exit by persons inside; below, blocked shares beside what one crowd size predicts of others."""
    figure, (hazards, shares) = figures.stacked(2, height=HEIGHT, same=False)
    _hazards(hazards, found)
    _shares(shares, found)
    artefact.labelled([hazards, shares])
    return figure


def _hazards(axis: Axes, found: xr.Dataset) -> None:
    pooled = found[["passed", "failed"]].sum("N")
    often = pooled.failed.sum("inside")
    drawn = [v for v in found.v_d.values if int(often.sel(v_d=v)) > 0][-FASTEST:]
    edges = np.linspace(0, found.inside.size, BINS + 1).astype(int)
    middle = (edges[:-1] + edges[1:] + 1) / 2.0
    n = np.arange(1, found.inside.size + 1)
    for k, ((colour, marker, line), v) in enumerate(zip(STYLES, drawn, strict=False)):
        cell = pooled.sel(v_d=v)
        passed, failed = (np.add.reduceat(cell[name].values, edges[:-1]) for name in ("passed", "failed"))
        tried = (passed + failed).astype(float)
        some = failed > 0
        at = middle[some] + 4.0 * (k - 1)
        limits = np.array([poisson(int(f), t, 0.95) for f, t in zip(failed[some], tried[some], strict=True)])
        hazard = failed[some] / tried[some]
        arms = np.abs([hazard - limits[:, 0], limits[:, 1] - hazard])
        axis.errorbar(at, hazard, arms, fmt=marker, ms=3, capsize=2, lw=0.8, color=colour)
        law = -np.expm1(-float(found.rate.sel(v_d=v)) * (n / CROWD) ** float(found.power[0]))
        axis.plot(n, law, color=colour, ls=line, lw=1)
        axis.errorbar([], [], [], fmt=marker, ls=line, ms=3, lw=1, color=colour, label=f"{v:g} m/s")
    axis.set(xlabel="persons inside $n$", ylabel="hazard of blocking per exit", yscale="log", ylim=(LEAST, 1.0))
    axis.set_title(f"points: all $N$, 95 %; lines: $n^{{{float(found.power[0]):.1f}}}$", loc="left")
    if drawn:
        axis.legend(loc="upper left", ncols=2, columnspacing=1.0)


def _shares(axis: Axes, found: xr.Dataset) -> None:
    for k, ((colour, marker, _), N) in enumerate(zip(STYLES, found.N.values, strict=False)):
        column = found.sel(N=N)
        at = found.v_d.values + 0.02 * (k - 1)
        share = column.blocked_share.values
        arms = np.abs([share - column.blocked_share_low, column.blocked_share_high - share])
        axis.errorbar(at, share, arms, fmt=marker, ms=3.5, capsize=2, lw=0.8, color=colour, label=f"$N$ = {N}, 95 %")
        crowd, constant = column.sel(law="crowd"), column.sel(law="constant")
        axis.plot(found.v_d, crowd.likeliest_share, color=colour, ls="-", lw=1.2)
        axis.plot(found.v_d, constant.likeliest_share, color=colour, ls=":", lw=1.2)
    axis.plot([], [], color=figures.GREY, lw=1.2, label="from $N$ = 200, grows with $n$")
    axis.plot([], [], color=figures.GREY, ls=":", lw=1.2, label="from $N$ = 100, constant")
    axis.set(xlabel=V_D, ylabel="blocked share", ylim=(-0.03, 1.03))
    axis.legend(loc="upper left")


# --- Verdicts -----------------------------------------------------------------------------------------------


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Nothing of this is published; each line is a statement of this project's, tested on runs it was not fitted to."""
    sizes = [int(N) for N in found.N.values]
    names = {"constant": "constant hazard", "crowd": "hazard that grows with the crowd"}
    out = [
        _prediction(found.sel(law=law, N=N), f"{names[law]}, from N = {', '.join(map(str, trained))}, tells N = {N}")
        for law, (trained, _) in TRAINED.items()
        for N in sizes
        if N not in trained
    ]
    return [*out, _power(found)]


def _prediction(column: xr.Dataset, statement: str) -> Verdict:
    blocked, runs = int(column.blocked.sum()), int(column.runs.sum())
    expected = f"predicted {said(column, 'total', 0)} of {runs} blocked"
    p = float(column.p_value)
    holds = False if p < LEVEL else (True if p >= CLEAR else None)
    return Verdict(statement, expected, f"{blocked} of {runs} blocked, p = {p:.2g}", holds if runs else None)


def _power(found: xr.Dataset) -> Verdict:
    """The likelihood ratio of a power against none, over all crowds."""
    low, high = float(found.power[1]), float(found.power[2])
    text = f"n^{interval(float(found.power[0]), low, high, 2)}, likelihood ratio {float(found.gain):.0f}"
    return Verdict("hazard per exit grows with the persons inside", "power above 0", text, True if low > 0 else None)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
