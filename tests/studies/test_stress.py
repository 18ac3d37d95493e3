"""What the stress run would say of an engine that breaks its promises, and of workers that hang or crash."""

import math
import os
import time
from dataclasses import replace

import numpy as np
import pytest

from engine import Crowd, Options, Scenario, Scene, scenario, simulate
from engine.scenario import step_limit
from studies.stress import __main__ as command
from studies.stress import energy, families, judge, kinds, tasks
from studies.stress.checks import check
from studies.stress.judge import Case
from studies.stress.random_scenes import RandomScenes, at_share, random_scenario
from studies.stress.workers import Crashed, Hung, answers

KIND = ("lin_dem (kept, kinetic)", "velocity_verlet")
PASSIVE = kinds.passive(kinds.MODELS[KIND[0]])
BOX = Scene.box(4.0, 4.0)


def colliding(scene=BOX, model=PASSIVE, share=0.5, spin=0.0):
    """Three persons who run into each other and into walls, every step sampled."""
    crowd = Crowd.given([1.0, 2.0, 3.0], [2.0, 2.1, 2.0], [1.5, 0.0, -1.5], [0.3, 1.0, 0.0], spin, 0.3, 70.0, 0.0)
    return at_share(scene, crowd, model, KIND[1], share, 1.0)


def judged(run):
    return check(run, step_limit(run.scenario)[0]).violations


def altered(run, **arrays):
    """The run with some of its samples changed by functions of an array (M, N)."""
    changed = {name: change(getattr(run.samples, name).copy()) for name, change in arrays.items()}
    return replace(run, samples=run.samples._replace(**changed))


def at_the_end(value):
    def change(values):
        values[-1, 0] = value
        return values

    return change


def test_a_sound_run_breaks_nothing():
    run = simulate(colliding())
    assert run.max_overlap > 0.01
    assert judged(run) == []
    assert 0.0 < check(run, step_limit(run.scenario)[0]).rise < 1.0


@pytest.mark.parametrize(
    ("plant", "said"),
    [
        (lambda run: altered(run, x=at_the_end(-0.5)), "went through wall"),
        (lambda run: altered(run, x=at_the_end(math.nan)), "partly nan"),
        (lambda run: altered(run, x=lambda x: x * 0 + x[:, [1, 1, 2]]), "was not called unstable"),
        (lambda run: altered(run, vx=lambda vx: vx * 1.5 ** np.arange(len(vx))[:, None]), "energy"),
        (lambda run: replace(run, max_overlap=0.0), "beyond max_overlap"),
        (lambda run: replace(run, max_speed=math.inf), "max_speed is not finite"),
        (lambda run: replace(run, outcome="all_out"), "does not hold"),
        (lambda run: replace(run, outcome="unstable"), "does not hold"),
    ],
)
def test_what_is_broken_is_said(plant, said):
    assert any(said in line for line in judged(plant(simulate(colliding()))))


def test_who_is_nan_without_having_left_or_comes_back_is_said():
    def gone(values):
        values[5:9, 0] = math.nan
        return values

    said = judged(altered(simulate(colliding()), **dict.fromkeys(("x", "y", "vx", "vy", "spin"), gone)))
    assert "somebody is nan without having left" in said
    assert "somebody who was gone came back" in said


def test_leaving_beside_the_exit_or_twice_is_said():
    run = simulate(families.cases("places")[0].build())
    assert run.outcome == "all_out"
    assert judged(run) == []
    assert "somebody left beside exit 0" in judged(replace(run, exit_y=run.exit_y + 3.0))
    assert any("twice" in line for line in judged(replace(run, exit_person=np.zeros(2, int))))


def test_momentum_that_is_lost_is_said():
    run = simulate(colliding(Scene()))
    assert judged(run) == []
    assert any(
        "momentum" in line for line in judged(altered(run, vy=lambda vy: vy + 1e-6 * (np.arange(len(vy)) > 5)[:, None]))
    )


def test_a_step_far_beyond_the_limit_is_cut_instead_of_heating_the_crowd(monkeypatch):
    """The check before the run is put aside, and the step is four times the longest."""
    run = simulate(colliding(model=kinds.lossless(PASSIVE)))
    dt = 4.0 * step_limit(run.scenario)[0]
    monkeypatch.setattr(scenario, "step_limit", lambda tried: (math.inf, ""))
    cut = simulate(run.scenario, dt=dt, record_every=dt, contacts=True, time_limit=40 * dt)
    assert cut.outcome == "time_limit"
    assert cut.substepped_steps > 0
    assert check(cut, dt).violations == []
    heated = altered(cut, vx=lambda vx: vx * np.linspace(1.0, 2.0, len(vx))[:, None])
    assert any("energy" in line for line in check(heated, dt).violations)


