"""The template for SLURM makes job scripts; SLURM itself is not to be had here."""

import subprocess
import sys
from pathlib import Path

import pytest

from engine import rooms

ROOT = Path(rooms.__file__).parents[1]


def test_the_template_asks_slurm_for_one_core_a_worker_and_gives_each_one_thread(tmp_path: Path) -> None:
    pytest.importorskip("dask_jobqueue")
    grid = tmp_path / "grid.toml"
    grid.write_text(f'room = "lin_room"\nstore = "{tmp_path / "results"}"\n[axes]\nseed = [0, 1]\n')
    command = [sys.executable, ROOT / "docs" / "slurm_sweep.py", grid, "--print-job-script"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=300)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].startswith("#!")
    for line in ("#SBATCH -p normal", "#SBATCH --cpus-per-task=4", "#SBATCH -t 04:00:00", "export OMP_NUM_THREADS=1"):
        assert line in lines
    worker = lines[-1] or lines[-2]
    for words in ("dask_worker tcp://", "--nthreads 1", "--nworkers 4", "--lifetime 225m"):
        assert words in worker
    assert not (tmp_path / "results").exists()
