"""Figure 10 of Lin, Ma & Lo (2016): mean flow against desired speed, and the three states of the crowd."""

import sys

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies import measures
from studies.lin import artefact
from studies.lin.sweeps import Sweeps
from studies.presentation import figures
from studies.presentation.estimates import at as between
from studies.presentation.verdicts import Verdict, interval
from studies.published import lin2016 as paper

LEAST_RUNS = measures.Rules().least_runs  # out of a cell, for an interval to be drawn
TELLING = 0.5  # m/s, width of an interval that still tells something
BOUNDARIES = (("transition_from", "transition"), ("phase_separation_from", "phase_separation"))
PALE = 0.45
STATE_COLOURS = {"smooth": figures.GREEN, "transition": figures.BLUE, "phase_separation": figures.ORANGE}


def measure(sweeps: Sweeps) -> xr.Dataset:
    """All cells of the sweep over v_d and N, and the states of each N."""
    ds = sweeps.speeds
    return classified(ds).assign_attrs(title=f"thinned: {ds.outcome.size} runs" if sweeps.quick else "")


def classified(ds: xr.Dataset) -> xr.Dataset:
    """Mean flow of every run, its mean over the runs that got out, blocked share, clearance time and states."""
    states = measures.states(ds)
    own = [name for name in states if name not in ("runs", "blocked", "censored")]
    return artefact.cells(ds).assign(states[own].data_vars)


# --- Figure -------------------------------------------------------------------------------------------------


def plot(found: xr.Dataset) -> Figure:
    """One panel for each N: every run, means with intervals, blocked shares, states; published bands behind."""
    figure, axes = figures.panels(found.N.size)
    for axis, N in zip(axes, found.N.values, strict=True):
        column = found.sel(N=N)
        _published(axis)
        _runs(axis, column)
        _states(axis, column)
        axis.set_title(f"N = {N}")
        axis.set_xlabel("desired speed $v_d$ / m s$^{-1}$")
    axes[0].set_ylabel("mean flow / s$^{-1}$")
    axes[0].set(ylim=(-0.26, 1.5), xlim=(float(found.v_d.min()) - 0.12, float(found.v_d.max()) + 0.12))
    figure.suptitle(found.attrs.get("title", ""))
    axes[0].set_yticks(np.arange(0.0, 1.51, 0.25))
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _published(axis: Axes) -> None:
    """The paper's statements: the transition's band and mean, and how far phase separation scatters."""
    begin, end = paper.TRANSITION_V_D
    band, mean = paper.TRANSITION_FLOW, [paper.TRANSITION_MEAN_FLOW] * 2
    axis.fill_between([begin, end], *band, color=figures.BLUE, alpha=0.15, lw=0, label="published: transition")
    axis.plot([begin, end], mean, color=figures.BLUE, lw=0.8, ls="--", label="published: its mean")
    scatter = paper.PHASE_SEPARATION_FLOW
    axis.fill_between([end, 2.3], *scatter, color=figures.ORANGE, alpha=0.12, lw=0, label="published: separation")


def _runs(axis: Axes, column: xr.Dataset) -> None:
    got_out = column.flow_of_run.where(column.flow_of_run > 0)
    for k, v_d in enumerate(column.v_d.values):
        flows = got_out.isel(v_d=k).values
        spread = np.linspace(-0.035, 0.035, flows.size)
        axis.plot(v_d + spread, flows, ".", ms=3, color=figures.GREY, label="one run" if k == 0 else None)
        _blocked(axis, v_d, k, int(column.blocked[k]), int(column.runs[k]))
    mean = column.mean_flow
    told = column.out >= LEAST_RUNS  # an interval of fewer runs reaches below zero
    arms = np.abs([mean - column.mean_flow_low.where(told), column.mean_flow_high.where(told) - mean])
    axis.errorbar(
        column.v_d,
        mean,
        arms,
        fmt="o-",
        ms=3,
        color="black",
        capsize=2,
        lw=1,
        label="mean of those out, 95 % from 5 runs",
    )


def _blocked(axis: Axes, v_d: float, k: int, blocked: int, runs: int) -> None:
    """Blocked runs have no flow: crosses at zero, with how many of how many, at two heights lest neighbours touch."""
    if blocked:
        axis.plot([v_d], [0.0], "x", ms=5, color=figures.ORANGE)
        height = 0.05 + 0.07 * (k % 2)
        axis.annotate(f"{blocked}/{runs}", (v_d, height), ha="center", fontsize=6, color=figures.ORANGE)
    if k == 0:
        axis.plot([], [], "x", ms=5, color=figures.ORANGE, label="blocked / runs")


