"""Rooms by name: those of the engine, and a user's own in a file of theirs."""

import importlib.util
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

from engine import Scenario, with_options
from engine.errors import BadInput, require
from engine.rooms import ROOMS

Room = Callable[..., Scenario]
ENDING = ".py:"  # between the file and the function of a user's own room

_loaded: dict[Path, ModuleType] = {}


def is_in_a_file(name: str) -> bool:
    """Whether a room's name names a file: "my_rooms.py:my_room"."""
    return ENDING in name


def room_named(name: str) -> Room:
    """The room of this name, with the options of runs as further keywords.

    Parameters
    ----------
    name : str
        A key of `engine.rooms.ROOMS`, or "my_rooms.py:my_room", a file, from where the command is given, and a function
        in it.

    Raises
    ------
    BadInput
        If there is no such room, or its file cannot be read or run.
    """
    remedy = f"choose one of {', '.join(ROOMS)}, or name a file and a function in it: my_rooms.py:my_room"
    require(name in ROOMS or is_in_a_file(name), "room", repr(name), "is not known", remedy)
    return ROOMS[name] if name in ROOMS else _in_a_file(name)


def _in_a_file(name: str) -> Room:
    file, _, function = name.rpartition(":")
    module = _module(Path(file))
    room = getattr(module, function, None)
    known = ", ".join(n for n, value in vars(module).items() if callable(value) and not n.startswith("_"))
    require(callable(room), "room", repr(function), f"is no function in '{file}'", f"name one of {known or 'yours'}")
    assert room is not None
    return with_options(room)


def _module(path: Path) -> ModuleType:
    """A file as a module, run once."""
    require(path.is_file(), "room file", f"'{path}'", "is not there", "name one from where the command is given")
    place = path.resolve()
    if place in _loaded:
        return _loaded[place]
    name = place.stem if place.stem not in sys.modules else f"{place.stem}_room_file"
    spec = importlib.util.spec_from_file_location(name, place)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # where its laws are looked for when they are shipped to workers
    sys.path.append(str(place.parent))  # for what it imports from beside it
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        raise BadInput(f"room file {_where(error, path)}: {type(error).__name__}: {error}: mend the file") from None
    finally:
        sys.path.remove(str(place.parent))
    _loaded[place] = module
    return module


def _where(error: Exception, path: Path) -> str:
    """File and line at which running a file failed."""
    if isinstance(error, SyntaxError):
        return f"'{path}', line {error.lineno}"
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if Path(f.filename) == path.resolve()]
    return f"'{path}', line {lines[-1]}" if lines else f"'{path}'"
