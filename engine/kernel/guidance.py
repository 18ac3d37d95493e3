"""Guidance: the desired direction of everybody."""

import math

from engine.kernel.compiled import shared_function
from engine.kernel.state import BLOCK


@shared_function
def aim(exits, persons, n, s):
    """Desired directions of the first n persons.

    Towards the nearest point of the nearest exit, its line shortened by the radius at both ends; straight out for those
    who stand there or have crossed an exit; no direction where there is no exit.
    """
    for first in range(0, n, BLOCK):
        count = min(BLOCK, n - first)
        for p in range(count):
            s[p], s[BLOCK + p], s[2 * BLOCK + p] = persons.x[first + p], persons.y[first + p], persons.radius[first + p]
        for p in range(count):
            s[3 * BLOCK + p], s[4 * BLOCK + p], s[5 * BLOCK + p] = 0.0, 0.0, math.inf
        for k in range(exits.shape[0]):
            line = exits[k]
            x0, y0, ux, uy, length, nx, ny = line.x0, line.y0, line.ux, line.uy, line.length, line.nx, line.ny
            for p in range(count):  # arithmetic without a branch, that the compiler vectorises
                x, y, radius = s[p], s[BLOCK + p], min(s[2 * BLOCK + p], 0.5 * length)
                along = min(max((x - x0) * ux + (y - y0) * uy, radius), length - radius)
                dx, dy = x0 + along * ux - x, y0 + along * uy - y
                distance = math.sqrt(dx * dx + dy * dy)
                there = distance < 1e-9  # straight out
                inverse = 1.0 / max(distance, 1e-9)
                ex, ey = nx if there else dx * inverse, ny if there else dy * inverse
                nearer = distance < s[5 * BLOCK + p]
                s[3 * BLOCK + p] = ex if nearer else s[3 * BLOCK + p]
                s[4 * BLOCK + p] = ey if nearer else s[4 * BLOCK + p]
                s[5 * BLOCK + p] = distance if nearer else s[5 * BLOCK + p]
        for p in range(count):
            persons.ex[first + p] = s[3 * BLOCK + p]
        for p in range(count):
            persons.ey[first + p] = s[4 * BLOCK + p]
    for i in range(n):
        k = persons.exited[i] - 1
        if k >= 0:
            line = exits[k]
            persons.ex[i], persons.ey[i] = line.nx, line.ny