def _states(axis: Axes, column: xr.Dataset) -> None:
    """Below the flows: a strip with the state of each cell, pale inside a boundary's interval, drawn above it."""
    for word, colour in STATE_COLOURS.items():
        axis.fill_between([], [], color=colour, lw=0, label=f"found: {word.replace('_', ' ')}")
    axis.fill_between([], [], color=figures.GREY, alpha=PALE, lw=0, label="pale: not certain")
    axis.plot([], [], "d-", ms=3, lw=1, color=figures.GREY, label="boundary, 95 %")
    words = column.state.attrs["flag_meanings"].split()
    half = float(np.diff(column.v_d).min()) / 2 if column.v_d.size > 1 else 0.1
    cells = zip(column.v_d.values, column.state.values, column.state_certain.values, strict=True)
    for v_d, state, certain in cells:
        colour, depth = STATE_COLOURS.get(words[int(state)], "white"), 1.0 if certain else PALE
        axis.fill_between([v_d - half, v_d + half], -0.25, -0.19, color=colour, alpha=depth, lw=0)
    for height, name, state in ((-0.14, *BOUNDARIES[0]), (-0.09, *BOUNDARIES[1])):
        at, low, high = (float(column[f"{name}{end}"]) for end in ("", "_low", "_high"))
        if np.isfinite([at, low, high]).all():
            arms = [[at - low], [high - at]]
            axis.errorbar([at], [height], xerr=arms, fmt="d", ms=3, capsize=2, lw=1, color=STATE_COLOURS[state])


# --- Verdicts -----------------------------------------------------------------------------------------------


def verdicts(found: xr.Dataset) -> list[Verdict]:
    """Published statements against what was found, as far as the grid holds their v_d and N."""
    return [
        *(_clearance(found, v_d, time) for v_d, time in _published_times().items()),
        *(_rises(found.sel(N=N)) for N in found.N.values),
        *_transition_flow(found),
        _separation_flow(found),
        _free_up_to(found, 1.2),
        _blocks_from(found),
        _all_block_from(found),
        _grows_with(found, "v_d"),
        _grows_with(found, "N"),
        *(_boundary(found.sel(N=N), *which) for which in _boundaries() for N in found.N.values),
    ]


def _published_times() -> dict[float, float]:
    plateau = {1.2: paper.FIG7_PLATEAU_CLEARANCE_TIME, 1.4: paper.FIG7_PLATEAU_CLEARANCE_TIME}
    return paper.FIG7_CLEARANCE_TIME | plateau


def _boundaries() -> list[tuple[str, str, float]]:
    return [
        ("transition_from", "transition from", paper.TRANSITION_FROM),
        ("phase_separation_from", "phase separation from", paper.PHASE_SEPARATION_FROM),
    ]


def _cells(found: xr.Dataset, low: float, high: float, **where: int) -> xr.Dataset:
    """The cells with v_d in [low, high]."""
    return between(found.sel(where).sortby("v_d"), low, high)


def _clearance(found: xr.Dataset, v_d: float, published: float) -> Verdict:
    statement = f"clearance time, N = 200, v_d = {v_d} m/s"
    cell = _cells(found, v_d, v_d, N=200)
    if not cell.v_d.size:
        return Verdict(statement, f"{published:.0f} s", "not in this grid", None)
    return artefact.published_time(statement, cell, published)


def _rises(column: xr.Dataset) -> Verdict:
    flows = _cells(column, *paper.SMOOTH_V_D).mean_flow.values
    text = " < ".join(f"{flow:.2f}" for flow in flows)
    rising = bool((np.diff(flows) > 0).all())
    return Verdict(f"flow rises up to 1.0 m/s, N = {int(column.N)}", "rising", f"{text} /s", rising)


