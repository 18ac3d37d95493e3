"""Functions whose law is chosen by the type of its parameters.

In compiled code numba picks the law while it compiles, so that absent physics leaves no trace in the machine code; in
plain Python (`NUMBA_DISABLE_JIT=1`, set-up, tests) a table look-up does the same.
"""

import functools
from collections.abc import Callable
from typing import Any

from numba import typeof, types
from numba.extending import lower_builtin, overload, type_callable

from engine.kernel.compiled import INLINED, INNER

Law = Callable[..., Any]


class Generic:
    """A function of (parameters, *arguments) with one law for each type of parameters.

    Attributes
    ----------
    given : dict of type -> function
        The registered laws.
    laws : dict of type -> function
        The same in the form that the kernel calls.
    default : function or None
        Law of the types that have none of their own.
    """

    __name__: str

    def __init__(
        self, stub: Law, default: Law | None = None, adapted: Callable[[type, Law], Law] | None = None
    ) -> None:
        functools.update_wrapper(self, stub)
        self.given: dict[type, Law] = {}
        self.laws: dict[type, Law] = {}
        self.default, self._adapted = default, adapted

    def __call__(self, p: Any, *args: Any) -> Any:
        """Apply the law of p's type, in plain Python."""
        return self.of(type(p))(p, *args)

    def of(self, parameters: type) -> Law:
        """Law of a type of parameters."""
        return self.laws[parameters] if self.default is None else self.laws.get(parameters, self.default)

    def law(self, *parameters: type) -> Callable[[Law], Law]:
        """Register the decorated function as the law of these types of parameters.

        A law of one's own may stand in any file: a `NamedTuple` of floats, and a function of it (see docs/law.md).
        """

        def register(law: Law) -> Law:
            for kind in parameters:
                self.given[kind] = law
                self.laws[kind] = self._adapted(kind, law) if self._adapted else law
            return law

        return register


def generic(default: Law | None = None, adapted: Callable[[type, Law], Law] | None = None) -> Callable[[Law], Generic]:
    """Make a generic function of a stub that gives its name, arguments and docstring."""

    def make(stub: Law) -> Generic:
        call = Generic(stub, default, adapted)

        @overload(call, strict=False, jit_options=INLINED)
        def typed(p: Any, *args: Any) -> Law:
            return call.of(p.instance_class)

        return call

    return make


def type_constant(of_type: Callable[[type], Any]) -> Callable[[Any], Any]:
    """Make a function of parameters whose value follows from their type, a constant in compiled code."""

    @functools.wraps(of_type)
    def call(p: Any) -> Any:
        return of_type(type(p))

    @type_callable(call)
    def typed(context: Any) -> Callable[[Any], Any]:
        return lambda p: typeof(of_type(p.instance_class))

    @lower_builtin(call, types.Any)
    def constant(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.get_constant(signature.return_type, of_type(signature.args[0].instance_class))

    call.of_type = of_type  # type: ignore[attr-defined]  # for `only_for`
    return call


def only_for(condition: Callable[[Any], Any], otherwise: Any) -> Callable[[Law], Law]:
    """Compile the decorated function only for parameters (its first argument) of which a type constant is true."""

    def make(function: Law) -> Law:
        @functools.wraps(function)
        def call(p: Any, *args: Any) -> Any:
            return function(p, *args) if condition(p) else otherwise

        @overload(call, strict=False, jit_options=INNER)
        def typed(p: Any, *args: Any) -> Law:
            wanted = condition.of_type(p.instance_class)  # type: ignore[attr-defined]  # a type constant has it
            return function if wanted else lambda p, *args: otherwise

        return call

    return make
