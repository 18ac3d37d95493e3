"""Blocking clusters: chains of persons in touch from one side of a door to the other, and how long they last."""

import numpy as np
import xarray as xr

from studies.measures.contacts import Doorway, History, Ints, doorway, history, touching
from studies.measures.facts import described
from studies.measures.paths import NOBODY, Paths, paths


def link_codes(h: History, way: Doorway) -> tuple[Ints, Ints]:
    """Sample of each contact with a person or a side, and a number for the two: (links,), (links,).

    The sides of the door are two more nodes behind the persons.
    """
    persons = h.shape[1]
    pair = h.j >= 0
    links = [(h.sample[pair], h.i[pair], h.j[pair])]
    for side, walls in enumerate(way.walls, start=persons):
        leans = touching(h, walls)
        links.append((h.sample[leans], h.i[leans], np.full(leans.sum(), side)))
    sample, i, j = (np.concatenate(column) for column in zip(*links, strict=True))
    return sample, coded(i, j, persons)


def coded(i: Ints, j: Ints, persons: int) -> Ints:
    """One number for the two nodes i and j, in either order."""
    return np.asarray(np.minimum(i, j) * (persons + 2) + np.maximum(i, j))


def breaks(h: History, way: Doorway, found: Paths) -> Ints:
    """Sample at which each path is first seen to have lost a contact, side or member: (paths,).

    The number of samples where it never has. A contact lasts while it is listed at consecutive samples.
    """
    samples, persons = h.shape
    chain = np.pad(found.person, ((0, 0), (1, 1)), constant_values=NOBODY)
    chain[:, 0], chain[np.arange(found.sample.size), found.size + 1] = persons, persons + 1
    path, place = np.nonzero(chain[:, 1:] != NOBODY)
    wanted = coded(chain[path, place], chain[path, place + 1], persons)
    sample, code = link_codes(h, way)
    relevant = np.isin(code, wanted, kind="table")
    spacing = samples + 1  # parts the last sample of one pair from the first of the next
    keys = np.sort(code[relevant] * spacing + sample[relevant])
    wanted = wanted * spacing + found.sample[path]
    if (np.searchsorted(keys, wanted) == np.searchsorted(keys, wanted, side="right")).any():
        raise ValueError("paths_of has contacts that the run does not have: pass what blocking_clusters gave of it")
    last = keys[np.diff(keys, append=np.inf) > 1]
    until = np.full(found.sample.size, samples)
    np.minimum.at(until, path, last[np.searchsorted(last, wanted)] % spacing + 1)
    return until


def blocking_clusters(run: xr.Dataset, door: int = 0) -> xr.Dataset:
    """The blocking cluster at each sample, if there is one (Parisi & Dorso 2005, Sec. 4.3, Fig. 6).

    A person touches a side of the door through any wall that ends at that end of the door's line. Among the
    paths of persons inside, in touch from one side to the other, the blocking cluster is the one with the
    least sum of squared distances of its persons to the door's centre. It is clean, and only then is the door
    shut, if no other person inside has its centre in the polygon of the path's centres and the door's ends. Who
    touches whom is taken as recorded; stored places, to 1 mm, decide only between paths and on clean.

    Parameters
    ----------
    run : one run with recorded contacts, see `contacts.history`, and `wall` (wall, 4), `door` (door, 4) m and
        `exit_door` (exit)
    door : int
        Number of the door.

    Returns
    -------
    Dataset with `blocking` and `clean` (sample) bool; `path_size` (sample), persons in the path, which counts
    `path_person` (member), persons from the door's first end to its second, one sample after the other.

    Raises
    ------
    ValueError
        If a variable is missing, there is no such door, no wall at one of its ends, or contacts do not fit
        persons and samples.
    """
    h = history(run)
    return as_dataset(h, paths(h, doorway(run, door)), run["time"])


