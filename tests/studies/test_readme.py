"""The README's code is run as printed."""

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"


def test_the_readmes_ten_lines_work_as_printed(tmp_path):
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text("utf-8"), flags=re.DOTALL)
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    found = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "all 100 persons were out" in found.stdout
    assert "Name: blocked_share, dtype: float64" in found.stdout
    assert (tmp_path / "results/mine/dataset.nc").is_file()


def test_contributings_recipe_for_a_law_works_as_printed(tmp_path):
    """In a copy of the engine: the law and its companions put at the end of its file, then the run."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    law, companions, run = (textwrap.dedent(code) for code in re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL))
    shutil.copytree(ROOT / "engine", tmp_path / "engine", ignore=shutil.ignore_patterns("__pycache__"))
    path = tmp_path / "engine" / "laws" / "repulsion.py"
    path.write_text(path.read_text("utf-8") + f"\n\n{law}\n\n{companions}")
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    command = [sys.executable, "-c", run]
    found = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    assert "all 20 persons were out" in found.stdout
