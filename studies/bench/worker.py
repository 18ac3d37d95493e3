"""A process that holds one code and one packing and times it whenever it is asked."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from studies.bench.packing import Packing
from studies.bench.peers import Peer, Sample, Timing, load

LEAST = 0.15  # s of CPU time that one answer rests on at least
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
ROOT = Path(__file__).parents[2]


class Worker:
    """One code in a process of its own, so that none warms or slows another."""

    def __init__(self, peer: Peer, packing: Packing) -> None:
        self.log = tempfile.TemporaryFile("w+")  # noqa: SIM115  # open as long as the worker
        self.folder = tempfile.TemporaryDirectory()  # also where a library may leave its log files
        path = Path(self.folder.name) / "packing.npz"
        packing.save(path)
        command = [sys.executable, "-m", "studies.bench.worker", peer.name, str(path)]
        environment = os.environ | dict.fromkeys(THREADS, "1") | {"PYTHONPATH": str(ROOT)} | peer.environment()
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": self.log}
        self.process = subprocess.Popen(command, cwd=self.folder.name, env=environment, text=True, **pipes)
        try:
            self.tuned = str(self._answer()["tuned"])
        except BaseException:
            self.close()
            raise

    def ask(self) -> Timing:
        """One more timing.

        Raises
        ------
        RuntimeError
            If the code fails, with its own last words.
        """
        assert self.process.stdin is not None
        print("again", file=self.process.stdin, flush=True)
        return Timing(**self._answer())

    def close(self) -> None:
        """End the process."""
        self.process.communicate()
        self.log.close()
        self.folder.cleanup()

    def _answer(self) -> dict[str, Any]:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            self.log.seek(0)
            words = self.log.read().strip().splitlines()
            raise RuntimeError(words[-1] if words else "its process ended without a word")
        return json.loads(line)


def enough(sample: Sample, least: float = LEAST) -> Timing:
    """Samples until they took `least` seconds, as one timing."""
    total = sample()
    while total.seconds < least:
        more = sample()
        rebuilds = total.rebuilds + more.rebuilds
        total = Timing(total.seconds + more.seconds, total.steps + more.steps, total.dt, rebuilds)
    return total


def main(name: str, path: str) -> None:
    """Prepare, say so, then time once for every line that comes in."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever a library prints goes with the errors
    sample, tuned = load(name).prepare(Packing.load(Path(path)))
    print(json.dumps({"tuned": tuned}), file=answers, flush=True)
    for _ in sys.stdin:
        print(json.dumps(enough(sample)._asdict()), file=answers, flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
