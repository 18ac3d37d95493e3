"""CPU times, and the jams that are timed."""

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from statistics import median
from typing import Any

import numpy as np
from joblib import Parallel, delayed, parallel_config

from engine import Crowd, Run, Scenario, simulate
from studies.precision.settings import Setting, setting_of, under

LONG = 1.0  # s of CPU time that are not measured again


def timed(scenario: Scenario) -> tuple[float, Run]:
    """CPU time of a run, s, and the run; the kernel must have been compiled."""
    begin = time.process_time()
    run = simulate(scenario)
    return time.process_time() - begin, run


def pace(scenario: Scenario, stretch: float, repeats: int = 3) -> float:
    """CPU seconds per simulated second over the first `stretch` s: the median of repeats, of one if it is long."""
    short = scenario.with_options(blocked_after=stretch, time_limit=stretch)
    compile_kernel(scenario)
    found: list[float] = []
    while len(found) < repeats and max(found, default=0.0) < LONG:
        spent, run = timed(short)
        found.append(spent)
    return median(found) / run.end_time


def compile_kernel(scenario: Scenario) -> None:
    """Run one step, so that the kernel is at hand."""
    simulate(scenario, time_limit=scenario.numerics.dt)


def compile_all(scenario: Scenario, settings: Iterable[Setting]) -> None:
    """Compile the kernels of a model for all integrators of some settings."""
    for setting in {setting.integrator: setting for setting in settings}.values():
        compile_kernel(under(setting, scenario))


def at(scenario: Scenario, when: float, inside: int | None = None) -> Scenario:
    """The scenario begun anew with those inside at a time, s, from rest of the springs, by the same numerics.

    Parameters
    ----------
    inside : begin at the first of ten equally spaced times up to `when` at which not more persons were inside
    """
    every = when if inside is None else when / 10
    run = simulate(scenario, time_limit=when, record_every=every)
    assert run.samples is not None
    counts = [run.N - int(np.sum(run.exit_time <= t)) for t in run.samples.time]
    k = len(counts) - 1 if inside is None else next((i for i, n in enumerate(counts) if n <= inside), len(counts) - 1)
    here = np.ones(run.N, bool)
    here[run.exit_person[run.exit_time <= run.samples.time[k]]] = False
    x, y, vx, vy, spin = (getattr(run.samples, name)[k, here] for name in ("x", "y", "vx", "vy", "spin"))
    bodies = (getattr(run.start, name)[here] for name in ("radius", "mass", "v_d"))
    return replace(under(setting_of(scenario), scenario), crowd=Crowd.given(x, y, vx, vy, spin, *bodies))


def spread(work: Callable[..., Any], tasks: Iterable[tuple[Any, ...]], jobs: int) -> list[Any]:
    """`work(*task)` for every task, in the order of the tasks, in worker processes if there are jobs for them."""
    if jobs == 1:
        return [work(*task) for task in tasks]
    with parallel_config("loky", inner_max_num_threads=1):
        found: list[Any] = Parallel(n_jobs=jobs, batch_size=1)(delayed(work)(*task) for task in tasks)
        return found
