"""Small gathered datasets with planted facts."""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

MEANINGS = ("missing", "all_out", "blocked", "frozen", "time_limit", "unstable")
PAPER_V_D = np.round(np.arange(0.6, 2.01, 0.2), 1)
PAPER_BLOCKING = {1.6: 0.3, 1.8: 0.8, 2.0: 1.0}
Run = tuple[str, Sequence[float], float, int]  # outcome, exit times, end time, persons


def flagged(outcome: NDArray[np.int8], dims: Sequence[str]) -> xr.Variable:
    attrs = {"flag_values": np.arange(6, dtype=np.int8), "flag_meanings": " ".join(MEANINGS)}
    return xr.Variable(dims, outcome.astype(np.int8), attrs)


def gathered(runs: Sequence[Run], dim: str = "seed", ranks: int | None = None) -> xr.Dataset:
    """Runs along one axis, given by hand."""
    ranks = ranks or max(1, *(len(times) for _, times, _, _ in runs))
    exit_time = np.full((len(runs), ranks), np.nan)
    for row, (_, times, _, _) in enumerate(runs):
        exit_time[row, : len(times)] = times
    outcome = np.array([MEANINGS.index(word) for word, _, _, _ in runs])
    return xr.Dataset(
        {
            "exit_time": ((dim, "exit"), exit_time, {"units": "s"}),
            "outcome": flagged(outcome, [dim]),
            "end_time": (dim, np.array([end for _, _, end, _ in runs]), {"units": "s"}),
            "N_out": (dim, np.array([len(times) for _, times, _, _ in runs], dtype=np.int32)),
            "persons": (dim, np.array([persons for _, _, _, persons in runs], dtype=np.int32)),
        },
        coords={dim: np.arange(len(runs)), "exit": np.arange(1, ranks + 1)},
    )


def rising_to(bend: float, least: float = 0.6, plateau: float = 0.9, power: float = 1.0, fall: float = 0.0) -> Callable:
    """Mean flow that rises from `least` at 0.6 m/s to `plateau` at the bend, then falls with slope `fall`."""
    return lambda v_d: (
        plateau
        - (plateau - least) * (np.maximum(bend - v_d, 0) / (bend - 0.6)) ** power
        - fall * np.maximum(v_d - bend, 0)
    )


def column(
    flow: Callable,
    blocking: dict[float, float],
    seeds: int = 10,
    noise: float = 0.06,
    copies: int = 1,
    v_d: NDArray[np.float64] = PAPER_V_D,
    root: int = 1,
) -> xr.Dataset:
    """Runs of 4 persons with planted mean flow and blocking probability: axes (copy, v_d, seed)."""
    rng = np.random.default_rng(root)
    shape = (copies, v_d.size, seeds)
    flows = flow(v_d)[:, None] * (1.0 + noise * rng.standard_normal(shape))
    share = np.array([blocking.get(float(v), 0.0) for v in v_d])
    stuck = rng.random(shape) < share[:, None]
    exit_time = (4.0 / flows)[..., None] * np.array([0.25, 0.5, 0.75, 1.0])
    exit_time[stuck, 2:] = np.nan
    dims = ("copy", "v_d", "seed")
    return xr.Dataset(
        {
            "exit_time": ((*dims, "exit"), exit_time, {"units": "s"}),
            "outcome": flagged(np.where(stuck, 2, 1), dims),
            "end_time": (dims, np.nanmax(exit_time, axis=-1) + 120.0 * stuck, {"units": "s"}),
            "N_out": (dims, np.where(stuck, 2, 4).astype(np.int32)),
            "persons": (dims, np.full(shape, 4, dtype=np.int32)),
        },
        coords={"copy": np.arange(copies), "v_d": v_d, "seed": np.arange(seeds), "exit": np.arange(1, 5)},
    )


def with_blocked(ds: xr.Dataset, blocked: dict[float, int]) -> xr.Dataset:
    """The same runs, of which exactly so many of each v_d are blocked."""
    ds = ds.copy(deep=True)
    for v_d, number in blocked.items():
        ds.outcome.loc[{"v_d": v_d, "seed": slice(0, number - 1)}] = 2
    return ds
