"""A run for PedPy: its trajectories, walkable area and measurement lines as PedPy's own types."""

from typing import Any, NamedTuple

import xarray as xr

from sweep import extras
from sweep.exports.area import walkable
from sweep.exports.frames import frames

PURPOSE = "the export to PedPy"


class ForPedPy(NamedTuple):
    """What PedPy's functions take."""

    trajectories: Any  # pedpy.TrajectoryData
    area: Any  # pedpy.WalkableArea
    lines: tuple[Any, ...]  # pedpy.MeasurementLine, one at each door


def to_pedpy(run: xr.Dataset) -> ForPedPy:
    """Trajectories, walkable area and a measurement line at each door, for PedPy.

    `pedpy.compute_n_t` on the line of a door counts as many persons at each frame as have left by it: see
    `sweep.exports.frames` for what is shown of those who leave.

    Parameters
    ----------
    run : one run with samples, as `sweep.read_run` or `sweep.to_dataset` gives it

    Raises
    ------
    BadInput
        If PedPy is not installed, or the dataset is not one recorded run.
    """
    pedpy = extras.load("pedpy", "pedpy", PURPOSE)
    shown = frames(run)
    lines = tuple(pedpy.MeasurementLine([(x0, y0), (x1, y1)]) for x0, y0, x1, y1 in run["door"].values.tolist())
    data = pedpy.TrajectoryData(data=shown.table, frame_rate=shown.rate)
    return ForPedPy(data, pedpy.WalkableArea(walkable(run, shown)), lines)
