"""Files that are there whole or not at all, also after a crash or a power cut."""

import errno
import fcntl
import hashlib
import os
import re
import secrets
import socket
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NoReturn

from engine import BadInput
from engine.errors import require

BLOCK = 2**20  # bytes: what a disk must take to be one with room
MARK = re.compile(r"\.(?P<name>.+)\.~(?P<host>[^~]+)~(?P<pid>\d+)~(?P<start>\d+)~[0-9a-f]{8}\.tmp")


def replace_durably(path: Path, write: Callable[[Path], object]) -> None:
    """Put a file in place in one step.

    Parameters
    ----------
    path : where the file shall be; an older one is replaced
    write : writes and closes the file whose path it is given; its name tells host and process of the owner

    Raises
    ------
    OSError
        If the disk takes no more, also where the library that writes has no word for it.
    """
    temporary = path.with_name(f".{path.name}.~{_owner()}~{secrets.token_hex(4)}.tmp")
    try:
        try:
            write(temporary)
        except RuntimeError as error:
            if type(error) is not RuntimeError:
                raise
            raise _refusal(temporary, error) from None  # all that netCDF says of a full disk is "HDF error"
        flush(temporary)
        os.replace(temporary, path)
    finally:
        with suppress(OSError):  # a file system that became read-only keeps it; the first error is the one to tell
            temporary.unlink(missing_ok=True)
    flush(path.parent)


def append_line(path: Path, line: str) -> None:
    """Add a line to a file that other processes may be adding to as well.

    Raises
    ------
    OSError
        If not all of it could be written; what is there of it counts for nothing.
    """
    line = f"\n{line}\n"  # in one call, so that lines never mix; the first \n ends a torn one
    with _to_add_to(path) as descriptor:
        if os.write(descriptor, line.encode()) < len(line.encode()):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        os.fsync(descriptor)


def rewrite_lines(path: Path, kept: Callable[[str], bool]) -> None:
    """Drop the lines that are not kept; lines that others add meanwhile are not lost.

    Nothing is done on a file system that has no locks.
    """
    with path.open("r+b") as file:
        if _lock(file.fileno(), fcntl.LOCK_EX):
            lines = file.read().decode("utf-8", errors="replace").split("\n")
            text = "".join(f"{line}\n" for line in lines if line and kept(line))
            replace_durably(path, lambda temporary: temporary.write_text(text, "utf-8"))


@contextmanager
def _to_add_to(path: Path) -> Iterator[int]:
    """A file opened to be added to, which nobody rewrites meanwhile."""
    while True:
        descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        try:
            _lock(descriptor, fcntl.LOCK_SH)
            if _is_still(path, descriptor):
                yield descriptor
                return
        finally:
            os.close(descriptor)


def _lock(descriptor: int, kind: int) -> bool:
    try:
        fcntl.flock(descriptor, kind)
    except OSError:  # a file system without locks
        return False
    return True


def _is_still(path: Path, descriptor: int) -> bool:
    """Whether an open file is the one of this name: it may have been rewritten before the lock was had."""
    try:
        return os.path.samestat(os.stat(path), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def flush(path: Path) -> None:
    """Have the disk hold what was written to this file, or the names in this folder."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def sha256_of(path: Path) -> str:
    """SHA-256 of a file's bytes (64 hex digits)."""
    with path.open("rb", buffering=0) as file:
        return hashlib.file_digest(file, hashlib.sha256).hexdigest()


@contextmanager
def locked(path: Path) -> Iterator[bool]:
    """Hold a lock that processes of this machine, and of a shared file system that has locks, take in turn.

    Yields
    ------
    Whether it was had; another holds it otherwise. It ends with its process at the latest.
    """
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT, 0o666)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
        else:
            yield True
    finally:
        os.close(descriptor)


# --- Temporaries that a crash left -----------------------------------------------------------------------


def owner_of(temporary: Path) -> tuple[str, int, int] | None:
    """Host, process and its start (clock ticks since the machine's) that a temporary's name tells; None for others."""
    mark = MARK.fullmatch(temporary.name)
    return (mark["host"], int(mark["pid"]), int(mark["start"])) if mark else None


def is_dead(owner: tuple[str, int, int]) -> bool:
    """Whether a process is known to have ended: only of those of this machine that can be known."""
    host, pid, start = owner
    return host == _host() and _start_of(pid) != start


def _owner() -> str:
    return f"{_host()}~{os.getpid()}~{_start_of(os.getpid())}"


def _host() -> str:
    return socket.gethostname().replace("~", "-").replace("/", "-")


def _start_of(pid: int) -> int:
    """When a process began, in ticks that no setting of the clock changes, 0 if unknown; -1 if there is none."""
    try:
        return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[19])
    except (FileNotFoundError, ProcessLookupError):
        pass
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return -1
    except PermissionError:
        pass
    return 0


# --- What to say -----------------------------------------------------------------------------------------


def require_writable(folder: Path, thing: str) -> None:
    """Raise `BadInput` unless files can be made in this folder; tried, since rights alone do not tell."""
    try:
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        refuse(folder, thing, error)


def require_target(path: Path, thing: str = "output") -> None:
    """Raise `BadInput` unless this is the name of a file, in a folder that can be written to."""
    named = path.name != "" and path.name.isprintable()
    require(named, thing, repr(str(path)), "is not the name of a file", "name the file to write")
    require_writable(path.absolute().parent, f"{thing} folder")


def refuse(path: Path, thing: str, error: OSError) -> NoReturn:
    """Raise `BadInput` that says why a path cannot be written to."""
    why = (error.strerror or "refused").lower()
    raise BadInput(f"{thing} '{path}' cannot be written to ({why}): name a folder of yours") from None


def _refusal(temporary: Path, error: RuntimeError) -> OSError:
    """Why a file could not be written: what the system says when plain bytes are."""
    probe = temporary.with_name(f"{temporary.name.removesuffix('.tmp')[:-8]}{secrets.token_hex(4)}.tmp")
    try:
        probe.write_bytes(bytes(BLOCK))
        flush(probe)
    except OSError as refusal:
        return refusal
    finally:
        with suppress(OSError):
            probe.unlink(missing_ok=True)
    return OSError(errno.EIO, str(error), str(temporary))
