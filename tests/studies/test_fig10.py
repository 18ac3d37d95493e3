"""The study of Figure 10 on planted data: verdicts can be yes, no and open, and the figure shows what there is."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from studies.lin import fig10
from studies.presentation import figures
from studies.presentation.verdicts import Verdict, table
from tests.measures.planted import PAPER_BLOCKING, column, rising_to


def planted(blocking=PAPER_BLOCKING, seeds=10, scale=1.0, **flow):
    """Columns over v_d of three N; `persons` and the time scale are those of the paper's room."""
    columns = []
    for k, N in enumerate((100, 200, 300)):
        ds = column(rising_to(1.0, **flow), blocking, seeds=seeds, root=k).isel(copy=0, drop=True)
        longer = {name: ds[name] * (N / 4 * scale) for name in ("exit_time", "end_time")}
        columns.append(ds.assign(longer).assign(persons=xr.full_like(ds.persons, N)).expand_dims(N=[N]))
    ds = xr.concat(columns, "N", coords="minimal", compat="override")
    ds.outcome.attrs = columns[0].outcome.attrs
    return ds


def verdict(found, words):
    (one,) = [v for v in fig10.verdicts(found) if v.statement.startswith(words)]
    return one


@pytest.fixture(scope="module")
def as_published():
    return fig10.classified(planted(plateau=0.9))


def test_planted_runs_like_the_papers_are_found_to_be_so(as_published):
    for words in ("clearance time, N = 200, v_d = 0.6", "flow rises up to 1.0 m/s, N = 300", "no blocking up to 1.2"):
        assert verdict(as_published, words).holds is True, words
    for words in ("transition from, N = 200", "phase separation from, N = 200", "blocking appears"):
        assert verdict(as_published, words).holds is True, words


def test_planted_runs_unlike_the_papers_are_not():
    slow = fig10.classified(planted(scale=1.5))
    assert verdict(slow, "clearance time, N = 200, v_d = 1.0").holds is False
    early = fig10.classified(planted({1.0: 0.5, 1.2: 1.0, 1.4: 1.0, 1.6: 1.0, 1.8: 1.0, 2.0: 1.0}))
    assert verdict(early, "no blocking up to 1.2").holds is False
    assert verdict(early, "blocking appears").holds is False
    assert verdict(early, "clearance time, N = 200, v_d = 1.4").holds is False
    falling = fig10.classified(planted(least=1.2, plateau=0.9))
    assert verdict(falling, "flow rises up to 1.0 m/s, N = 100").holds is False


def test_three_seeds_leave_the_boundaries_open():
    found = fig10.classified(planted(seeds=3))
    assert verdict(found, "transition from, N = 200").holds is None
    assert "undecided" in verdict(found, "phase separation from, N = 200").found


def test_blocked_runs_do_not_enter_the_mean(as_published):
    cell = as_published.sel(N=200, v_d=1.8)
    assert 0 < cell.blocked < cell.runs
    assert cell.mean_flow > 0.7
    assert (cell.flow_of_run == 0).sum() == cell.blocked
    assert np.isnan(as_published.mean_flow.sel(N=200, v_d=2.0))


def test_the_figure_is_drawn_for_full_and_thin_grids(as_published, tmp_path):
    thin = as_published.sel(N=[100, 200], v_d=[0.6, 1.0, 1.4, 1.8])
    for name, found in (("full.png", as_published), ("thin.png", thin)):
        figures.draw(fig10.plot, found, tmp_path / name)
        assert (tmp_path / name).stat().st_size > 10_000
    with mpl.rc_context(figures.STYLE):
        figure = fig10.plot(as_published)
    assert [axis.get_title() for axis in figure.axes] == ["N = 100", "N = 200", "N = 300"]
    assert "v_d" in figure.axes[1].get_xlabel()
    shares = [text.get_text() for text in figure.axes[1].texts]
    blocked = as_published.blocked.sel(N=200)
    assert shares == [f"{int(k)}/10" for k in blocked.values if k]


def test_a_table_says_yes_no_and_open():
    rows = [Verdict("a", "1", "1", True), Verdict("b", "2", "3", False), Verdict("c", "4", "?", None)]
    assert [line.split()[-1] for line in table(rows).splitlines()[2:]] == ["yes", "NO", "open"]
