"""Small recorded runs: who stands where, who touches whom, who leaves when, all given by hand.

The door goes from (0, -0.6) to (0, 0.6) m, the room lies left of it. Wall 0 ends at the lower vertex, wall 1 at the
upper one, wall 2 nowhere near.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tests.measures.planted import MEANINGS, flagged

LOWER, UPPER, FAR = -1, -2, -3  # walls 0, 1 and 2, as contact_j has them
WALLS = ((0.0, -10.0, 0.0, -0.6), (0.0, 0.6, 0.0, 10.0), (-20.0, -10.0, -20.0, 10.0))
DOORS = ((0.0, -0.6, 0.0, 0.6),)
Contacts = Sequence[tuple[int, int]]

# An arch of the persons 0, 1 and 2. Person 3 stands inside the arch, person 4 behind it.
PLACES = ((-0.3, -0.6), (-0.6, 0.0), (-0.3, 0.6), (-0.2, 0.0), (-1.2, 0.0))
ARCH = ((0, LOWER), (0, 1), (1, 2), (2, UPPER))


def recorded(
    contacts: Sequence[Contacts],
    places: ArrayLike = PLACES,
    exits: Sequence[tuple[float, int]] = (),
    step: float = 0.5,
    outcome: str = "time_limit",
    walls: Sequence[Sequence[float]] = WALLS,
    doors: Sequence[Sequence[float]] = DOORS,
    exit_door: Sequence[int] | None = None,
) -> xr.Dataset:
    """A run sampled every `step` s from 0 on, with these contacts at each sample.

    places : (persons, 2) or (samples, persons, 2) m; exits : time in s and person, in order.
    """
    samples = len(contacts)
    at = np.array(places, dtype=np.float32)
    at = np.broadcast_to(at, (samples, *at.shape[-2:]))
    pairs = np.array([pair for sample in contacts for pair in sample], dtype=np.int32).reshape(-1, 2)
    when = np.array([time for time, _ in exits], dtype=np.float64)
    time = step * np.arange(samples)
    return xr.Dataset(
        {
            "x": (("sample", "person"), at[..., 0]),
            "y": (("sample", "person"), at[..., 1]),
            "row_size": ("sample", np.array([len(sample) for sample in contacts], dtype=np.int32)),
            "contact_i": ("contact", pairs[:, 0]),
            "contact_j": ("contact", pairs[:, 1]),
            "wall": (("wall", "end"), np.array(walls)),
            "door": (("door", "end"), np.array(doors)),
            "exit_time": ("exit", when, {"units": "s"}),
            "exit_person": ("exit", np.array([person for _, person in exits], dtype=np.int32)),
            "exit_door": ("exit", np.array(exit_door or [0] * len(exits), dtype=np.int16)),
            "outcome": flagged(np.array(MEANINGS.index(outcome)), []),
            "end_time": ((), time[-1]),
            "N_out": ((), len(exits)),
            "persons": ((), at.shape[1]),
        },
        coords={"time": ("sample", time), "exit": np.arange(1, len(exits) + 1)},
    )


def without(contacts: Contacts, *lost: tuple[int, int]) -> list[tuple[int, int]]:
    """The contacts less those that are lost."""
    return [pair for pair in contacts if pair not in lost]


def ragged(members: xr.DataArray, sizes: xr.DataArray) -> list[list[int]]:
    """Members row by row."""
    return [row.tolist() for row in np.split(members.values, np.cumsum(sizes.values)[:-1])] if sizes.size else []


def scribbled(
    samples: int,
    persons: int,
    seed: int,
    touch: float = 0.35,
    lean: float = 0.35,
    change: float = 1.0,
    wide: float = 5.0,
) -> xr.Dataset:
    """A run of persons at random places with random contacts, some of whom leave, all without sense.

    touch, lean : share of pairs, and of persons and sides, in touch; change : share renewed from sample to sample;
    wide : m, how far from the door people stand.
    """
    rng = np.random.default_rng(seed)
    pairs = [(i, j) for i in range(persons) for j in range(i)]
    pairs += [(i, wall) for i in range(persons) for wall in (LOWER, UPPER, FAR)]
    share = np.array([touch if j >= 0 else lean for _, j in pairs])
    on = rng.random(len(pairs)) < share
    contacts = []
    for _ in range(samples):
        renewed = rng.random(len(pairs)) < change
        on = np.where(renewed, rng.random(len(pairs)) < share, on)
        contacts.append([pair for pair, is_on in zip(pairs, on, strict=True) if is_on])
    places = rng.uniform((-wide, -wide), (0.0, wide), (samples, persons, 2))
    if change < 1.0:
        places = places[:1]
    leavers = rng.permutation(persons)[: persons // 2]
    times = np.sort(rng.uniform(0.0, 0.1 * samples, leavers.size))
    return recorded(
        contacts, np.broadcast_to(places, (samples, persons, 2)), list(zip(times, leavers, strict=True)), 0.1
    )
