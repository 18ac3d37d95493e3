"""Granular clusters: groups of persons in touch with each other (Parisi & Dorso 2005, Eq. 5)."""

import numpy as np
import xarray as xr
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from studies.measures.contacts import History, Ints, history
from studies.measures.facts import described

LARGE = 10  # persons; Parisi & Dorso (2005), Fig. 5, counts clusters of more


def cluster_sizes(h: History) -> tuple[Ints, Ints]:
    """Sample and number of persons of every cluster of two or more: (clusters,), (clusters,).

    One graph holds all samples side by side, a node for each person at each sample.
    """
    persons = h.shape[1]
    pair = h.j >= 0
    base = h.sample[pair] * persons
    ends = (base + h.i[pair], base + h.j[pair])
    touched = np.zeros(h.inside.size, dtype=bool)
    touched[ends[0]] = touched[ends[1]] = True
    number = touched.cumsum() - 1
    nodes = np.flatnonzero(touched)
    graph = csr_array((np.ones(pair.sum(), dtype=np.int8), tuple(number[end] for end in ends)), (nodes.size,) * 2)
    clusters, label = connected_components(graph, directed=False)
    sample = np.zeros(clusters, dtype=np.int64)
    sample[label] = nodes // persons
    return sample, np.bincount(label, minlength=clusters)


def granular_clusters(run: xr.Dataset) -> xr.Dataset:
    """Granular clusters at each sample: connected parts of the graph of contacts r_ij < R_i + R_j (Eq. 5).

    Persons are joined by contacts among those inside; contacts with walls join nobody, and a person who
    touches nobody is in no cluster.

    Parameters
    ----------
    run : one run with recorded contacts, see `contacts.history`

    Returns
    -------
    Dataset with `largest_cluster`, persons in the largest cluster, and `clusters`, their number, (sample);
    `cluster_count` (cluster_size), how many clusters of each size, from 2 persons, all samples together hold.

    Raises
    ------
    ValueError
        If a variable is missing or contacts do not fit persons and samples.
    """
    h = history(run)
    sample, size = cluster_sizes(h)
    samples, persons = h.shape
    largest = np.zeros(samples, dtype=np.int64)
    np.maximum.at(largest, sample, size)
    number = np.bincount(sample, minlength=samples)
    counts = np.bincount(size, minlength=persons + 1)[2:]
    found = xr.Dataset(
        {
            "largest_cluster": described(xr.DataArray(largest, dims="sample"), "1", "persons in the largest cluster"),
            "clusters": described(xr.DataArray(number, dims="sample"), "1", "granular clusters"),
            "cluster_count": described(xr.DataArray(counts, dims="cluster_size"), "1", "clusters of this size"),
        },
        coords={"time": run["time"], "cluster_size": np.arange(2, persons + 1)},
    )
    found["cluster_size"].attrs = {"units": "1", "long_name": "persons in a granular cluster"}
    return found
