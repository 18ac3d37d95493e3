"""Scenarios with laws of one's own, on their way to workers that cannot import them.

A scenario is data, but a law is code that stands in a file, a script or a notebook of the user's. It is shipped by
value, and registered again where it arrives.
"""

import pickle
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import NamedTuple

import cloudpickle

from engine import Scenario
from engine.kernel.laws.custom import GENERICS, is_custom

MAIN = "__main__"  # whose functions are pickled by value in any case


class PackedScenario(NamedTuple):
    """A scenario and the laws that it needs, as bytes."""

    data: bytes


def packed(scenario: Scenario) -> Scenario | PackedScenario:
    """The scenario in the form in which it can be shipped; one of the engine's own laws is so already."""
    types = {type(law) for law in scenario.model if is_custom(law)}
    if not types:
        return scenario
    laws = [(call.__name__, kind, call.given[kind]) for call in GENERICS for kind in types if kind in call.given]
    with _by_value({law.__module__ for _, kind, function in laws for law in (kind, function)}):
        return PackedScenario(cloudpickle.dumps((laws, scenario)))


def unpacked(shipped: Scenario | PackedScenario) -> Scenario:
    """The scenario, with its laws registered in this process."""
    if isinstance(shipped, Scenario):
        return shipped
    laws, scenario = pickle.loads(shipped.data)
    for _, kind, function in laws:
        for module in (kind.__module__, function.__module__):  # which numba imports when it loads machine code
            sys.modules.setdefault(module, ModuleType(module))
    generics = {call.__name__: call for call in GENERICS}
    for name, kind, function in laws:
        if generics[name].given.get(kind) is not function:
            generics[name].law(kind)(function)
    result: Scenario = scenario
    return result


@contextmanager
def _by_value(modules: set[str]) -> Iterator[None]:
    """Pickle the functions and classes of these modules by value."""
    loaded = [sys.modules[name] for name in modules if name in sys.modules and name != MAIN]
    for module in loaded:
        cloudpickle.register_pickle_by_value(module)
    try:
        yield
    finally:
        for module in loaded:
            cloudpickle.unregister_pickle_by_value(module)
