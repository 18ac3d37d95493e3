"""Counts the kernels that a session compiles: each set of types of laws costs seconds, once on a machine."""

from pathlib import Path

import numba

import engine  # noqa: F401  sets the folder of compiled code

BEFORE = set()


def kernels():
    """Files of the compiled time loop."""
    return set(Path(numba.config.CACHE_DIR).rglob("step.advance-*.nbc"))


def pytest_sessionstart(session):
    BEFORE.update(kernels())


def pytest_terminal_summary(terminalreporter):
    terminalreporter.write_line(f"{len(kernels() - BEFORE)} kernels were compiled")
