"""The path by which persons in touch join the two sides of a door, by Dijkstra's algorithm in all samples at once."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from studies.measures.contacts import Bools, Doorway, Floats, History, Ints, touching

NOBODY = -1
REACHES = (2.0, 4.0, np.inf)  # widths of the door, within which the path is looked for first, then, and at last


class Paths(NamedTuple):
    """The path of each sample that has one, from the wall at the door's first end to that at its second."""

    sample: Ints  # (paths,) ascending
    person: Ints  # (paths, longest) in order, then NOBODY
    clean: Bools  # (paths,)

    @property
    def size(self) -> Ints:
        """Persons in each path: (paths,)."""
        return np.asarray((self.person != NOBODY).sum(axis=1))


def paths(h: History, way: Doorway) -> Paths:
    """The lightest path of each sample, and whether it is clean."""
    sample, person = lightest_paths(h, way)
    return Paths(sample, person, ~anybody_enclosed(h, way, sample, person))


def lightest_paths(h: History, way: Doorway) -> tuple[Ints, Ints]:
    """Path from side to side with the least sum of squared distances to the door's centre, of each sample.

    A path of weight W has no person farther than sqrt(W) from the centre. It is therefore looked for among
    the persons near the door first: what is found there with no more weight than the square of that reach
    is the lightest of all.

    Returns
    -------
    sample : (paths,) int, ascending
    person : (paths, longest) int, padded with NOBODY
    """
    samples, persons = h.shape
    weight = ((h.x - way.centre[0]) ** 2 + (h.y - way.centre[1]) ** 2).ravel()
    node = h.sample * persons + h.i
    sides = [node[touching(h, walls)] for walls in way.walls]
    pair = h.j >= 0
    ends = node[pair], h.sample[pair] * persons + h.j[pair]
    wanted = np.zeros(samples, dtype=bool)
    wanted[np.intersect1d(sides[0] // persons, sides[1] // persons)] = True
    found = []
    for reach in REACHES:
        limit = float((reach * np.linalg.norm(np.diff(way.vertices, axis=0))) ** 2)
        kept = (weight <= limit) & np.repeat(wanted, persons)
        near = [side[kept[side]] for side in sides]
        linked = kept[ends[0]] & kept[ends[1]]
        found.append(dijkstra_paths(weight, near, (ends[0][linked], ends[1][linked]), limit, persons))
        wanted[found[-1][0]] = False
    longest = max(person.shape[1] for _, person in found)
    padded = [np.pad(p, ((0, 0), (0, longest - p.shape[1])), constant_values=NOBODY) for _, p in found]
    sample, person = np.concatenate([s for s, _ in found]), np.concatenate(padded)
    order = np.argsort(sample)
    return sample[order], person[order]


def dijkstra_paths(
    weight: Floats, sides: list[Ints], ends: tuple[Ints, Ints], limit: float, persons: int
) -> tuple[Ints, Ints]:
    """Lightest paths of weight up to `limit`, in all samples at once: as `lightest_paths`.

    An edge weighs what the node weighs that it leads to, and edges lead from an extra node, the source, to
    all nodes at the second side: the length of a way from the source is the sum over its nodes.

    Parameters
    ----------
    weight : (samples * persons,) float, m2
    sides : nodes that touch the first and the second side
    ends : (edges,) nodes in touch
    """
    involved = np.zeros(weight.size, dtype=bool)
    for members in (*sides, *ends):
        involved[members] = True
    nodes, number = np.flatnonzero(involved), involved.cumsum() - 1
    source = nodes.size
    i, j = (number[end] for end in ends)
    first, second = (number[side] for side in sides)
    begins, leads = (np.concatenate(row) for row in ((i, j, np.full(second.size, source)), (j, i, second)))
    graph = csr_array((np.ones(begins.size), (begins, leads)), (source + 1, source + 1))
    graph.data = weight[nodes][graph.indices]  # set, not added up, should a contact be listed twice
    length, before = dijkstra(graph, indices=source, return_predecessors=True, limit=limit)
    first = first[np.isfinite(length[first])]
    first = first[np.lexsort((length[first], nodes[first] // persons))]
    sample, lightest = np.unique(nodes[first] // persons, return_index=True)
    before[source] = source
    steps = [first[lightest]]
    while (steps[-1] != source).any():
        steps.append(before[steps[-1]])
    person = np.append(nodes % persons, NOBODY)
    return sample, person[np.stack(steps[:-1] or steps, axis=1)]


def anybody_enclosed(h: History, way: Doorway, sample: Ints, person: Ints) -> Bools:
    """Whether the centre of another person inside lies in the polygon of path and vertices: (paths,).

    Even-odd rule, all polygons at once; vertices that pad a polygon repeat its last one and cross nothing.
    """
    rows = np.arange(sample.size)[:, None]
    member = person != NOBODY
    end = np.ones((sample.size, 1))
    px, py = (
        np.hstack([end * a, np.where(member, at[sample[:, None], person], b), end * b])
        for at, (a, b) in zip((h.x, h.y), way.vertices.T, strict=True)
    )
    x, y = h.x[sample], h.y[sample]
    others = h.inside[sample]
    others[np.broadcast_to(rows, person.shape)[member], person[member]] = False
    for at, corner in ((x, px), (y, py)):
        others &= (at >= corner.min(axis=1, keepdims=True)) & (at <= corner.max(axis=1, keepdims=True))
    path, who = np.nonzero(others)
    x, y, px, py = x[path, who, None], y[path, who, None], px[path], py[path]
    nx, ny = np.roll(px, -1, axis=1), np.roll(py, -1, axis=1)
    spans = (py > y) != (ny > y)
    # x beyond which a ray to the right crosses the edge, by a product instead of a quotient
    left = ((nx - px) * (y - py) > (x - px) * (ny - py)) == (ny > py)
    enclosed = (spans & left).sum(axis=1) % 2 == 1
    found = np.zeros(sample.size, dtype=bool)
    found[path[enclosed]] = True
    return found
