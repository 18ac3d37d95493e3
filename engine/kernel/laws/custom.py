"""Laws that stand outside the engine: what they compute is part of a run's key and of the name of compiled code.

A law of one's own is told from an edited one by a hash of its code and of all that it refers to. The kernel gets its
parameters as a type whose name carries that hash, so that numba's caches, in memory and on disk, never serve machine
code of an edit before.
"""

import dis
import functools
import hashlib
import sys
import types
from collections import namedtuple
from collections.abc import Callable, Hashable
from typing import Any

import numpy as np

from engine.kernel.dispatch import Generic
from engine.kernel.laws import KINDS
from engine.kernel.laws.friction import friction_limit, viscosity

GENERICS: tuple[Generic, ...] = (*dict.fromkeys(KINDS.values()), viscosity, friction_limit)
PLAIN = (bool, int, float, complex, str, bytes, type(None))
PACKAGE = __name__.partition(".")[0]
DIGITS = 12  # of a hash
FIXED_MODULES = sys.stdlib_module_names | {"numpy", "numba", PACKAGE}  # told by versions, and by the fingerprint


class UntraceableError(TypeError):
    """A law that refers to something whose value no hash can tell."""


def is_custom(law: Any) -> bool:
    """Whether a law's parameters are of a type that stands outside the engine."""
    return stands_outside(type(law))


def stands_outside(parameters: type) -> bool:
    """Whether a type of parameters stands outside the engine."""
    return parameters.__module__.partition(".")[0] != PACKAGE


def fingerprint_of(laws: Any) -> str:
    """Hash of the laws of one's own among some, "" if there are none.

    Raises
    ------
    UntraceableError
        If one refers to something whose value no hash can tell.
    """
    marks = sorted({_mark(type(law)) for law in laws if is_custom(law)})
    return hashlib.sha256("".join(marks).encode()).hexdigest()[:DIGITS] if marks else ""


def kernel_parameters(law: Any) -> Any:
    """The parameters as the kernel gets them."""
    kind: Any = type(law)
    return _kernel_type(kind, _mark(kind))(*law) if is_custom(law) else law


def cached_by_laws(function: Callable[..., Any]) -> Callable[..., Any]:
    """Cache a function of laws by what these compute; two laws of equal numbers are equal tuples."""
    cached = functools.lru_cache(maxsize=1024)(lambda kinds, *arguments: function(*arguments))

    @functools.wraps(function)
    def call(laws: Any, *arguments: Any) -> Any:
        return cached(tuple(type(kernel_parameters(law)) for law in laws), laws, *arguments)

    return call


def _mark(parameters: type) -> str:
    """Hash of all laws of a type of parameters."""
    digest = hashlib.sha256(repr((parameters.__name__, parameters._fields)).encode())  # type: ignore[attr-defined]
    for call in GENERICS:
        if parameters in call.given:
            digest.update(call.__name__.encode() + _code_of(call.given[parameters]))
    return digest.hexdigest()[:DIGITS]


def _code_of(function: Any) -> bytes:
    """What a function computes: its code, and that of all it refers to, without docstrings and places."""
    digest, seen = hashlib.sha256(), set()

    def add(value: Any, name: str) -> None:
        value = getattr(value, "py_func", value)  # of a compiled function
        if isinstance(value, types.FunctionType):
            if value not in seen:
                seen.add(value)
                add_code(value.__code__, value)
                for default in value.__defaults__ or ():
                    add(default, name)
        elif isinstance(value, types.ModuleType | types.BuiltinFunctionType | np.ufunc | Generic | type):
            digest.update(f"{type(value).__name__} {getattr(value, '__qualname__', value.__name__)}".encode())
        elif isinstance(value, PLAIN):
            digest.update(repr(value).encode())
        elif isinstance(value, tuple | frozenset):
            for part in sorted(value, key=repr) if isinstance(value, frozenset) else value:
                add(part, name)
        elif isinstance(value, np.ndarray | np.generic):
            digest.update(str(value.dtype).encode() + value.tobytes())
        else:
            raise UntraceableError(f"refers to {name}, a {type(value).__name__}")

    def add_code(code: types.CodeType, function: types.FunctionType) -> None:
        digest.update(code.co_code + repr((code.co_varnames, code.co_names)).encode())
        for constant in code.co_consts[1 if function.__doc__ else 0 :]:
            if isinstance(constant, types.CodeType):
                add_code(constant, function)
            else:
                add(constant, "a constant")
        cells = dict(zip(code.co_freevars, function.__closure__ or (), strict=False))
        value: Any = None
        for instruction in dis.get_instructions(code):
            name = instruction.argval
            if instruction.opname == "LOAD_GLOBAL" and name in function.__globals__:
                value = function.__globals__[name]
            elif instruction.opname == "LOAD_DEREF" and name in cells:
                value = cells[name].cell_contents
            elif instruction.opname in ("LOAD_ATTR", "LOAD_METHOD") and _is_a_users(value):
                value = getattr(value, name)  # of what stands in a module
            else:
                value = None
                continue
            add(value, name)

    add(function, function.__name__)
    return digest.digest()


def _is_a_users(value: Any) -> bool:
    """Whether this is a module that an edit may change: none of Python's, numba's, numpy's or the engine's."""
    return isinstance(value, types.ModuleType) and value.__name__.partition(".")[0] not in FIXED_MODULES


@functools.cache
def _kernel_type(parameters: Hashable, mark: str) -> type:
    """A type of parameters that is named after what its laws compute."""
    name, fields = f"{parameters.__name__}_{mark}", parameters._fields  # type: ignore[attr-defined]
    kind = namedtuple(name, fields, module=__name__)  # type: ignore[misc]
    globals()[name] = kind  # where pickle looks for it
    for call in GENERICS:
        if parameters in call.given:
            call.law(kind)(_of_this_module(call.given[parameters]))
    return kind


def _of_this_module(law: Any) -> Any:
    """The same function under a module that every process has, which numba imports when it loads machine code."""
    law = getattr(law, "py_func", law)
    copy = types.FunctionType(law.__code__, law.__globals__, law.__name__, law.__defaults__, law.__closure__)
    copy.__module__ = __name__
    return copy


def __getattr__(name: str) -> Any:
    """A stand-in for a law that another process knew, met in the index of compiled code."""
    if name.rpartition("_")[0] and len(name.rpartition("_")[2]) == DIGITS:
        return namedtuple(name, "unknown", module=__name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
