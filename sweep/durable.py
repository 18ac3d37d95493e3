"""Files that are there whole or not at all, also after a crash or a power cut."""

import os
import secrets
import socket
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from engine import BadInput


def replace_durably(path: Path, write: Callable[[Path], None]) -> None:
    """Put a file in place in one step.

    Parameters
    ----------
    path : where the file shall be; an older one is replaced
    write : writes and closes the file whose path it is given; its name tells host and process of the owner
    """
    owner = f"{socket.gethostname()}.{os.getpid()}"
    temporary = path.with_name(f".{path.name}.{owner}.{secrets.token_hex(4)}.tmp")
    try:
        write(temporary)
        flush(temporary)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
    flush(path.parent)


def append_line(path: Path, line: str) -> None:
    """Add a line to a file that other processes may be adding to as well."""
    descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
    try:
        os.write(descriptor, f"\n{line}\n".encode())  # one call, so that lines never mix; the first \n ends a torn one
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def flush(path: Path) -> None:
    """Have the disk hold what was written to this file, or the names in this folder."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def require_writable(folder: Path, thing: str) -> None:
    """Raise `BadInput` unless files can be made in this folder; tried, since rights alone do not tell."""
    try:
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        refuse(folder, thing, error)


def refuse(path: Path, thing: str, error: OSError) -> NoReturn:
    """Raise `BadInput` that says why a path cannot be written to."""
    why = (error.strerror or "refused").lower()
    raise BadInput(f"{thing} '{path}' cannot be written to ({why}): name a folder of yours") from None
