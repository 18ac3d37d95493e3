"""A run as a film, drawn by matplotlib."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure

from engine.errors import require
from sweep.pages.motion import box_of, check_playable, common_top, force_on_each, speeds
from sweep.pages.touching import Contacts, contacts_of
from sweep.storage.durable import replace_durably

COLOURS = {"speed": ("viridis", "speed, m/s"), "force": ("cividis", "contact force on a person, N")}
FRAMES = {".mp4": 25, ".gif": 12}  # a second
FULL = 2000.0  # N, of a contact drawn as wide as any
SIZE, DPI = (9.6, 6.0), 100  # inch, 960 x 600 pixels


def write_film(run: xr.Dataset, path: Path, rate: float = 4.0, colour: str = "speed") -> None:
    """Draw a run as a film: the room, contacts, and persons inside against time.

    Parameters
    ----------
    run : one run with samples, as `sweep.read_run` and `sweep.to_dataset` give it
    path : an .mp4 file, for which ffmpeg is needed, or a .gif file
    rate : seconds of the run in one of the film
    colour : "speed" or "force", the sum of the normal contact forces on a person

    Raises
    ------
    BadInput
        If the run has no samples, the path ends otherwise, there is no ffmpeg, or the law of contact is not known.
    """
    check_playable(run)
    kind = path.suffix.lower()
    require(kind in FRAMES, "film", f"'{path}'", "is no .mp4 or .gif", "choose one of these endings")
    require(rate > 0, "rate", rate, "is not above 0", "give seconds of the run for one of the film")
    require(colour in COLOURS, "colour", repr(colour), "is not known", f"choose one of {', '.join(COLOURS)}")
    there = kind != ".mp4" or FFMpegWriter.isAvailable()
    require(there, "film", f"'{path}'", "needs ffmpeg, which is not installed", "install it, or write a .gif")
    begin, end = span(run)
    times = np.append(np.arange(begin, end, rate / FRAMES[kind]), end)
    drawing = Drawing(run, colour)

    def write(temporary: Path) -> None:
        named = temporary.with_suffix(kind)  # writers tell formats by endings
        try:
            with _writer(kind).saving(drawing.figure, str(named), DPI) as writer:
                for time in times:
                    drawing.show(float(time))
                    writer.grab_frame()
            named.replace(temporary)
        finally:
            named.unlink(missing_ok=True)

    replace_durably(path, write)


def _writer(kind: str) -> AbstractMovieWriter:
    if kind == ".gif":
        return PillowWriter(fps=FRAMES[kind])
    return FFMpegWriter(fps=FRAMES[kind], codec="h264", extra_args=["-pix_fmt", "yuv420p", "-crf", "20"])


class Drawing:
    """A figure of the run that can be set to any time.

    Parameters
    ----------
    run : one run with samples
    colour : "speed" or "force"
    """

    def __init__(self, run: xr.Dataset, colour: str) -> None:
        self.run, self.contacts = run, contacts_of(run)
        self.first = np.concatenate([[0], np.cumsum(self.contacts.row_size)])
        self.values, top = _coloured(run, self.contacts, colour)
        self.figure = Figure(figsize=SIZE, layout="constrained")
        room, curve = self.figure.subplots(1, 2, width_ratios=[3, 2])
        x0, y0, x1, y1 = box_of(run)
        room.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x, m", ylabel="y, m")
        room.add_collection(LineCollection(run.wall.values.reshape(-1, 2, 2), colors="black", linewidths=2))
        room.add_collection(LineCollection(run.door.values.reshape(-1, 2, 2), colors="green", linestyles=":"))
        width = 2 * run.radius.values
        offsets = np.column_stack([run.x.values[0], run.y.values[0]])
        self.discs = EllipseCollection(
            width, width, 0 * width, units="xy", offsets=offsets, offset_transform=room.transData
        )
        self.discs.set(cmap=COLOURS[colour][0], clim=(0, top), edgecolor="black", linewidth=0.4)
        room.add_collection(self.discs)
        self.touching = LineCollection([], colors="black", alpha=0.7)
        room.add_collection(self.touching)
        self.figure.colorbar(self.discs, ax=room, label=COLOURS[colour][1], location="bottom", shrink=0.8, extend="max")
        self.title = room.set_title("")
        self.left = np.full(run.sizes["person"], np.inf)
        good = np.isfinite(run.exit_time.values)
        self.left[run.exit_person.values[good]] = run.exit_time.values[good]
        self.exits = run.exit_time.values[good]
        begin, end = span(run)
        steps = np.concatenate([[begin], self.exits, [end]])
        inside = run.sizes["person"] - np.concatenate([np.arange(self.exits.size + 1), [self.exits.size]])
        curve.step(steps, inside, where="post")
        curve.set(xlabel="time, s", ylabel="persons inside", ylim=(0, run.sizes["person"] * 1.03))
        (self.mark,) = curve.plot([begin], [run.sizes["person"]], "o", color="black")

    def show(self, time: float) -> None:
        """Set it to a time, s."""
        run = self.run
        k = int(np.searchsorted(run.time.values, time + 1e-9, side="right")) - 1
        x, y = self._places(k, time)
        self.discs.set_offsets(np.column_stack([x, y]))
        self.discs.set_array(self.values[k])
        i, j = (part[self.first[k] : self.first[k + 1]] for part in (self.contacts.i, self.contacts.j))
        pair = j >= 0
        i, j = i[pair], j[pair]
        self.touching.set_segments(list(np.stack([np.column_stack([x[i], y[i]]), np.column_stack([x[j], y[j]])], 1)))
        if self.contacts.force is not None:
            force = self.contacts.force[self.first[k] : self.first[k + 1]][pair]
            self.touching.set_linewidth((0.4 + 4.0 * np.minimum(force / FULL, 1.0)).tolist())
        inside = run.sizes["person"] - int(np.searchsorted(self.exits, time, side="right"))
        self.title.set_text(f"{time:.1f} s, {inside} of {run.sizes['person']} inside")
        self.mark.set_data([time], [inside])

    def _places(self, k: int, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Places between two samples, nan for those who left; others whom the next one lacks stay."""
        run, times = self.run, self.run.time.values
        last = min(k + 1, times.size - 1)
        share = (time - times[k]) / (times[last] - times[k]) if last > k else 0.0
        x, y = (v[k] + share * np.nan_to_num(v[last] - v[k]) for v in (run.x.values, run.y.values))
        gone = (self.left <= time) & ~((last > k) & np.isfinite(run.x.values[last]))
        return np.where(gone, np.nan, x), np.where(gone, np.nan, y)


def span(run: xr.Dataset) -> tuple[float, float]:
    """From the first sample to the end of the run, s."""
    return float(run.time[0]), max(float(run.time[-1]), float(run.end_time))


def _coloured(run: xr.Dataset, contacts: Contacts, colour: str) -> tuple[np.ndarray, float]:
    """What discs are coloured by, (samples, persons), and the top of its scale."""
    if colour == "speed":
        values = speeds(run)
        return values, common_top(values, 0.1)
    remedy = "record with contacts and record full, or choose speed"
    require(contacts.force is not None, "colour", "'force'", "needs contact forces, which this run lacks", remedy)
    values = force_on_each(contacts, run.sizes["person"])
    return values, common_top(values, 100.0)
