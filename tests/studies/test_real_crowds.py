"""The study of real crowds on made-up files: its numbers are those of the files, its gate is scaled by bodies."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from engine import BadInput
from studies import real_crowds
from studies.presentation import figures
from sweep.imports import crossings, read_trajectories
from tests.imports.crowd_files import walkers, written

SLOW, FAST = 1.0 + 0.8 * np.arange(20), 1.0 + 0.5 * np.arange(20)  # s


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    written(tmp_path / "slow.txt", walkers(SLOW))
    written(tmp_path / "fast.txt", walkers(FAST))
    (tmp_path / "README.md").write_text("no trajectories\n")
    return tmp_path


def planted(folder: Path) -> dict:
    """Runs in place of simulated ones: two seeds of one cell, and three of one of whom the last did not finish."""
    rng = np.random.default_rng(1)
    crowds = {}
    for name, seeds in (("Lin, 1 m/s", 2), ("Parisi, 2 m/s", 3)):
        runs = []
        for seed in range(seeds):
            path = written(folder / "planted", walkers(1.0 + np.cumsum(rng.exponential(0.7, 20))))
            ds = crossings(read_trajectories(path, form="text"), real_crowds.LINE, real_crowds.TOWARDS)
            runs.append(ds.expand_dims(seed=[seed]))
        ds = xr.concat(runs, "seed", data_vars="all")
        crowds[name] = ds.assign_coords(v_d=float(name.split()[1]))
    last = crowds["Parisi, 2 m/s"]
    words = last.outcome.attrs["flag_meanings"].split()
    shut = np.array([words.index("all_out")] * 2 + [words.index("blocked")])
    gone = (last.seed == 2) & (last.exit > 15)
    crowds["Parisi, 2 m/s"] = last.assign(
        outcome=last.outcome.copy(data=shut),
        exit_time=last.exit_time.where(~gone),
        N_out=last.N_out.where(last.seed != 2, 15),
    )
    return crowds


def test_flow_and_gaps_are_those_of_the_file(folder: Path) -> None:
    found = real_crowds.measure(real_crowds.experiments(folder))
    for name, step in (("slow", 0.8), ("fast", 0.5)):
        one = found.sel(crowd=name)
        assert float(one.flow) == pytest.approx(1.0 / step, rel=1e-3)
        assert float(one.median_gap) == pytest.approx(step, rel=1e-3)
        assert float(one.gap_95) == pytest.approx(step, rel=1e-3)
        assert one.delay_survival.sel(time=step - 0.1, method="nearest") == 1.0
        assert one.delay_survival.sel(time=step + 0.1, method="nearest") == 0.0
        assert np.isnan(one.flow_low)  # one run has no interval over runs
    assert found.delay_survival_over_mean.sel(over_mean=0.9, method="nearest").values.tolist() == [1.0, 1.0]


def test_flow_and_gaps_are_those_of_pedpy(tmp_path: Path) -> None:
    pedpy = pytest.importorskip("pedpy", reason="PedPy is not installed: pip install '.[pedpy]'")
    waits = np.random.default_rng(8).uniform(0.6, 1.6, 75)
    path = written(tmp_path / "crowd.txt", walkers(1.0 + np.cumsum(waits)))
    one = real_crowds.measure(real_crowds.experiments(tmp_path)).sel(crowd="crowd")
    trajectories = pedpy.load_trajectory_from_txt(trajectory_file=path)
    _, frames = pedpy.compute_n_t(traj_data=trajectories, measurement_line=pedpy.MeasurementLine(real_crowds.LINE))
    theirs = np.sort(frames.frame.to_numpy()) / trajectories.frame_rate
    gaps = np.diff(theirs)
    assert float(one.flow) == pytest.approx(gaps.size / (theirs[-1] - theirs[0]), rel=0.02)
    assert float(one.median_gap) == pytest.approx(np.median(gaps), rel=0.02)
    assert float(one.gap_95) == pytest.approx(np.quantile(gaps, 0.95), rel=0.02)


def test_the_gate_is_as_wide_in_bodies_as_the_real_one() -> None:
    for room, disc in real_crowds.DISC.items():
        grid = real_crowds.grid(room, quick=True)
        scenario = grid.scenario(next(iter(grid.points())))
        crowd, (door,) = scenario.crowd, scenario.scene.exits
        assert sum(crowd.radius) == pytest.approx(disc)
        assert door.width / disc == pytest.approx(real_crowds.GATE / real_crowds.BODY)
        assert crowd.area[1] / disc == pytest.approx(real_crowds.CORRIDOR / real_crowds.BODY)
        assert crowd.N == 75


def test_figure_and_table_have_every_crowd(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    crowds = planted(tmp_path)
    monkeypatch.setattr(real_crowds, "FOLDER", tmp_path / "results")
    monkeypatch.setattr(real_crowds, "simulated", lambda quick, jobs: crowds)
    real_crowds.main(data=str(folder))
    said = {line.split("  ")[0]: line.split() for line in capsys.readouterr().out.splitlines() if line}
    assert set(said) >= {"slow", "fast", *crowds}
    assert said["slow"][1:8] == ["1", "0", "20", "of", "20", "1.25", "0.80"]
    assert said["Parisi, 2 m/s"][3:8] == ["3", "1", "55", "of", "60"]  # one of three runs did not finish
    assert (tmp_path / "results" / "figure.png").is_file()

    with mpl.rc_context(figures.STYLE):
        mpl.use("agg")
        figure = real_crowds.plot(real_crowds.measure(real_crowds.experiments(folder) | crowds))
    curves = [line for line in figure.axes[0].lines if len(line.get_xdata())]
    assert len(curves) == 2 + 2 + 3 + 1  # each run, and a cross where one ended with persons inside
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["fast", "slow", *crowds, "ended with persons inside"]
    assert "1 m for discs of 0.6 m" in figure.get_suptitle()


def test_without_data_there_is_one_line_that_says_so(tmp_path: Path, folder: Path) -> None:
    for data, complaint in (
        ("", "say make study-real-crowds DATA=folder"),
        (str(tmp_path / "none"), "is no folder"),
        (str(tmp_path / "bare"), "holds no trajectories"),
    ):
        (tmp_path / "bare").mkdir(exist_ok=True)
        with pytest.raises(BadInput, match=complaint) as caught:
            real_crowds.main(data=data)
        assert "\n" not in str(caught.value)
    with pytest.raises(BadInput, match=r"have 0 crossings of .* give --line and --towards"):
        real_crowds.main(data=str(folder), line=((50.0, 0.0), (60.0, 0.0)))
