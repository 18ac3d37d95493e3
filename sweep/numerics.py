"""Whether the friction of a crowd depends on the time step it is computed with."""

from typing import NamedTuple

import joblib
import numpy as np
from numpy.typing import NDArray

from engine import Scenario, simulate
from engine.errors import require
from sweep.running.shipping import PackedScenario, packed, unpacked

Floats = NDArray[np.float64]
BETWEEN = ("persons", "persons and walls")
QUANTITIES = ("friction over normal force", "the same weighted by slip speed")
CONFIDENCE, RESAMPLES = 0.9, 4000
FINER = 4  # times shorter the step is that the default is compared with


class Comparison(NamedTuple):
    """Friction at the given step over that at a quarter of it, less 1.

    Attributes
    ----------
    between : str
        "persons" or "persons and walls".
    quantity : str
        Sum of abs(F_t) over that of abs(F_n) of all contacts and steps, plain or weighted by slip speed.
    coarse, fine : float
        At the given step, and at a quarter of it, 1.
    difference, low, high : float
        With its 90 % interval (runs resampled); nan where there were no contacts.
    """

    between: str
    quantity: str
    coarse: float
    fine: float
    difference: float
    low: float
    high: float

    def verdict(self, margin: float) -> str:
        """Whether the two are the same within the margin: "yes", "NO", "open" (more seeds decide) or "no contacts"."""
        if not np.isfinite(self.difference):
            return "no contacts"
        if -margin <= self.low and self.high <= margin:
            return "yes"
        return "NO" if self.low > margin or self.high < -margin else "open"


def compare_steps(scenarios: list[Scenario], jobs: int = 2) -> list[Comparison]:
    """Run scenarios at their step and at a quarter of it, and compare the friction of their contacts.

    The scenarios are those of one room with different seeds. The runs at the shorter step are of the same seeds, which
    decide nothing in a jam: the two sets count as independent.

    Parameters
    ----------
    scenarios : list of Scenario
        At least 2.
    jobs : int
        Worker processes.

    Raises
    ------
    BadInput
        If there are fewer than two scenarios.
    """
    require(len(scenarios) > 1, "seeds", len(scenarios), "leave no interval", "give 2 or more")
    finer = [s.with_options(dt=s.numerics.dt / FINER) for s in scenarios]
    tasks = (joblib.delayed(_sums_of)(packed(s)) for s in [*scenarios, *finer])
    sums = np.array(joblib.Parallel(jobs)(tasks)).reshape(2, len(scenarios), len(BETWEEN), len(QUANTITIES), 2)
    return [
        _compared(between, quantity, *sums[:, :, b, q])
        for b, between in enumerate(BETWEEN)
        for q, quantity in enumerate(QUANTITIES)
    ]


def _compared(between: str, quantity: str, coarse: Floats, fine: Floats) -> Comparison:
    """Of sums (seeds, 2) of friction and normal force."""
    weights = np.random.default_rng(0).multinomial(len(coarse), np.full(len(coarse), 1 / len(coarse)), (2, RESAMPLES))
    with np.errstate(divide="ignore", invalid="ignore"):
        values = [np.divide(*of.sum(axis=0)) for of in (coarse, fine)]
        resampled = [np.divide(*(w @ of).T) for w, of in zip(weights, (coarse, fine), strict=True)]
        ratios = resampled[0] / resampled[1]
        difference = values[0] / values[1] - 1.0
    low, high = np.quantile(ratios - 1.0, [0.5 - 0.5 * CONFIDENCE, 0.5 + 0.5 * CONFIDENCE])
    return Comparison(between, quantity, *map(float, (*values, difference, low, high)))


def _sums_of(shipped: Scenario | PackedScenario) -> Floats:
    return simulate(unpacked(shipped)).contact_sums
