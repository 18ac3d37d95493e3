"""Generic functions whose law is chosen by the type of its parameters.

In compiled code numba picks the law while it compiles and inlines it, so absent physics leaves no trace in
the machine code; in plain Python (`NUMBA_DISABLE_JIT=1`, tests, set-up) a table look-up does the same.
"""

import functools
from collections.abc import Callable
from typing import Any

from numba.extending import overload

from engine.errors import require

Law = Callable[..., Any]


class Generic:
    """A function of (parameters, *arguments) with one law for each type of parameters."""

    __name__: str

    def __init__(self, stub: Law) -> None:
        functools.update_wrapper(self, stub)
        self.laws: dict[type, Law] = {}

    def __call__(self, p: Any, *args: Any) -> Any:
        """Apply the law of p's type, in plain Python."""
        return self.laws[type(p)](p, *args)

    def law(self, *parameters: type) -> Callable[[Law], Law]:
        """Register the decorated function as the law for these types of parameters."""

        def register(law: Law) -> Law:
            require(
                law.__module__.partition(".")[0] == "engine",
                "law",
                f"{law.__module__}.{law.__qualname__}",
                "stands outside the package engine, whose sources tell stale kernels and runs from fresh ones",
                "move it into engine/laws",
            )
            self.laws.update(dict.fromkeys(parameters, law))
            return law

        return register


def generic(stub: Law) -> Generic:
    """Make a generic function of a stub that gives its name, arguments and docstring."""
    call = Generic(stub)

    @overload(call, strict=False, inline="always", jit_options={"error_model": "numpy"})
    def typed(p: Any, *args: Any) -> Law:
        return call.laws[p.instance_class]

    return call
