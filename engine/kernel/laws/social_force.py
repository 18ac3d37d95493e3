"""Social force: keeping a distance."""

import itertools
import math
from typing import Annotated, Any, NamedTuple

from engine.kernel.dispatch import generic
from engine.kernel.exponential import exp
from engine.kernel.laws.absent import Absent
from engine.kernel.laws.parameters import above, at_least

FARTHEST = 1e3  # m, at which a social force must have fallen below the tolerance
NEAR = 1e-7  # m, over which the slope at contact is taken


class Exponential(NamedTuple):
    """A exp(-gap/B), going on in overlap (Lin et al. 2016, Eq. 2; Helbing et al. 2000)."""

    A: Annotated[float, at_least(0.0, "N", "force at contact")]
    B: Annotated[float, above(0.0, "m", "range")]


@generic()
def social(p, gap):
    """Repulsion at a gap between two surfaces (negative in overlap), N; it falls with the gap, to zero."""


@social.law(Absent)
def _no_social(p, gap):
    return 0.0


@social.law(Exponential)
def _exponential(p, gap):
    return p.A * exp(gap * (-1.0 / p.B))


def cutoff(law: Any, tolerance: float) -> float:
    """Largest gap at which a social force is above the tolerance, m, by bisection; 0 where it nowhere is.

    The kernel subtracts the tolerance (N) from the force, which so ends there without a jump.
    """
    if not social(law, 0.0) > tolerance:
        return 0.0
    low, high = 0.0, FARTHEST
    while low < (middle := 0.5 * (low + high)) < high and high - low > 1e-15 * high:
        low, high = (middle, high) if social(law, middle) > tolerance else (low, middle)
    return low


def social_stiffness(law: Any) -> float:
    """Largest change of the social force with the gap where two surfaces meet, N/m."""
    here = social(law, 0.0)
    return max(social(law, -NEAR) - here, here - social(law, NEAR), 0.0) / NEAR


def is_repulsion(law: Any, tolerance: float) -> bool:
    """Whether a social force is finite, nowhere negative, falls with the gap and ends."""
    end = cutoff(law, tolerance)
    forces = [social(law, gap) for gap in (-0.1, -0.01, *(end * k / 64 for k in range(65)), 1.5 * end, FARTHEST)]
    falls = all(b <= a + 1e-9 * abs(a) for a, b in itertools.pairwise(forces))
    return all(map(math.isfinite, forces)) and falls and forces[-1] >= 0.0 and forces[-1] <= tolerance
