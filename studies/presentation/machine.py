"""What a measurement ran on."""

import os
import platform
from importlib import metadata
from pathlib import Path


def machine() -> str:
    """The processor's kind, cores, and the versions of Python and numba."""
    versions = f"Python {platform.python_version()}, numba {metadata.version('numba')}"
    return f"{_processor()}, {os.cpu_count()} cores; {versions}"


def _processor() -> str:
    path = Path("/proc/cpuinfo")
    lines = path.read_text("utf-8").splitlines() if path.exists() else []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or platform.machine()
