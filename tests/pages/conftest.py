"""A small run that jams, one that ends, and a browser to look at their pages with."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr

from engine import rooms, simulate
from sweep import to_dataset
from sweep.pages import player_page
from tests.pages.browser import Browser, found

RECORDED = {"record_every": 0.1, "contacts": True}


@pytest.fixture(scope="session")
def jam() -> xr.Dataset:
    """Fifty persons at 2.5 m/s: arches form and break."""
    return to_dataset(simulate(rooms.lin_room(v_d=2.5, N=50, seed=2, size=7.0, time_limit=12.0, **RECORDED)))


@pytest.fixture(scope="session")
def walking_on() -> xr.Dataset:
    """The same crowd, who are felt for another metre beyond the door."""
    scenario = rooms.lin_room(v_d=2.5, N=50, seed=2, size=7.0, time_limit=12.0, **RECORDED)
    return to_dataset(simulate(replace(scenario, scene=rooms.square_room(7.0, 1.0, walk_on=1.0))))


@pytest.fixture(scope="session")
def walk() -> xr.Dataset:
    """Twelve persons who all get out; positions alone, no contacts."""
    return to_dataset(simulate(rooms.lin_room(v_d=1.0, N=12, seed=1, size=5.0, record_every=0.1, record="positions")))


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    program = found()
    if program is None:
        pytest.skip("no Chromium on this machine: apt-get install chromium")
    with Browser(program, tmp_path_factory.mktemp("profile")) as page:
        yield page


@pytest.fixture
def show(browser: Browser, tmp_path: Path) -> Callable[[xr.Dataset], Browser]:
    """Opens the page of a run, and has it stand at its beginning."""

    def opened(run: xr.Dataset) -> Browser:
        path = tmp_path / "run.html"
        path.write_text(player_page(run), "utf-8")
        browser.errors.clear()
        browser.requests.clear()
        browser.open(path, "window.player && player.state().frames")
        browser.value("player.play(false), player.seek(0)")
        return browser

    return opened


@pytest.fixture
def playing(show: Callable[[xr.Dataset], Browser], jam: xr.Dataset) -> Browser:
    """The browser with the page of the jam, standing at its beginning."""
    return show(jam)
