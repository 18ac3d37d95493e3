"""Tiny grids and what to look at in a store."""

from pathlib import Path

TINY = {"N": 5, "size": 4.0, "time_limit": 2.0}  # milliseconds a run; most end with some persons still inside


def run_files(store: Path) -> dict[str, bytes]:
    """Name -> bytes of every run file."""
    return {path.name: path.read_bytes() for path in sorted((store / "runs").glob("*.nc"))}
