"""exp(x) as branch-free arithmetic, so that a loop that calls it is vectorised (a call of libm's is not)."""

import math

import numpy as np
from numba.extending import overload

from engine.kernel.compiled import INLINED

LOG2_E = 1.4426950408889634
LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10  # ln 2 in two parts
SMALLEST, LARGEST = -708.0, 709.0  # beyond: denormal, overflow


def exp(x: float) -> float:
    """exp(x) within 1e-14 relative for SMALLEST <= x <= LARGEST, held at the ends outside."""
    return math.exp(min(max(x, SMALLEST), LARGEST))


@overload(exp, jit_options=INLINED)
def _compiled_exp(x):
    return _polynomial


def _polynomial(x):
    """The same by arithmetic.

    x = k ln 2 + r with abs(r) <= ln 2 / 2; Taylor's series in r to the 11th order; 2^k by its bits.
    """
    x = min(max(x, SMALLEST), LARGEST)
    k = np.floor(x * LOG2_E + 0.5)
    r = (x - k * LN2_HIGH) - k * LN2_LOW
    q = 1.0 / 39916800.0
    q = q * r + 1.0 / 3628800.0
    q = q * r + 1.0 / 362880.0
    q = q * r + 1.0 / 40320.0
    q = q * r + 1.0 / 5040.0
    q = q * r + 1.0 / 720.0
    q = q * r + 1.0 / 120.0
    q = q * r + 1.0 / 24.0
    q = q * r + 1.0 / 6.0
    q = q * r + 0.5
    q = q * r + 1.0
    q = q * r + 1.0
    bits = (np.int64(k) + 1023) << 52
    return q * np.int64(bits).view(np.float64)
