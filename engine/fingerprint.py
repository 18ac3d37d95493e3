"""Fingerprint of the kernel, and the folder in which numba keeps what it compiled.

Numba looks only at the file a kernel stands in, while the laws that it is compiled with stand in others. So the name of
the folder carries a hash of all of `engine/kernel`: an edited law never meets stale machine code. The same hash is part
of a run's key. Rooms, named models, options and messages stand outside: a scenario's text has what they decide.
"""

import ast
import functools
import hashlib
import os
import tempfile
from pathlib import Path

import numba

SOURCES = Path(__file__).parent / "kernel"
FOLDERS_KEPT = 8


def fingerprint(sources: Path = SOURCES) -> str:
    """Hash of what sources mean: their code without comments, docstrings and annotations (16 hex digits)."""
    digest = hashlib.sha256()
    for path in sorted(sources.rglob("*.py")):
        digest.update(path.relative_to(sources).as_posix().encode())
        digest.update(ast.unparse(_bare(ast.parse(path.read_text("utf-8")))).encode())
    return digest.hexdigest()[:16]


@functools.cache
def package_fingerprint() -> str:
    """Hash of all of the engine, rooms and options included."""
    return fingerprint(SOURCES.parent)


def _bare(tree: ast.Module) -> ast.Module:
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node, clean=False):
            node.body = node.body[1:] or [ast.Pass()]
        if isinstance(node, ast.FunctionDef):
            node.returns = None
        if isinstance(node, ast.arg):
            node.annotation = None
        if isinstance(node, ast.AnnAssign):
            node.annotation = ast.Constant(None)
    return tree


def use_own_folder(mark: str) -> None:
    """Point numba's cache to a folder of this fingerprint; call before the first kernel is decorated.

    The folder lies in `NUMBA_CACHE_DIR` if that is set, else in the user's cache folder, else in the system's
    folder for temporary files.
    """
    own = Path(os.environ.get("NUMBA_CACHE_DIR") or _user_cache() / "jamsweep" / "numba")
    for base in (own, Path(tempfile.gettempdir()) / f"jamsweep-numba-{os.getuid()}"):
        folder = base / f"engine-{mark}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            os.utime(folder)
            tempfile.TemporaryFile(dir=folder).close()  # rights alone do not tell
            _forget_oldest(base)
            _forget_torn(folder)
        except OSError:
            continue
        numba.config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]  # numba sets its options by name
        return


def _forget_torn(folder: Path) -> None:
    """Remove files that a crash or a full disk left empty: numba fails on them."""
    for path in folder.rglob("*.nb[ic]"):
        if path.stat().st_size == 0:
            path.unlink(missing_ok=True)


def _user_cache() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def _forget_oldest(base: Path) -> None:
    folders = sorted(base.glob("engine-*"), key=lambda f: f.stat().st_mtime, reverse=True)
    for folder in folders[FOLDERS_KEPT:]:
        for path in folder.rglob("*.nb[ic]"):
            path.unlink(missing_ok=True)
