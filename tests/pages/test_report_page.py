"""The page that reports a sweep: every run counted where it belongs."""

import html
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from sweep import Grid, Store, gather, open_results, sweep
from sweep.gridfile import read_gridfile
from sweep.pages import report_page
from sweep.pages.cells import cells_of
from sweep.pages.svg import ticks
from sweep.pages.words import spoken_units
from tests.pages.browser import Browser

TINY = {"N": 4, "size": 4.0}


def planted(outcomes: list[list[int]], exit_times: list[list[list[float]]]) -> xr.Dataset:
    """Two speeds, three seeds, three persons."""
    times = np.array(exit_times)
    return xr.Dataset(
        {
            "exit_time": (("v_d", "seed", "exit"), times),
            "outcome": (("v_d", "seed"), np.array(outcomes, dtype=np.int8)),
            "persons": (("v_d", "seed"), np.where(np.array(outcomes) == 0, 0, 3)),
            "N_out": (("v_d", "seed"), np.isfinite(times).sum(axis=-1)),
        },
        {"v_d": [1.0, 2.0], "seed": [0, 1, 2], "exit": [1, 2, 3]},
    )


@pytest.fixture
def mixed() -> xr.Dataset:
    """At 1 m/s out after 10, 20 and 40 s; at 2 m/s one out after 8 s, one blocked, one missing."""
    nan = np.nan
    slow = [[1, 2, 10.0], [1, 2, 20.0], [1, 2, 40.0]]
    return planted([[1, 1, 1], [1, 2, 0]], [slow, [[1, 2, 8.0], [1, nan, nan], [nan, nan, nan]]])


@pytest.fixture
def store(tmp_path: Path) -> Store:
    swept = Store(tmp_path / "results")
    sweep(Grid("lin_room", v_d=[1.0, 1.4], seed=range(2), **TINY), store=swept.path, jobs=1)
    return swept


def text_of(page: str) -> str:
    return html.unescape(re.sub(r"<[^>]+>", " ", page.split("<body>")[1].split("<script")[0]))


def test_a_blocked_run_has_no_clearance_time_and_is_counted(mixed: xr.Dataset) -> None:
    slow, fast = cells_of(mixed)
    assert slow.clearance == (10.0, 15.0, 20.0, 30.0, 40.0)
    assert fast.clearance == (8.0,) * 5
    assert fast.share_out == pytest.approx((1 / 3, 0.5, 2 / 3, 5 / 6, 1.0))
    assert (fast.runs, fast.counts["all_out"], fast.counts["blocked"], fast.counts["missing"]) == (2, 1, 1, 1)


def test_the_page_says_how_many_runs_a_median_stands_for(mixed: xr.Dataset, tmp_path: Path) -> None:
    page = report_page(mixed, Store(tmp_path))
    said = re.sub(r"\s+(?=[,.])", "", " ".join(text_of(page).split()))
    assert "5 of 6 runs done: 4 all out, 1 blocked, 1 missing." in said
    assert re.findall(r">(\d/\d)<", page) == ["1/2"]
    assert "median 8 s, quartiles 8 to 8, range 8 to 8; 1 all out, 1 blocked, 1 missing" in html.unescape(page)


def test_a_sweep_reports_itself(store: Store) -> None:
    (store.runs / f"{next(iter(store.finished()))}.nc").unlink()
    grid = Grid("lin_room", v_d=[1.0, 1.4], seed=range(2), **TINY)
    gather(grid, store)
    store.note_failure(
        "0" * 64, "ValueError: <so> it went\n\nagain: jamsweep run x\n\nparameters: v_d = 1.4\n\nTraceback"
    )
    page = report_page(open_results(store.path), store)
    said = " ".join(text_of(page).split())
    assert "3 of 4 runs done" in said
    assert "v_d = 1.4 : ValueError: <so> it went jamsweep run x" in said
    assert "<so>" not in page
    assert 'store = "results"' in said
    assert re.findall(r"""\b(?:src|href)\s*=|url\(|https?://""", page) == []


def test_what_the_page_says_how_to_run_runs_the_same_grid(store: Store, tmp_path: Path) -> None:
    own = Grid("lin_room", seed=range(2), common_random_numbers=False, v_d=1.2, **TINY)
    for grid in (Grid.from_json(store.grid.read_text()), own):
        page = report_page(sweep(grid, store=store.path, jobs=1), store)
        file = tmp_path / "grid.toml"
        file.write_text(html.unescape(page.split("<pre>")[1].split("</pre>")[0]))
        described = read_gridfile(file)
        assert (described.grid.to_json(), described.store) == (grid.to_json(), "results")


def test_a_single_run_and_many_axes_have_pages(tmp_path: Path) -> None:
    for axes in (
        {},
        {"accuracy": ["2%", "1mm"]},
        {"v_d": [1.0, 1.4], "L": [1.0, 1.2], "tau": [0.4, 0.5], "seed": [1, 2]},
    ):
        swept = tmp_path / str(len(axes))
        ds = sweep(Grid("lin_room", **axes, **TINY, time_limit=0.5), store=swept, jobs=1)
        page = report_page(ds, Store(swept))
        assert page.count('class="outcomes"') == (2 if "tau" in axes else 1)
        assert "nan" not in " ".join(re.findall(r'(?:points|x1|y1|cx|cy)="([^"]*)"', page))


def test_the_page_opens_in_a_browser_and_nothing_complains(browser: Browser, mixed: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    path.write_text(report_page(mixed, Store(tmp_path)), "utf-8")
    browser.errors.clear()
    browser.open(path, "document.readyState === 'complete' && document.documentElement.dataset.theme")
    before = browser.value("getComputedStyle(document.body).backgroundColor")
    browser.value("document.getElementById('theme').click()")
    assert browser.value("getComputedStyle(document.body).backgroundColor") != before
    assert browser.value("document.querySelectorAll('svg.chart .series circle').length") == 4
    assert browser.errors == []


def test_units_are_spoken_as_readers_have_them() -> None:
    spoken = [spoken_units(units) for units in ("m s-1", "kg m-1 s-1", "m2", "s-1", "1")]
    assert spoken == ["m/s", "kg/(m s)", "m2", "1/s", "1"]


def test_ticks_are_round_and_reach_the_top() -> None:
    assert ticks(1.0) == [0, 0.2, 0.4, 0.6, 0.8, 1.0]
    assert ticks(473.0) == [0, 100, 200, 300, 400]
