"""States of a crowd at the exit over v_d: smooth, transition, phase separation, or undecided."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from studies.measures.blocking import run_counts
from studies.measures.boundaries import (
    DECISIONS,
    Boundary,
    Ints,
    Rules,
    phase_separation,
    transition,
    undecided,
)
from studies.measures.facts import BLOCKED, Over, count, described, dims_over, outcome_is
from studies.measures.flow import mean_flow
from studies.measures.uncertainty import Floats, check_resampling

STATES = ("smooth", "transition", "phase_separation", "undecided")
SMOOTH, TRANSITION, SEPARATION, UNDECIDED = range(4)
PLACED = ("decided", "below_range", "above_range")
REASONS = tuple(DECISIONS)
DEFAULT = Rules()


def both_boundaries(
    v_d: Floats, flow: Floats, runs: Ints, blocked: Ints, rules: Rules
) -> tuple[Boundary, Boundary, bool]:
    """Transition and phase separation of a column, and whether flows were resampled.

    v_d, runs, blocked : (cells,); flow : (cells, runs) 1/s, NaN where a run has none.
    """
    enough = runs >= rules.least_runs
    if enough.sum() < rules.least_cells:
        few = undecided("too_few_cells" if enough.all() else "too_few_runs")
        return few, few, False
    separation = phase_separation(v_d[enough], runs[enough], blocked[enough], rules)
    if separation.decision not in PLACED:
        return undecided(separation.decision), separation, False
    fitted = enough & (v_d < separation.at) & (np.isfinite(flow).sum(axis=1) >= rules.least_runs)
    rise_ends = transition(v_d[fitted], flow[fitted], v_d, rules)
    return rise_ends, separation, rise_ends.decision not in ("too_few_cells", "no_rise")


def name_cells(v_d: Floats, rise_ends: Boundary, separation: Boundary) -> Ints:
    """State of each cell by the places of the boundaries: (cells,) flag values."""
    state = np.full(v_d.size, UNDECIDED, dtype=np.int64)
    if separation.decision in PLACED:
        state[v_d > separation.at] = SEPARATION
    if rise_ends.decision == "decided":
        state[v_d < separation.at] = TRANSITION
        state[v_d < rise_ends.at] = SMOOTH
    return state


def inside(v_d: Floats, boundary: Boundary) -> NDArray[np.bool_]:
    """Whether each cell lies inside the interval of the boundary: (cells,)."""
    return np.asarray((v_d > boundary.low) & (v_d < boundary.high))


def classified(v_d: Floats, flow: Floats, runs: Ints, blocked: Ints, rules: Rules) -> tuple[object, ...]:
    """What `states` reports of one column, in the order in which it unpacks it."""
    rise_ends, separation, resampled = both_boundaries(v_d, flow.reshape(v_d.size, -1), runs, blocked, rules)
    state = name_cells(v_d, rise_ends, separation)
    state[runs < rules.least_runs] = UNDECIDED
    certain = (state != UNDECIDED) & ~inside(v_d, rise_ends) & ~inside(v_d, separation)
    reasons = REASONS.index(rise_ends.decision), REASONS.index(separation.decision)
    return state, certain, *rise_ends[:3], *separation[:3], *reasons, rules.resamples * resampled


def flag(values: xr.DataArray, words: tuple[str, ...], long_name: str, **attrs: object) -> xr.DataArray:
    """CF flag variable whose values are the places of the words."""
    codes = np.arange(len(words), dtype=np.int8)
    return described(values.astype(np.int8), "1", long_name, flag_values=codes, flag_meanings=" ".join(words), **attrs)


def boundary_variables(name: str, text: str, found: tuple[xr.DataArray, ...], rules: Rules) -> dict[str, xr.DataArray]:
    """A boundary, its two limits and its decision, named and described."""
    at, low, high, decision = found
    sentences = "; ".join(f"{word}: {sentence}" for word, sentence in DECISIONS.items())
    return {
        name: described(at, "m s-1", f"v_d from which {text}"),
        f"{name}_low": described(low, "m s-1", f"{name}: lower limit", confidence=rules.confidence),
        f"{name}_high": described(high, "m s-1", f"{name}: upper limit", confidence=rules.confidence),
        f"{name}_decision": flag(decision, REASONS, f"{name}: what was decided, and why", comment=sentences),
    }


def states(ds: xr.Dataset, over: Over = "seed", rules: Rules = DEFAULT, along: str = "v_d") -> xr.Dataset:
    """Classify each cell of each column over v_d, and place the two boundaries between the states.

    Phase separation begins at the lowest v_d from which blocking is established: a step fit to the numbers of
    blocked runs of all cells, with a share of at most `rules.stray` below the step and at least
    `rules.established` from it on. All cells have a say, so that one stray blocked run far below the step
    does not begin it. Below it, the state is smooth where the mean flow of the runs that got out rises with
    v_d and transition where it no longer does: a broken-stick fit to the cells' mean flows. See `boundaries`
    for both fits. The states are those of Lin, Ma & Lo (2016), Fig. 10 (smooth to 1.0, transition to 1.6
    m/s); fits and thresholds are this project's.

    Parameters
    ----------
    ds : gathered dataset
    over : str or sequence of str
        Dimensions of repeated runs. Every other axis but `along` gives columns of its own.
    rules : Rules
        Thresholds, confidence, number of resamples and their seed.
    along : str
        The axis of v_d.

    Returns
    -------
    Dataset, sorted by `along`, with, for each cell (columns..., v_d): `state`, a CF flag, by the places of
    the boundaries; undecided where a boundary that it needs is, or where the cell has fewer than
    `rules.least_runs` runs; `state_certain`, False inside an interval of a boundary as well; `runs`,
    `blocked`, `censored` (at the time limit), and `flows`, the runs whose mean flow is fitted; for each
    column, m/s: `transition_from` and `phase_separation_from` with `_low`, `_high`: NaN when undecided, -inf
    or inf when beyond the scanned range; `_decision`, a CF flag whose `comment` says what each word means;
    and `n_resamples` of the transition's interval, 0 where nothing was resampled (the interval of phase
    separation needs none).

    Raises
    ------
    ValueError
        If `over` or `along` is not a dimension, a threshold has no sense, or a variable is missing.
    """
    dims, _ = dims_over(ds, over), dims_over(ds, along)
    if along in dims:
        raise ValueError(f"over={over!r} holds along={along!r}: the axis of v_d cannot be averaged over, name another")
    check_rules(rules)
    ds = ds.sortby(along)
    flow = mean_flow(ds).mean_flow.where(~outcome_is(ds, *BLOCKED))
    counts = run_counts(ds, dims)
    found = xr.apply_ufunc(
        lambda v, f, n, k: classified(v, f, n, k, rules),
        ds[along].astype(np.float64),
        flow,
        counts.runs,
        counts.blocked,
        input_core_dims=[[along], [along, *dims], [along], [along]],
        output_core_dims=[[along]] * 2 + [[]] * 9,
        vectorize=True,
    )
    state, certain, at, low, high, begins, begins_low, begins_high, why, why_begins, resamples = found
    rise_ends = boundary_variables("transition_from", "mean flow no longer rises", (at, low, high, why), rules)
    separation = boundary_variables(
        "phase_separation_from",
        "blocking is established",
        (begins, begins_low, begins_high, why_begins),
        rules,
    )
    counts = counts.assign(
        flows=count(flow.notnull(), dims, "runs whose mean flow is fitted"),
        state=flag(state, STATES, "state of the crowd at the exit"),
        state_certain=described(certain.astype(bool), "1", "cell lies outside both intervals"),
        n_resamples=described(resamples.astype(np.int64), "1", "resamples behind the interval of transition_from"),
    )
    return counts.assign(rise_ends).assign(separation).transpose(..., along)


def check_rules(rules: Rules) -> None:
    """Raise ValueError for thresholds that have no sense."""
    check_resampling(rules.confidence, rules.resamples)
    if not 0.0 < rules.stray < rules.established < 1.0:
        raise ValueError(
            f"stray={rules.stray}, established={rules.established} do not part free from blocked cells:"
            " 0 < stray < established < 1 is required"
        )
    if rules.least_runs < 2 or rules.least_cells < 4:
        raise ValueError(
            f"least_runs={rules.least_runs}, least_cells={rules.least_cells} leave no error to estimate:"
            " give at least 2 and 4"
        )
