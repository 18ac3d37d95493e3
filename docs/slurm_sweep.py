"""A sweep on a SLURM cluster: copy this file beside your grid file, set the partition, and start it on a login node.

python slurm_sweep.py grid.toml --jobs 16             # 16 jobs of 4 workers each
python slurm_sweep.py grid.toml --print-job-script    # what each job is, and nothing else
"""

import argparse
from pathlib import Path

from dask_jobqueue import SLURMCluster

from sweep import sweep
from sweep.gridfile import read_gridfile
from sweep.running.attached import PINNED

WORKERS = 4  # of a job, one core each
JOB = {
    "queue": "normal",  # the partition
    "cores": WORKERS,
    "processes": WORKERS,
    "memory": "8GB",  # of a job
    "walltime": "04:00:00",
    "job_script_prologue": [f"export {name}={value}" for name, value in PINNED.items()],
    "worker_extra_args": ["--lifetime", "225m", "--lifetime-stagger", "10m"],  # leave before SLURM ends the job
    "local_directory": "/tmp",
}


def main() -> None:
    """Ask SLURM for jobs, sweep on what it grants, and give the jobs back."""
    parser = argparse.ArgumentParser(description="A sweep on a SLURM cluster.")
    parser.add_argument("grid", type=Path, help="TOML file; its store lies on a file system that all nodes see")
    parser.add_argument("--jobs", type=int, default=4, help=f"SLURM jobs, of {WORKERS} workers each")
    parser.add_argument("--timeout", type=float, help="time that one run may take, s")
    parser.add_argument("--print-job-script", action="store_true", help="print what is submitted, and submit nothing")
    chosen = parser.parse_args()
    grid, store, _ = read_gridfile(chosen.grid)
    with SLURMCluster(**JOB) as cluster:
        if chosen.print_job_script:
            print(cluster.job_script())
            return
        cluster.scale(jobs=chosen.jobs)
        sweep(grid, store, scheduler=cluster.scheduler_address, timeout=chosen.timeout, memory_limit="1.5 GB")


if __name__ == "__main__":
    main()