def _transition_flow(found: xr.Dataset) -> list[Verdict]:
    flows = _cells(found, *paper.TRANSITION_V_D).flow_of_run.values
    flows = flows[flows > 0]
    mean, (least, most) = paper.TRANSITION_MEAN_FLOW, paper.TRANSITION_FLOW
    words = f"flow of those out, {paper.TRANSITION_V_D[0]} to {paper.TRANSITION_V_D[1]} m/s"
    of_mean, of_spread = (f"{words}: mean", f"{mean} /s +- 10 %"), (f"{words}: 5-95 %", f"{least} to {most} /s")
    if not flows.size:
        return [Verdict(*of_mean, "no run got out", False), Verdict(*of_spread, "no run got out", False)]
    low, high = np.quantile(flows, [0.05, 0.95])
    runs = int(_cells(found, *paper.TRANSITION_V_D).runs.sum())
    near, within = bool(abs(flows.mean() / mean - 1) <= 0.1), bool(least <= low and high <= most)
    return [
        Verdict(*of_mean, f"{flows.mean():.2f} /s, {flows.size} of {runs} runs out", near),
        Verdict(*of_spread, f"{low:.2f} to {high:.2f} /s", within),
    ]


def _separation_flow(found: xr.Dataset) -> Verdict:
    flows = _cells(found, paper.PHASE_SEPARATION_FROM + 0.1, np.inf).flow_of_run.values
    flows = flows[np.isfinite(flows)]
    least, most = paper.PHASE_SEPARATION_FLOW
    holds = bool(flows.min() == least and abs(flows.max() - most) <= 0.1 * most) if flows.size else None
    text = f"{flows.min():.2f} to {flows.max():.2f} /s" if flows.size else "no runs"
    return Verdict("flow scatters above 1.6 m/s", f"{least:.0f} to {most} /s +- 10 %", text, holds)


def _all_block_from(found: xr.Dataset) -> Verdict:
    v_d = paper.FIG7_BLOCKED_FROM
    cells = _cells(found, v_d, np.inf, N=paper.FIG7_N)
    shares = zip(cells.v_d.values, cells.blocked.values, cells.runs.values, strict=True)
    text = ", ".join(f"{v:g}: {k} of {n}" for v, k, n in shares)
    blocked = bool((cells.blocked == cells.runs).all())
    return Verdict(f"every run blocks from {v_d} m/s, N = {paper.FIG7_N}", "all", text, blocked)


def _free_up_to(found: xr.Dataset, v_d: float) -> Verdict:
    cells = _cells(found, 0.0, v_d, N=200)
    blocked, runs = int(cells.blocked.sum()), int(cells.runs.sum())
    return Verdict(f"no blocking up to {v_d} m/s, N = 200", "0", f"{blocked} of {runs} runs", blocked == 0)


def _blocks_from(found: xr.Dataset) -> Verdict:
    column = found.sel(N=200).sortby("v_d")
    some = column.v_d.values[column.blocked.values > 0]
    text = f"first blocked run at {some[0]:.1f} m/s" if some.size else "no run blocked"
    low, high = paper.BLOCKING_APPEARS
    holds = bool(some.size and low <= some[0] <= high)
    return Verdict("blocking appears, N = 200", f"{low} to {high} m/s", text, holds)


def _grows_with(found: xr.Dataset, axis: str) -> Verdict:
    """Blocked share along one axis, over all cells above 1.4 m/s."""
    cells = _cells(found, 1.4, np.inf)
    rest = "N" if axis == "v_d" else "v_d"
    shares = cells.blocked.sum(rest) / cells.runs.sum(rest)
    text = ", ".join(f"{float(value):g}: {float(share):.0%}" for value, share in zip(shares[axis], shares, strict=True))
    rises = bool((np.diff(shares) >= 0).all() and shares[-1] > shares[0])
    return Verdict(f"blocked share grows with {axis} (from 1.4 m/s)", "grows", text, rises)


def _boundary(column: xr.Dataset, name: str, words: str, published: float) -> Verdict:
    at, low, high = (float(column[f"{name}{end}"]) for end in ("", "_low", "_high"))
    statement, said = f"{words}, N = {int(column.N)}", f"{published} m/s"
    if not np.isfinite(at):
        decision = column[f"{name}_decision"]
        word = decision.attrs["flag_meanings"].split()[int(decision)]
        return Verdict(statement, said, f"undecided ({word.replace('_', ' ')})", None)
    inside = bool(low <= published <= high)
    holds = None if inside and high - low > TELLING else inside  # a wide interval agrees with anything
    return Verdict(statement, said, f"{interval(at, low, high, 2)} m/s", holds)


def main(quick: bool = False, jobs: int = 2) -> None:
    """Draw the figure and print its verdicts."""
    artefact.main(sys.modules[__name__], quick, jobs)
