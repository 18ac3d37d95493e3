"""Crossings of a measurement line as exits: trajectories become what the measures of a simulated run take."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from engine import OUTCOMES
from engine.errors import finite, require
from sweep.schema import RANK, VARIABLES

Floats = NDArray[np.float64]
RIGHT_ANGLE = 1e-6  # share of the direction that is along the line
NEEDED = ("time", "x", "y")


def crossings(trajectories: xr.Dataset, line: ArrayLike, towards: ArrayLike) -> xr.Dataset:
    """Exit times of the persons who cross a line, in order, as a run has them.

    Somebody leaves at the first crossing in the direction asked for; the time is interpolated between the frames
    before and after, also where frames in between are missing. Nobody is taken back who returns. Persons who never
    cross count as inside.

    Parameters
    ----------
    trajectories : Dataset with `time` (sample) s, `x`, `y` (sample, person) m, such as `read_trajectories` gives
    line : ends of the line, ((x0, y0), (x1, y1)) m
    towards : direction in which one crosses it to leave, (dx, dy), not along the line

    Returns
    -------
    Dataset with `exit_time` s, `exit_person`, `exit_x`, `exit_y` m, `exit_door` (exit), and of the run `outcome`,
    `end_time` s, `N_out`, `persons`, and `door`. The outcome is "all_out", or "time_limit" where somebody had not
    crossed at the end of the recording, which `end_time` then is.

    Raises
    ------
    BadInput
        If a variable is missing, the line has no length, or the direction runs along it.
    """
    absent = [name for name in NEEDED if name not in trajectories.variables]
    remedy = "pass what sweep.imports.read_trajectories gives"
    require(not absent, "dataset", f"without {', '.join(absent)}", "has no trajectories", remedy)
    start, along, out = _directions(line, towards)
    time = trajectories["time"].values.astype(np.float64)
    x, y = (trajectories[name].transpose("sample", "person").values.astype(np.float64) for name in ("x", "y"))
    found = [_first(time, np.column_stack([x[:, k], y[:, k]]) - start, along, out) for k in range(x.shape[1])]
    when = np.array([t for t, _ in found])
    order = np.argsort(when, kind="stable")[: int(np.isfinite(when).sum())]
    places = start + np.array([s for _, s in found])[order, None] * along
    return _run(trajectories, when[order], order, places, start, along)


def _directions(line: ArrayLike, towards: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """Start of a line, the vector to its end (m), and the unit vector across it on the side that one leaves to."""
    ends = np.array(finite("line", np.ravel(np.asarray(line, dtype=object)).tolist(), 4)).reshape(2, 2)
    way = np.array(finite("towards", np.ravel(np.asarray(towards, dtype=object)).tolist(), 2))
    along = ends[1] - ends[0]
    length = np.hypot(*along)
    require(length > 0, "line", ends.tolist(), "has no length", "give two different ends")
    across = np.array([-along[1], along[0]]) / length
    share = float(across @ way)
    good = abs(share) > RIGHT_ANGLE * np.hypot(*way)
    require(good, "towards", way.tolist(), "does not lead across the line", "give a direction across it")
    return ends[0], along, across * np.sign(share)


def _first(time: Floats, at: Floats, along: Floats, out: Floats) -> tuple[float, float]:
    """First crossing of one person, s and share of the line's length; inf, nan if there is none.

    at : (samples, 2) m from the line's start, nan where the person was not seen. One crosses with the step that ends
    beyond the line.
    """
    seen = np.isfinite(at).all(axis=1)
    t, at = time[seen], at[seen]
    ahead, beside = at @ out, at @ along / (along @ along)
    before = np.flatnonzero((ahead[:-1] <= 0.0) & (ahead[1:] > 0.0))
    share = -ahead[before] / (ahead[before + 1] - ahead[before])
    where = beside[before] + share * (beside[before + 1] - beside[before])
    on = np.flatnonzero((where >= 0.0) & (where <= 1.0))
    if not on.size:
        return np.inf, np.nan
    k = on[0]
    return float(t[before[k]] + share[k] * (t[before[k] + 1] - t[before[k]])), float(where[k])


def _run(
    trajectories: xr.Dataset, when: Floats, who: NDArray[np.intp], places: Floats, start: Floats, along: Floats
) -> xr.Dataset:
    """Crossings under the names, types and attributes of a run."""
    persons, time = trajectories.sizes["person"], trajectories["time"].values
    everybody = when.size == persons
    end = start + along
    values: dict[str, Any] = {
        "exit_time": when,
        "exit_person": who,
        "exit_x": places[:, 0],
        "exit_y": places[:, 1],
        "exit_door": np.zeros(when.size),
        "outcome": OUTCOMES.index("all_out" if everybody else "time_limit"),
        "end_time": when[-1] if everybody else time[-1],
        "N_out": when.size,
        "persons": persons,
        "door": [[*start, *end]],
    }
    known = {v.name: v for v in VARIABLES}
    variables = {}
    for name, value in values.items():
        v = known[name]
        dims = tuple(dim for dim in v.dims if dim != "run")
        variables[name] = (dims, np.asarray(value).astype(v.dtype), v.attributes())
    ranks = ("exit", np.arange(1, when.size + 1), RANK)
    attrs = {"title": "Crossings of a line", "source": str(trajectories.attrs.get("source", ""))}
    return xr.Dataset(variables, coords={"exit": ranks}, attrs=attrs)
