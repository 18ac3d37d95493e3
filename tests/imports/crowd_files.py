"""Small files in the text format of the Jülich data archive, made by hand."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

HEAD = ("# PeTrack project: made_up.pet", "# framerate: 25 fps", "# id frame x/m y/m z/m")


def written(path: Path, rows: Sequence[Sequence[float]], head: Sequence[str] = HEAD, between: str = " ") -> Path:
    """Rows of id, frame, x, y, and a height."""
    lines = [between.join(f"{value:g}" for value in (*row, 1.76)) for row in rows]
    path.write_text("\n".join([*head, *lines]) + "\n", "utf-8")
    return path


def walkers(times: Sequence[float], speed: float = 1.0, rate: float = 25.0) -> list[tuple[float, ...]]:
    """Person k + 1 walks down its own line and crosses y = -0.5 m at times[k] s; seen for 1 s before and after."""
    rows = []
    for k, when in enumerate(times):
        x = 0.3 * np.sin(k)
        for frame in range(max(int((when - 1.0) * rate), 0), int((when + 1.0) * rate) + 1):
            rows.append((k + 1, frame, x, -0.5 - speed * (frame / rate - when)))
    return rows
