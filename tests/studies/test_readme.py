"""The README's code is run as printed."""

import re
import subprocess
import sys
from pathlib import Path

README = Path(__file__).parents[2] / "README.md"


def test_the_readmes_ten_lines_work_as_printed(tmp_path):
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text("utf-8"), flags=re.DOTALL)
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    found = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "all 100 persons were out" in found.stdout
    assert "blocked_share" in found.stdout
    assert (tmp_path / "results/mine/dataset.nc").is_file()
