"""PySocialForce (Moussaid et al. 2010): points that keep away from each other, without contacts."""

import logging
import time
from importlib import import_module
from typing import Any

import numpy as np

from studies.bench.packing import Packing
from studies.bench.peers import Peer, Sample, Timing

STEPS, FEWEST = 20, 2
BUDGET = 2_000_000  # pairs of persons, all with all, in one sample
AHEAD = 100.0  # m, how far away the goals are


def prepare(packing: Packing) -> tuple[Sample, str]:
    """Compile its numba functions."""
    logging.disable()  # it turns on the debug messages of every library, numba's among them
    steps = max(min(STEPS, BUDGET // packing.N**2), FEWEST)
    _simulator(packing).step(1)

    def sample() -> Timing:
        simulator = _simulator(packing)
        start = time.process_time()
        simulator.step(steps)
        return Timing(time.process_time() - start, steps, float(simulator.peds.step_width))

    return sample, "default forces, parameters and step"


def _simulator(packing: Packing) -> Any:
    goals = packing.x + AHEAD
    state = np.column_stack([packing.x, packing.y, packing.vx, packing.vy, goals, packing.y])
    depth, width = packing.depth, packing.width
    walls = [(0, depth, 0, 0), (0, depth, width, width), (0, 0, 0, width), (depth, depth, 0, width)]
    return import_module("pysocialforce").Simulator(state, groups=None, obstacles=walls)


PEER = Peer(
    "pysocialforce",
    "its default forces",
    ("PySocialForce",),
    prepare,
    most=1000,
    why_most="it holds arrays of all N^2 pairs (tens of GB at 10,000)",
)
