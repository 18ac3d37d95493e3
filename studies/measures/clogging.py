"""Whether the arch that broke let the next person out: arch-clogging correlation (Parisi & Dorso 2005, Eq. 6)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from studies.measures.arches import arches
from studies.measures.contacts import DIMS, DOOR_DIMS, SLACK, Bools, Floats, check_dims
from studies.measures.delays import PARISI_BINS, delays, in_bins
from studies.measures.facts import described


def arch_clogging(
    run: xr.Dataset,
    clean: bool = True,
    edges: Sequence[float] = PARISI_BINS,
    door: int = 0,
    log: xr.Dataset | None = None,
) -> xr.Dataset:
    """Delays of one run that ended when an arch broke, f of Eq. 6, and their numbers in bins of delay.

    f = 1 for a delay [t1, t2] if an arch that the person who left at t2 belonged to broke in
    [t1, t2 + sampling interval], for a break is seen up to one interval after it happened. Delays are those
    between consecutive exits through the door; the wait after the last exit is none.

    Parameters
    ----------
    run : one run, as for `blocking_clusters`
    clean : bool
        Only arches that were clean, as in `arches`.
    edges : sequence of float, s
        Bins [edge, next edge), as in `delay_counts`.
    door : int
        Number of the door.
    log : Dataset, optional
        What `arches(run, clean, door)` gave, to spare finding the arches again.

    Returns
    -------
    Dataset with `delay_time` (exit) s and `clogged` (exit), 1 or 0, both NaN without a delay, where `exit` is the rank,
    among the exits through this door, after which one waits; `delay_count` and `clogged_count` (delay),
    numbers of all delays in each bin and of those with f = 1; coordinates `delay` and `delay_end`, the bins'
    edges, s. An unstable run has no delays.

    Raises
    ------
    ValueError
        As `arches`; or if the edges do not ascend.
    """
    check_dims(run, {**DIMS, **DOOR_DIMS})
    log = arches(run, clean, door) if log is None else log
    made = run[["exit_time", "exit_person", "outcome"]].isel(exit=np.flatnonzero(run.exit_door == door))
    made = made.assign_coords(exit=np.arange(1, made.sizes["exit"] + 1))
    d = delays(made).delay
    f = d.copy(data=ended_by_arches(made, log)).where(d.notnull())
    return xr.Dataset(
        {
            "delay_time": d,
            "clogged": described(f, "1", "an arch of the person who left had broken"),
            "delay_count": described(in_bins(d, edges), "1", "delays in the bin"),
            "clogged_count": described(in_bins(d.where(f == 1), edges), "1", "delays that ended when an arch broke"),
        }
    )


def ended_by_arches(made: xr.Dataset, log: xr.Dataset) -> Floats:
    """Whether f is 1, for each delay between consecutive exits: (exits - 1,) float, 1 or 0."""
    member = log.arch_person.values
    broke = np.repeat(log.end_time.values, log.arch_size.values)
    t, late = made.exit_time.values, float(log.interval) + SLACK

    def broken(person: int, begin: float, end: float) -> Bools:
        return (member == person) & (broke >= begin - SLACK) & (broke <= end + late)

    ended = zip(made.exit_person.values[1:], t, t[1:], strict=False)
    return np.array([broken(*delay).any() for delay in ended], dtype=np.float64)
