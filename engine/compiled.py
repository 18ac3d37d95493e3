"""How the functions of a time step are compiled."""

from typing import Any

from numba import njit

# numba counts the references to every array that a function is given, atomically; with people in two dozen arrays
# that is 0.2 microseconds a call, 4 a step. Functions that neither make nor keep arrays need no count.
# "contract" lets a product and a sum become one rounded operation; nan, infinity and order of sums stay as written.
OPTIONS: dict[str, Any] = {"cache": True, "error_model": "numpy", "_nrt": False, "fastmath": {"contract"}}
step_function = njit(**OPTIONS)
inlined_step_function = njit(inline="always", **OPTIONS)
