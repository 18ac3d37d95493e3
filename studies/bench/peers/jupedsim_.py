"""JuPedSim's social force model (Helbing et al. 2000), with its own default parameters and step.

Everybody is steered straight at the wall ahead, which spares JuPedSim its search for a way.
"""

import time
from importlib import import_module
from typing import Any

from studies.bench.packing import V_D, Packing
from studies.bench.peers import Peer, Sample, Timing

WARM_UP, STEPS, FEWEST = 1, 50, 4  # steps
BUDGET = 1_000_000  # person-steps in one sample
FROM_WALL = 0.01  # m; a target has to lie inside


def prepare(packing: Packing) -> tuple[Sample, str]:
    """Find how many steps the crowd stays in the hall."""
    wanted = WARM_UP + max(min(STEPS, BUDGET // packing.N), FEWEST)
    steps = _lasts(packing, wanted) - WARM_UP
    if steps < 1:
        raise RuntimeError("its crowd leaves the hall in the first steps")
    lost = f"its crowd bursts out of the hall in step {WARM_UP + steps + 1}, timed up to there"

    def sample() -> Timing:
        simulation = _simulation(packing)
        simulation.iterate(WARM_UP)
        start = time.process_time()
        simulation.iterate(steps)
        return Timing(time.process_time() - start, steps, simulation.delta_time())

    return sample, "default parameters and step" + (f"; {lost}" if WARM_UP + steps < wanted else "")


def _lasts(packing: Packing, wanted: int) -> int:
    """Steps, at most `wanted`, before somebody is pushed through a wall (JuPedSim stops with an error)."""
    simulation = _simulation(packing)
    for step in range(wanted):
        try:
            simulation.iterate()
        except RuntimeError:
            return step
    return wanted


def _simulation(packing: Packing) -> Any:
    jps = import_module("jupedsim")
    corners = [(0, 0), (packing.depth, 0), (packing.depth, packing.width), (0, packing.width)]
    simulation = jps.Simulation(model=jps.SocialForceModel(), geometry=corners)
    stage = simulation.add_direct_steering_stage()
    journey = simulation.add_journey(jps.JourneyDescription([stage]))
    persons = zip(packing.x, packing.y, packing.vx, packing.vy, packing.radius, packing.mass, strict=True)
    for x, y, vx, vy, radius, mass in persons:
        person = jps.SocialForceModelAgentParameters(
            position=(x, y),
            velocity=(vx, vy),
            orientation=(1.0, 0.0),
            radius=radius,
            mass=mass,
            desired_speed=V_D,
            journey_id=journey,
            stage_id=stage,
        )
        agent = simulation.agent(simulation.add_agent(person))
        agent.target = (packing.depth - FROM_WALL, y)
    return simulation


PEER = Peer("jupedsim", "its SocialForceModel", ("jupedsim",), prepare)
