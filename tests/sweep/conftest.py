"""Fixtures of the sweep's tests."""

from pathlib import Path

import pytest

from sweep import Grid
from tests.sweep.tiny import TINY


@pytest.fixture
def grid() -> Grid:
    return Grid("lin_room", v_d=[1.0, 1.4], seed=range(3), **TINY)


@pytest.fixture
def store(tmp_path: Path) -> Path:
    return tmp_path / "results"
