"""Options of compilation.

No function of the kernel makes an array. numba counts the references to every array that a function is given,
atomically, which with two dozen arrays costs 0.2 us a call, 4 us a step: so counting is off (`_nrt`). "contract" lets a
product and a sum become one rounded operation; nan, infinity and the order of sums stay as written. Wrappers by which
Python and C could call an inner function cost a third of its compilation. Functions are not inlined by numba, which
drops branches in silence (0.68.1), but by LLVM.
"""

from typing import Any

from numba import njit
from numba.extending import register_jitable

ARITHMETIC: Any = {"error_model": "numpy", "_nrt": False, "fastmath": {"contract"}}
ENTRY: Any = {"cache": True, "no_cfunc_wrapper": True}
INNER: Any = ARITHMETIC | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

entry_point = njit(**ARITHMETIC, **ENTRY)  # called from Python
step_function = njit(**INNER)  # compiled into the kernel of each set of laws
shared_function = njit(cache=True, **INNER)  # sees no law: compiled once
INLINED: Any = INNER | {"forceinline": True}
inlined_function = njit(**INLINED)
formula = register_jitable(**INLINED)  # plain Python to Python
