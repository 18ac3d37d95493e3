"""Where numba keeps compiled kernels: one folder for each state of the engine's sources.

Numba looks only at the file a kernel stands in, while the laws a kernel inlines stand in others. So the
folder's name carries a fingerprint of the whole package: an edited law never meets a stale kernel, and an
edited comment or docstring costs no compilation.
"""

import ast
import hashlib
import os
import tempfile
from pathlib import Path

import numba

SOURCES = Path(__file__).parent
FOLDERS_KEPT = 8
COMMAND = "__main__.py"  # calls the engine, and is no part of it: what it prints changes no run


def fingerprint(sources: Path = SOURCES) -> str:
    """Hash of what the package's sources mean: their code without comments and docstrings (16 hex digits)."""
    digest = hashlib.sha256()
    for path in sorted(path for path in sources.rglob("*.py") if path.name != COMMAND):
        digest.update(path.relative_to(sources).as_posix().encode())
        digest.update(ast.unparse(_without_docstrings(ast.parse(path.read_text("utf-8")))).encode())
    return digest.hexdigest()[:16]


def _without_docstrings(tree: ast.Module) -> ast.Module:
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node, clean=False):
            node.body = node.body[1:] or [ast.Pass()]
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
