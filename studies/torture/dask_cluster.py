"""A dask cluster of two worker processes, one of them killed in mid-sweep: the same results as in one process."""

import os
import signal
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import xarray as xr
from distributed import Client

from sweep import Grid, Store, sweep
from sweep.running.cluster import own_cluster

CONSTANTS = {"N": 8, "size": 4.0, "accuracy": "0.1mm", "time_limit": 8.0}  # tenths of a second a run


def main(quick: bool) -> list[str]:
    """Sweep on the cluster and in this process, and compare; returns what went wrong."""
    grid = Grid("lin_room", seed=range(20 if quick else 100), **CONSTANTS)
    problems: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        alone, together = Store(Path(folder) / "serial"), Store(Path(folder) / "dask")
        one = sweep(grid, alone, progress=False, backend="serial")
        with own_cluster(2) as cluster:
            killer = _Killer(cluster, together, len(grid) // 4)
            killer.start()
            two = sweep(grid, together, progress=False, scheduler=cluster.scheduler_address)
            killer.join()
        if not killer.killed:
            problems.append("no worker was killed in mid-sweep")
        if not xr.DataArray.equals(one.exit_time, two.exit_time) or not one.equals(two):
            problems.append("the values of the dask sweep differ from the serial one's")
        problems += [
            f"{path.name} differs between dask and serial"
            for path in sorted(alone.runs.glob("*.nc"))
            if not (together.runs / path.name).is_file()
            or (together.runs / path.name).read_bytes() != path.read_bytes()
        ]
    print(f"dask: {len(grid)} runs on 2 workers, {killer.killed} killed, {len(problems)} problems", flush=True)
    return problems


class _Killer(threading.Thread):
    """Kills one worker process of a cluster when a number of runs is kept."""

    def __init__(self, cluster: Any, store: Store, after: int) -> None:
        super().__init__(daemon=True)
        self._cluster, self._store, self._after, self.killed = cluster, store, after, 0

    def run(self) -> None:
        """Wait, then kill; nothing if the sweep ends before."""
        with Client(self._cluster, set_as_default=False) as client:
            pids = list(client.run(os.getpid).values())
            while len(self._store.finished()) < self._after:
                time.sleep(0.05)
            os.kill(pids[0], signal.SIGKILL)
            self.killed = 1
