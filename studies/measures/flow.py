"""Flow through the exit: in time bins, as a mean over the run, and before the exit blocked."""

import numpy as np
import xarray as xr

from studies.measures.exits import Floats, clearance, exits_until, last_exit
from studies.measures.facts import BLOCKED, FINISHED, KNOWN, described, needs, outcome_is


def flow_in_bins(ds: xr.Dataset, width: float = 10.0) -> xr.Dataset:
    """Flow in time bins of one width, up to each run's end (Lin, Ma & Lo 2016, Fig. 9: 10 s).

    An exit at time t belongs to the bin (start, start + width] that holds t; one at t = 0 to the first. A run
    ends with its last exit when all got out, else at `end_time`. The bin in which it ends is watched in part
    only: its flow is NaN, since a count over a few seconds, of which one is an exit by construction, is no
    flow of that width. Its exits and the watched seconds are kept in `exits` and `watched`.

    Parameters
    ----------
    ds : gathered dataset
    width : float, s

    Returns
    -------
    Dataset with `flow` (axes..., time) 1/s, NaN in a partial bin and after the run's end; `exits` (axes...,
    time), and `watched` (axes..., time) s, between 0 and `width`. Coordinates `time` and `time_end`, the
    bins' edges.

    Raises
    ------
    ValueError
        If `width` is not a positive number or a variable is missing.
    """
    if not 0.0 < width < np.inf:
        raise ValueError(f"width {width} s is not a positive time: give the width of the bins in s, such as 10")
    needs(ds, "exit_time", "end_time")
    end = last_exit(ds).where(outcome_is(ds, *FINISHED), ds.end_time).where(outcome_is(ds, *KNOWN))
    longest = float(end.fillna(0.0).max())
    edges: Floats = np.arange(max(1, int(np.ceil(longest / width))) + 1, dtype=np.float64) * np.float64(width)
    made = exits_until(ds, edges[1:], "time")
    exits = made - made.shift(time=1, fill_value=0)
    exits = exits.assign_coords(time=edges[:-1], time_end=("time", edges[1:])).where(end.notnull())
    exits["time"].attrs = {"units": "s", "long_name": "start of the bin"}
    exits["time_end"].attrs = {"units": "s", "long_name": "end of the bin"}
    watched = (end - exits["time"]).clip(0.0, width)
    flow = (exits / width).where(end >= exits["time_end"])
    return xr.Dataset(
        {
            "flow": described(flow, "s-1", "flow"),
            "exits": described(exits, "1", "exits in the bin"),
            "watched": described(watched, "s", "time of the bin before the run's end"),
        }
    )


def mean_flow(ds: xr.Dataset) -> xr.Dataset:
    """Mean flow: persons / clearance time (Lin, Ma & Lo 2016, Fig. 10).

    Returns
    -------
    Dataset with `mean_flow` (axes...) 1/s: 0 where blocked or frozen, whose clearance time is infinite; NaN
    where the time limit came first, the run was unstable or is missing; and `censored`, `censoring_time`.

    Raises
    ------
    ValueError
        If a variable is missing.
    """
    needs(ds, "persons")
    facts = clearance(ds)
    flow = ds.persons / facts.clearance_time.where(facts.clearance_time > 0)
    return facts.drop_vars("clearance_time").assign(mean_flow=described(flow, "s-1", "mean flow"))


def flow_before_blocking(ds: xr.Dataset) -> xr.Dataset:
    """Flow of a blocked run while it lasted: (n - 1)/(t_n - t_1), with n the persons who got out.

    Returns
    -------
    Dataset with `flow_before_blocking` (axes...) 1/s for blocked and frozen runs; NaN for all others and
    where fewer than two persons got out; `N_out`, the n.

    Raises
    ------
    ValueError
        If a variable is missing.
    """
    needs(ds, "exit_time", "N_out")
    lasted = last_exit(ds) - ds.exit_time.fillna(np.inf).min("exit")
    flow = (ds.N_out - 1) / lasted.where((lasted > 0) & outcome_is(ds, *BLOCKED))
    text = "flow from the first to the last exit of a blocked run"
    return xr.Dataset(
        {
            "flow_before_blocking": described(flow, "s-1", text),
            "N_out": described(ds.N_out, "1", "persons who got out"),
        }
    )
