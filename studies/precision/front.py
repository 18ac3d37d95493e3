"""What is not beaten in both work and precision."""

from collections.abc import Sequence


def pareto(points: Sequence[tuple[float, float]]) -> list[int]:
    """Which points no other beats, by rising cost: none is at most as dear and as wrong, and less so in one.

    Parameters
    ----------
    points : cost and error of each; points with a nan are left out
    """
    order = sorted((i for i, (c, e) in enumerate(points) if c == c and e == e), key=lambda i: points[i])
    best, front = float("inf"), []
    for i in order:
        if points[i][1] < best:
            best = points[i][1]
            front.append(i)
    return front
