"""The area in which persons walk, as a polygon: the room that walls and doors enclose, and a porch beyond each door."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sweep import extras
from sweep.exports.frames import Doors, Frames, doors

PORCH = 1.0  # m, how far the area reaches beyond a door, at least
MARGIN = 0.5  # m, around the farthest place beyond a door, or around everybody where no walls enclose an area
BEHIND_WALLS = 0.05  # m; nobody's centre comes as close to the outside of a wall
PURPOSE = "the polygon of the walkable area"


def walkable(run: xr.Dataset, shown: Frames) -> Any:
    """The walkable area of a run as one shapely polygon, m.

    It is made of all faces between walls and doors in which somebody was seen, with a porch as wide as the door beyond
    each. Where walls do not enclose everybody (open corridors), it is the rectangle around walls, doors and places.

    Parameters
    ----------
    run : one run
    shown : its places, all of which lie in the area

    Raises
    ------
    BadInput
        If shapely is not installed.
    """
    shapely = extras.load("shapely", "pedpy", PURPOSE)
    segments = np.concatenate([run["wall"].values.reshape(-1, 2, 2), run["door"].values.reshape(-1, 2, 2)])
    places = shapely.multipoints(shown.table[["x", "y"]].to_numpy())
    faces = shapely.polygonize([shapely.union_all(shapely.linestrings(segments))]).geoms if len(segments) else []
    lines = doors(run)
    porches = [_porch(shapely, lines, k, _beyond(run, shown, k)) for k in range(len(lines.width))]
    used = [face for face in faces if face.intersects(places)]
    area = shapely.union_all([*used, *porches])
    if used and area.geom_type == "Polygon" and area.covers(places):
        return shapely.normalize(area)
    everything = shapely.union_all([shapely.multilinestrings(segments), *porches]) if len(segments) else places
    corners = np.array([everything.bounds, places.bounds])
    return shapely.box(*(corners[:, :2].min(axis=0) - MARGIN), *(corners[:, 2:].max(axis=0) + MARGIN))


def _beyond(run: xr.Dataset, shown: Frames, door: int) -> NDArray[np.float64]:
    """Places of those who have left by a door: (places, 2) m."""
    by_it = run["exit_door"].values == door
    left = dict(zip(run["exit_person"].values[by_it].tolist(), run["exit_time"].values[by_it], strict=True))
    table = shown.table
    gone = table["frame"] / shown.rate >= table["id"].map(left)  # nan for those who leave elsewhere
    return table.loc[gone, ["x", "y"]].to_numpy()


def _porch(shapely: Any, lines: Doors, k: int, beyond: NDArray[np.float64]) -> Any:
    """An area that begins at door k, as wide as the door, and holds all who are seen beyond.

    It widens a little behind the door, so that it does not swallow the walls beside it.
    """
    away = beyond - lines.start[k]
    beside, ahead = away @ lines.along[k], away @ lines.outward[k]
    wide = beside[ahead > BEHIND_WALLS]
    depth = max(PORCH, ahead.max(initial=0.0) + MARGIN)
    low, high = min(wide.min(initial=0.0), 0.0), max(wide.max(initial=0.0), lines.width[k])

    def box(first: float, last: float, near: float) -> Any:
        corners = ((first, near), (last, near), (last, depth), (first, depth))
        return shapely.Polygon([lines.start[k] + a * lines.along[k] + d * lines.outward[k] for a, d in corners])

    return box(0.0, lines.width[k], 0.0).union(box(low, high, BEHIND_WALLS))
