"""Step, integrator and reach from a stated error; `make study-accuracy` measures what they give."""

import math
from dataclasses import replace
from typing import Any, NamedTuple

from engine.crowd import Given, Uniform
from engine.errors import require
from engine.models import Model
from engine.scenario import Numerics, longest_step


class Level(NamedTuple):
    """How an accuracy is reached."""

    integrator: str
    part: float  # of the longest stable step
    force_tolerance: float  # N


LEVELS = {
    "2%": Level("semi_implicit", 0.36, 0.3),
    "1mm": Level("semi_implicit", 0.18, 1e-2),
    "0.1mm": Level("predictor", 0.45, 1e-3),
}
WAYS = ("accurate", "paper")


def numerics_for(
    numerics: str,
    accuracy: str,
    model: Model,
    crowd: Uniform | Given,
    paper: Numerics,
    every: float = 0.0,
    dt: float | None = None,
    force_tolerance: float | None = None,
    integrator: str | None = None,
) -> Numerics:
    """Numerics chosen to keep the error below what is tolerated, or those of a paper.

    Parameters
    ----------
    numerics : "accurate", from `accuracy`; or "paper"
    accuracy : "2%", bias of the statistics (mean clearance time, blocked share, mean delay);
        "1mm" or "0.1mm", root mean square error of the places before chaos
    paper : what the paper did
    every : sampling interval, which the step must divide, s; 0: none
    dt, force_tolerance, integrator : given, they hold; else they follow. A given integrator without a step takes
        the paper's.

    Raises
    ------
    BadInput
        If one of the first two is not known.
    """
    for name, word, known in (("numerics", numerics, WAYS), ("accuracy", accuracy, tuple(LEVELS))):
        require(word in known, name, repr(word), "is not known", f"choose one of {', '.join(known)}")
    level = LEVELS[accuracy]
    if numerics == "accurate" and integrator is None:
        longest, _ = longest_step(model, crowd, level.integrator)
        found = Numerics(
            _round_down(level.part * min(longest, 1.0)), level.force_tolerance, integrator=level.integrator
        )
        if every > 0.0 and math.isfinite(every):
            found = replace(found, dt=every / math.ceil(every / found.dt - 1e-9))
    else:
        found = paper
    given: dict[str, Any] = {"dt": dt, "force_tolerance": force_tolerance, "integrator": integrator}
    return replace(found, **{name: value for name, value in given.items() if value is not None})


def _round_down(step: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above."""
    power = 10.0 ** math.floor(math.log10(step) + 1e-9)
    return float(f"{max(m for m in (1, 2, 5) if m * power <= step * (1 + 1e-9)) * power:.3g}")