@pytest.mark.parametrize("spin", [0.0, 4.0])
def test_the_ledger_counts_what_the_engine_exchanges(spin):
    """Kinetic energy, contacts, social force and springs change by far more than their sum does."""
    ledger = energy.ledger(
        simulate(colliding(model=kinds.with_values(PASSIVE, {"mu": 50.0, "g_n": 0, "g_t": 0}), share=0.02, spin=spin))
    )
    for part in (ledger.kinetic, ledger.pressed, ledger.social, ledger.sheared):
        assert np.ptp(part) > 10 * np.ptp(ledger.total)


def test_an_exception_is_named_and_a_refusal_must_be_one_line():
    def broken():
        raise ZeroDivisionError("by nothing")

    def refused():
        return Crowd.uniform(0, (0.0, 1.0, 0.0, 1.0))

    assert judge.judge(Case(KIND, "", broken)) == judge.Judgement("failed", ("ZeroDivisionError: by nothing",))
    assert judge.judge(Case(KIND, "", refused, True)).violations == ()
    assert "was refused" in judge.judge(Case(KIND, "", refused)).violations[0]
    assert "names dt" in judge.judge(Case(KIND, "", refused, True, "dt")).violations[0]


def test_running_what_should_be_refused_and_another_outcome_than_wanted_are_said():
    assert judge.judge(Case(KIND, "", colliding, True)).violations == ("was not refused",)
    assert "should have been all_out" in judge.judge(Case(KIND, "", colliding, wanted=("all_out",))).violations[0]


def test_an_unstable_run_is_noted_with_its_cause():
    def too_soft():
        crowd = Crowd.given([1.0], [2.0], 50.0, 0.0, 0.0, 0.3, 70.0, 0.0)
        return Scenario(BOX, crowd, PASSIVE, Options(time_limit=0.1))

    assert judge.judge(Case(KIND, "", too_soft)).note.endswith(judge.SOFT)


def test_a_scene_follows_from_its_number():
    first, again, other = (random_scenario(n, KIND).canonical() for n in (3, 3, 4))
    assert first == again != other
    assert len(RandomScenes(7)) == len(list(RandomScenes(7))) == 7


def test_workers_that_hang_or_crash_are_named_and_the_others_go_on():
    begin = time.monotonic()
    slept = dict(answers(time.sleep, [60.0, 0.01, 0.02], 2, 3.0))
    assert slept == {60.0: Hung(3.0), 0.01: None, 0.02: None}
    assert time.monotonic() - begin < 30.0
    assert dict(answers(os._exit, [3, 5], 1, 30.0)) == {3: Crashed(3), 5: Crashed(5)}


def test_every_family_has_its_cases_for_every_kind():
    for family in families.FAMILIES:
        assert {case.kind for case in families.cases(family)} == set(kinds.KINDS)
    quick = list(tasks.quick_tasks())
    assert {model for model, _ in kinds.FEW} == set(kinds.MODELS)
    assert len(quick) < len(list(tasks.all_tasks())) / 10


@pytest.fixture
def small(monkeypatch, tmp_path):
    """Four cases, in this process; the table goes to a folder of its own."""
    chosen = [("places", 0), ("places", 5), ("steps", 2), ("random", 12)]
    monkeypatch.setattr(command, "quick_tasks", lambda: chosen)
    monkeypatch.setattr(command, "FOLDER", tmp_path)
    monkeypatch.setattr(command, "PAGE", tmp_path / "stress.md")
    return tmp_path


def test_a_small_form_of_it_finds_nothing_and_writes_the_page(small, capsys):
    assert command.main(["--quick", "--jobs", "0", "--docs"]) == 0
    said = capsys.readouterr().out
    assert "| places | 2 | 1 all_out, 1 refused |" in said
    assert "runs that break an invariant: 0 (goal 0: met)" in said
    assert "python -m studies.stress --quick" in (small / "stress.md").read_text("utf-8")


def test_a_planted_violation_is_reported_with_its_command_and_makes_the_exit_code_1(small, capsys, monkeypatch):
    def through_the_wall(tried):
        return altered(simulate(tried), x=lambda x: np.where(np.arange(len(x))[:, None] < 3, x, -1.0))

    monkeypatch.setattr(judge, "simulate", through_the_wall)
    assert command.main(["--quick", "--jobs", "0"]) == 1
    said = capsys.readouterr().out
    assert "(goal 0: NOT met)" in said
    assert "went through wall" in said
    assert "`python -m studies.stress --scene places:0`" in said
    assert command.main(["--scene", "places:0"]) == 1
    assert "went through wall" in capsys.readouterr().out


@pytest.mark.parametrize("scene", ["places:9999", "nowhere:1", "10000", "-1", "x"])
def test_a_case_that_is_not_there_is_refused(scene, capsys):
    with pytest.raises(SystemExit):
        command.main([f"--scene={scene}"])
    assert "argument --scene" in capsys.readouterr().err
