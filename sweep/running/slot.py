"""A slot: one place where runs are run, one after the other, in a worker process that is replaced when it ends.

Each slot has a loky executor of one worker. Loky gives up an executor as a whole when a worker of it dies; one
executor a slot confines that to the one run that the worker had, which is thereby known without further bookkeeping.
"""

import io
import multiprocessing
import os
import re
import signal
import tempfile
import threading
import time
from concurrent.futures import Future, wait
from contextlib import suppress
from pathlib import Path
from typing import IO, NamedTuple

import psutil
from joblib.externals.loky import ProcessPoolExecutor
from joblib.externals.loky.process_executor import BrokenProcessPool

from engine import BadInput, Scenario
from engine.errors import require
from sweep.errors import SweepStopped
from sweep.running.attached import ASK, PINNED, attach, ctrl_c_left_alone
from sweep.running.limits import Limits, megabytes
from sweep.running.shipping import PackedScenario, unpacked
from sweep.running.worker import Done, Failed, Kind, Result, failed, kind_of, prepare, work
from sweep.storage.store import Store

LIVES = 2  # workers that one run may cost
STARTS = 5  # attempts to start a worker, in a row
IDLE = 300.0  # s, after which a worker without a run leaves; the next run starts another
LOOK = 0.1  # s between two looks at the memory of a worker
ANSWER = 0.3  # s, for a worker to write its stack
COMPILING = 900.0  # s, that compilation may take where runs have a time-out
ASIDE, LATE = "set aside", "timed out after"  # how what is noted about such runs begins


class Job(NamedTuple):
    """One run, as it is shipped: data only."""

    key: str
    scenario: Scenario | PackedScenario
    store: str  # absolute path
    limits: Limits = Limits()
    token: str = ""  # name of a file in the store that this machine must see too


class _EndedError(Exception):
    """A worker that ended in a run, or was ended."""

    def __init__(self, why: str, again: bool) -> None:
        super().__init__(why)
        self.why, self.again = why, again


