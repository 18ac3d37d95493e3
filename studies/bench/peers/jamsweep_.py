"""The engine of this repository: Lin's model with the paper's numerics."""

import time
from collections.abc import Callable

from engine import Crowd, Model, Options, Scenario, Scene, models, simulate
from engine.rooms import LIN_2016
from engine.scene import Exit
from studies.bench.packing import V_D, Packing
from studies.bench.peers import Peer, Sample, Timing

FIRST, LAST = 0.05, 0.55  # s; the difference of two runs, so that set-up drops out
BEHIND = 1.0  # m; the exit lies behind the wall: the whole hall walks towards it and nobody gets out


def scenario(packing: Packing, until: float, model: Model | None = None) -> Scenario:
    """The jam up to a time, s; Lin's model with all defaults if none is given."""
    scene = Scene.box(packing.depth, packing.width)
    x = packing.depth + BEHIND
    beyond = Exit((x, 0.0), (x, packing.width), (1.0, 0.0))
    state = (packing.x, packing.y, packing.vx, packing.vy, 0.0)
    return Scenario(
        scene=Scene(scene.walls, (beyond,)),
        crowd=Crowd.given(*state, radius=packing.radius, mass=packing.mass, v_d=V_D),
        model=model or models.lin_dem(),
        options=Options(numerics="paper", blocked_after=1e6, time_limit=until),
        paper=LIN_2016,
    )


def preparing(model: Model | None = None) -> Callable[[Packing], tuple[Sample, str]]:
    """What prepares a sample with this model."""

    def prepare(packing: Packing) -> tuple[Sample, str]:
        """Compile, and check that both runs go their whole length."""
        short, long = scenario(packing, FIRST, model), scenario(packing, LAST, model)
        _timed(short)

        def sample() -> Timing:
            before, steps_before, rebuilds_before = _timed(short)
            after, steps, rebuilds = _timed(long)
            return Timing(after - before, steps - steps_before, long.numerics.dt, rebuilds - rebuilds_before)

        return sample, "skin adapted along the run (its default, not tuned)"

    return prepare


def _timed(case: Scenario) -> tuple[float, int, int]:
    start = time.process_time()
    run = simulate(case)
    seconds = time.process_time() - start
    if run.outcome != "time_limit":
        raise RuntimeError(f"the jam did not last: {run}")
    return seconds, run.steps, run.rebuilds


PEER = Peer("jamsweep", "Lin et al. (2016), defaults", ("jamsweep",), preparing())