def as_dataset(h: History, found: Paths, time: xr.DataArray) -> xr.Dataset:
    """What `blocking_clusters` returns."""
    size, clean = np.zeros(h.shape[0], dtype=np.int64), np.zeros(h.shape[0], dtype=bool)
    size[found.sample], clean[found.sample] = found.size, found.clean
    members = xr.DataArray(found.person[found.person != NOBODY], dims="member")
    persons = described(xr.DataArray(size, dims="sample"), "1", "persons in the path", sample_dimension="member")
    return xr.Dataset(
        {
            "blocking": described(persons > 0, "1", "a path from side to side exists"),
            "clean": described(xr.DataArray(clean, dims="sample"), "1", "and it encloses nobody"),
            "path_size": persons,
            "path_person": described(members, "1", "person in the path"),
        },
        coords={"time": time},
    )


def from_dataset(found: xr.Dataset) -> Paths:
    """The paths that a dataset of `blocking_clusters` holds."""
    size = found.path_size.values
    sample = np.flatnonzero(size)
    person = np.full((sample.size, size.max(initial=1)), NOBODY)
    person[np.arange(person.shape[1]) < size[sample, None]] = found.path_person.values
    return Paths(sample, person, found.clean.values[sample])


def arches(run: xr.Dataset, clean: bool = True, door: int = 0, paths_of: xr.Dataset | None = None) -> xr.Dataset:
    """Log of the arches: blocking clusters from when they are first seen until they break.

    A sample's blocking cluster is a new arch unless the same path, unbroken since, is one already; several may
    live at once. An arch lives on, whether it stays the lightest path or not, until the first sample at which
    one of its contacts, the touch of either side or a person inside is missing. Times are those of samples:
    a lifetime is too long or too short by less than the sampling interval.

    Parameters
    ----------
    run : one run, as for `blocking_clusters`
    clean : bool
        Only paths that are clean when they are first seen so; else any.
    door : int
        Number of the door.
    paths_of : Dataset, optional
        What `blocking_clusters(run, door)` gave, to spare finding the paths again.

    Returns
    -------
    Dataset with `begin_time`, `end_time`, `lifetime` (arch) s, the last two NaN for an arch alive at the last
    sample (censored); `arch_size` (arch), which counts `arch_person` (member), from the door's first end to
    its second; `interval` s, the time between samples. In the order of beginning.

    Raises
    ------
    ValueError
        As `blocking_clusters`; or if `paths_of` is of another run.
    """
    h, way = history(run), doorway(run, door)
    found = paths(h, way) if paths_of is None else from_dataset(paths_of)
    return arch_log(h, found, breaks(h, way, found), clean)


def arch_log(h: History, found: Paths, until: Ints, clean: bool) -> xr.Dataset:
    """What `arches` returns, of paths that break at the samples `until` (paths,)."""
    counts = found.clean | (not clean)
    seen = found.sample[counts]
    # The same path that breaks at the same sample was never broken between: it is one arch.
    rows, first = np.unique(np.column_stack([found.person, until])[counts], axis=0, return_index=True)
    order = np.argsort(first, kind="stable")
    person, until, begin = rows[order, :-1], rows[order, -1], seen[first[order]]
    begins, ends = h.time[begin], np.append(h.time, np.nan)[until]
    member = person != NOBODY
    size = xr.DataArray(member.sum(axis=1), dims="arch")
    return xr.Dataset(
        {
            "begin_time": described(xr.DataArray(begins, dims="arch"), "s", "time at which the arch is first seen"),
            "end_time": described(xr.DataArray(ends, dims="arch"), "s", "time at which it is first seen broken"),
            "lifetime": described(xr.DataArray(ends - begins, dims="arch"), "s", "lifetime of the arch"),
            "arch_size": described(size, "1", "persons in the arch", sample_dimension="member"),
            "arch_person": described(xr.DataArray(person[member], dims="member"), "1", "person in the arch"),
            "interval": described(xr.DataArray(h.interval), "s", "sampling interval"),
        }
    )
