"""`jamsweep view` and `jamsweep report`: a run that plays, and a sweep that reports itself, as pages."""

import math
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

import click

from engine.errors import BadInput, require
from sweep.errors import DamagedFile
from sweep.storage.durable import replace_durably, require_target
from sweep.storage.store import Store

if TYPE_CHECKING:
    import xarray as xr

SMOOTH = 3000  # samples that a page holds, at most, where nothing else is said
path_type = click.Path(dir_okay=False, path_type=Path)
open_option = click.option("--open", "show", is_flag=True, help="Open the page in a browser.")


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=path_type, help="Page to write; FILE with the ending .html if not given.")
@open_option
@click.option("--every", type=int, help=f"Show each sample of so many; if not given, at most {SMOOTH} samples.")
@click.option("--mp4", type=path_type, help="Write a film there instead of a page (needs ffmpeg).")
@click.option("--gif", type=path_type, help="Write a film there instead of a page.")
@click.option("--rate", type=float, default=4.0, show_default=True, help="Seconds of the run in one of a film.")
@click.option("--colour", type=click.Choice(["speed", "force"]), default="speed", help="Colour of a film.")
def view(
    file: Path,
    output: Path | None,
    show: bool,
    every: int | None,
    mp4: Path | None,
    gif: Path | None,
    rate: float,
    colour: str,
) -> None:
    """Make a page that plays the run in FILE, in any browser and without a network.

    \b
    jamsweep run lin_room --v-d 1.6 --record-every 0.1 --contacts -o run.nc
    jamsweep view run.nc --open
    jamsweep view run.nc --mp4 run.mp4
    """  # noqa: D301  click reads \b as a character
    from sweep.pages import player_page, write_film  # what needs xarray stands in the functions: --help answers at once

    run = _run_in(file)
    films = [film for film in (mp4, gif) if film is not None]
    for film, ending in ((mp4, ".mp4"), (gif, ".gif")):
        right = film is None or film.suffix.lower() == ending
        require(right, "film", f"'{film}'", f"does not end in {ending}", "name it so")
    for film in films:
        require_target(film)
        write_film(run, film, rate, colour)
        click.echo(str(film))
    if output or show or not films:
        _write_page(player_page(run, _stride(run, every)), output or file.with_suffix(".html"), show)


@click.command()
@click.argument("store", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=path_type, help="Page to write; report.html in STORE if not given.")
@open_option
def report(store: Path, output: Path | None, show: bool) -> None:
    """Make a page of the sweep gathered in STORE: grid, outcomes, figures, failures, provenance.

    \b
    jamsweep report results/mine -o mine.html
    """  # noqa: D301  click reads \b as a character
    from sweep import open_results
    from sweep.pages import report_page

    kept = Store(store)
    _write_page(report_page(open_results(kept.path), kept), output or kept.path / "report.html", show)


def _run_in(file: Path) -> "xr.Dataset":
    """The run in a file, as a bad input if it cannot be read."""
    from sweep import read_run
    from sweep.pages.motion import check_playable

    try:
        run = read_run(file)
        check_playable(run, str(file))
    except DamagedFile as error:
        raise BadInput(str(error)) from None
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        if isinstance(error, BadInput):
            raise
        remedy = "name a file that `jamsweep run ... -o` wrote, or run it again"
        raise BadInput(f"run file '{file}' is damaged or holds no run: {remedy}") from None
    return run


def _stride(run: "xr.Dataset", every: int | None) -> int:
    if every is None:
        stride = math.ceil(run.sizes["sample"] / SMOOTH)
        if stride > 1:
            click.echo(f"the page shows each of {stride} samples (--every 1 for all)", err=True)
        return stride
    require(every >= 1, "every", every, "is not a whole number above 0", "show each sample of so many")
    return every


def _write_page(text: str, path: Path, show: bool) -> None:
    require_target(path)
    replace_durably(path, lambda temporary: temporary.write_text(text, "utf-8"))
    click.echo(str(path))
    if show:
        webbrowser.open(path.absolute().as_uri())