class Slot:
    """One worker process, started when it is needed. For use by one thread; `stop` may be called by another."""

    def __init__(self) -> None:
        self._executor: ProcessPoolExecutor | None = None
        self._stacks: IO[bytes] = io.BytesIO()
        self._path = ""
        self._compiled: set[Kind] = set()
        self._stopped = False

    def run(self, job: Job) -> Result:
        """Run a job in the worker. A run that its worker does not survive is tried once more, in a fresh one.

        Raises
        ------
        SweepStopped
            If no worker can be started, or the slot was stopped meanwhile.
        BadInput
            If this machine does not see the store, or the memory limit leaves no room for a worker.
        """
        _require_seen(job)
        for _ in range(LIVES):
            try:
                return self._attempt(job)
            except _EndedError as end:
                stack, why, again = self._last_stack(), end.why, end.again
            self.close()
            if self._stopped:
                raise SweepStopped("stopped")
            done = Store(job.store).finished().get(job.key)
            if done:  # it had kept the run before it ended
                return Done(job.key, done.duration)
            if not again:
                return Failed(job.key, why, stack)
        return Failed(job.key, f"{ASIDE}: {LIVES} workers ended in this run, the last one {why}", stack)

    def stop(self) -> None:
        """End the worker at once, whatever it does, and start no other."""
        self._stopped = True
        self._kill()

    def close(self) -> None:
        """End the worker."""
        executor, self._executor = self._executor, None
        if executor:
            executor.shutdown(wait=True, kill_workers=True)
            self._forget_path()
        self._stacks.close()

    def _attempt(self, job: Job) -> Result:
        executor = self._open(job.limits)
        kind = kind_of(unpacked(job.scenario))
        try:
            if kind not in self._compiled:
                self._watched(executor.submit(prepare, job.scenario), job.limits._replace(timeout=COMPILING))
                self._compiled.add(kind)
            return self._watched(executor.submit(work, job.scenario, job.store, job.key), job.limits)
        except BrokenProcessPool as error:
            raise _EndedError(_cause(error), again=True) from None
        except (_EndedError, BadInput, SweepStopped):
            raise
        except Exception as error:  # of shipping it there or back
            return failed(job.key, error)

    def _watched(self, future: "Future[Result]", limits: Limits) -> Result:
        """What comes back, if the worker keeps to the limits meanwhile."""
        begin = time.monotonic()
        while limits.given:
            left = begin + limits.timeout - time.monotonic()
            if wait([future], min(max(left, 0.0), LOOK)).done:
                break
            if left <= 0.0:
                self._ask_for_stack()
                self._end(f"{LATE} {limits.timeout:g} s", again=False)
            taken = self._memory()
            if taken > limits.memory:
                self._ask_for_stack()
                self._end(f"for memory: {megabytes(taken)}, above the limit of {megabytes(limits.memory)}", again=True)
        return future.result()

    def _end(self, why: str, again: bool) -> None:
        self._kill()
        raise _EndedError(why, again)

    def _open(self, limits: Limits) -> ProcessPoolExecutor:
        why = ""
        for _ in range(STARTS):
            if self._stopped:
                raise SweepStopped("stopped")
            executor = self._executor or self._new_executor()
            try:
                with ctrl_c_left_alone():
                    executor.submit(os.getpid).result()
            except BrokenProcessPool as error:  # ended while it started, or without a run
                why = _cause(error)
                self.close()
                continue
            self._forget_path()
            self._require_room(limits)
            if not self._stopped:
                return executor
        raise SweepStopped(f"no worker process can be started: the last one ended {why}")

    def _new_executor(self) -> ProcessPoolExecutor:
        self._compiled.clear()
        descriptor, self._path = tempfile.mkstemp(prefix="jamsweep-stack-")
        self._stacks = os.fdopen(descriptor, "rb")
        arguments = (os.getpid(), self._path)
        self._executor = ProcessPoolExecutor(1, timeout=IDLE, initializer=attach, initargs=arguments, env=PINNED)
        return self._executor

    def _forget_path(self) -> None:
        """Remove the name of the file for stacks, which both sides have open: nothing is left if both are killed."""
        with suppress(FileNotFoundError):
            os.unlink(self._path)

    def _require_room(self, limits: Limits) -> None:
        idle = self._memory()
        text = f"leaves no room for a worker, which takes {megabytes(idle)} without a run"
        require(idle < limits.memory, "memory_limit", megabytes(limits.memory), text, "raise it")

    def _worker(self) -> psutil.Process | None:
        processes = getattr(self._executor, "_processes", None)  # loky has no public name for it
        with suppress(psutil.NoSuchProcess, StopIteration, RuntimeError):
            return psutil.Process(next(iter(processes or {})))
        return None

    def _memory(self) -> float:
        """Resident, bytes."""
        worker = self._worker()
        with suppress(psutil.Error):
            return float(worker.memory_info().rss) if worker else 0.0
        return 0.0

    def _kill(self) -> None:
        worker = self._worker()
        with suppress(psutil.Error):
            if worker:
                worker.kill()

    def _ask_for_stack(self) -> None:
        worker = self._worker()
        with suppress(psutil.Error):
            if worker:
                worker.send_signal(ASK)
                time.sleep(ANSWER)

    def _last_stack(self) -> str:
        """What the worker wrote when it crashed or was asked."""
        with suppress(OSError, ValueError):
            self._stacks.seek(0)
            return self._stacks.read().decode("utf-8", "replace")
        return ""


_own = threading.local()


def run_in_own_slot(job: Job) -> Result:
    """Run a job in a slot of this thread: what is handed to the threads of other machines.

    A process of dask is a daemon of multiprocessing, which forbids it children lest they outlive it; ours do not.
    """
    multiprocessing.current_process()._config.pop("daemon", None)  # type: ignore[attr-defined]  # no public way
    if not hasattr(_own, "slot"):
        _own.slot = Slot()
    result: Result = _own.slot.run(job)
    return result


def _require_seen(job: Job) -> None:
    seen = not job.token or (Path(job.store) / job.token).exists()
    where = f"is not seen by the worker on {os.uname().nodename}"
    require(seen, "store", f"'{job.store}'", where, "put it on a file system that all machines share")


def _cause(error: BaseException) -> str:
    """How a worker ended, of what loky says: "{SIGKILL(-9)}"."""
    code = re.search(r"\{.*?(\w+)\((-?\d+)\)", str(error))
    if not code:
        return "unexpectedly"
    number = int(code[2])
    by = {-signal.SIGKILL: " (killed; out of memory?)", -signal.SIGSEGV: " (segmentation fault)"}.get(number, "")
    return f"by {code[1]}{by}" if number < 0 else f"with exit code {number}"
