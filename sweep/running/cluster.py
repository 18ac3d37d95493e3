"""The back end dask: a scheduler's workers, on this machine or on many, that see the store.

A run is shipped as data and run in a slot of the dask worker that gets it, so that a run that hangs or crashes costs a
slot's process and not the dask worker. Results stay where workers write them: only a line comes back.
"""

import importlib
import logging
import os
import secrets
import socket
import time
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Self

from engine import BadInput
from engine.errors import require
from sweep.errors import SweepStopped
from sweep.extras import load
from sweep.report import late_word
from sweep.running.attached import PINNED, ctrl_c_left_alone
from sweep.running.slot import ASIDE, LIVES, Job, run_in_own_slot
from sweep.running.worker import Failed, Result
from sweep.storage.store import Store

LOOK = 2.0  # s between two looks how many workers there are
CONNECTING = "10s"
PATIENCE = 5.0  # s without a word


class Dask:
    """Workers of a dask scheduler.

    Parameters
    ----------
    scheduler : its address, "tcp://host:8786"; None: a cluster of `jobs` processes on this machine, for this sweep only
    jobs : number of those processes
    store : where the workers write; they are asked whether they see it

    Raises
    ------
    BadInput
        If dask is not installed, no scheduler answers, or its workers do not see the store.
    """

    def __init__(self, scheduler: str | None, jobs: int, store: Store) -> None:
        self._scheduler, self._jobs, self._store = scheduler, jobs, store
        self._distributed = load("distributed", "dask", "backend 'dask'")
        self._open = ExitStack()
        self._token = ""
        self._places, self._looked = 0, 0.0

    def __enter__(self) -> Self:
        with ExitStack() as begun:
            begun.enter_context(_without_log())
            address = self._scheduler or begun.enter_context(own_cluster(self._jobs))
            self._client = begun.enter_context(_connected(self._distributed, address))
            self._executor = self._client.get_executor(pure=False)
            self._token = begun.enter_context(_Token(self._store)).name
            begun.callback(self._executor.shutdown, wait=False)
            self._require_workers_that_see()
            self._open = begun.pop_all()
        return self

    def __exit__(self, *error: Any) -> None:
        self._open.close()

    def places(self) -> int:
        """The threads of all workers that there are now."""
        if time.monotonic() - self._looked > LOOK:
            try:
                threads = self._client.nthreads()
            except (OSError, RuntimeError):  # of a connection, of a client that is closed
                raise SweepStopped(f"the dask scheduler '{self._client.scheduler.address}' is lost") from None
            self._places, self._looked = max(sum(threads.values()), 1), time.monotonic()
        return self._places

    def begin(self, job: Job) -> "Future[Result]":
        """Begin a job; dask gives it to another worker if its worker dies."""
        future: Future[Result] = Future()
        self._executor.submit(run_in_own_slot, job._replace(token=self._token)).add_done_callback(
            lambda over: self._hand_on(over, future, job)
        )
        return future

    def _hand_on(self, over: "Future[Result]", future: "Future[Result]", job: Job) -> None:
        error = None if over.cancelled() else over.exception()
        if over.cancelled():
            future.set_exception(SweepStopped("the dask scheduler is lost, or gave up the runs"))
        elif error is None:
            future.set_result(over.result())
        elif isinstance(error, self._distributed.KilledWorker):
            line = f"{ASIDE}: dask workers ended in this run, the last one {error.last_worker.address}"
            future.set_result(Failed(job.key, line, str(error)))
        elif isinstance(error, BadInput | SweepStopped):
            future.set_exception(error)
        else:
            future.set_exception(SweepStopped(f"the dask cluster failed ({type(error).__name__}: {error})"))

    def _require_workers_that_see(self) -> None:
        with late_word(PATIENCE, "waiting for a worker of the dask scheduler ..."):
            self._client.wait_for_workers(1)
        try:
            answers = self._client.run(_sees, str(self._store.path.absolute()), self._token)
        except Exception as error:
            raise BadInput(f"dask workers cannot run jamsweep ({error}): install this version there") from None
        for host in (host for host, seen in answers.values() if not seen):
            remedy = "put it on a file system that all machines share"
            require(False, "store", f"'{self._store.path}'", f"is not seen by the worker on {host}", remedy)


class _Token:
    """A file in the store by which workers tell that what they see is the same folder."""

    def __init__(self, store: Store) -> None:
        owner = f"{socket.gethostname()}.{os.getpid()}"
        self._path = store.runs / f".seen.{owner}.{secrets.token_hex(4)}.tmp"  # a stale one is swept as temporaries are
        self.name = self._path.relative_to(store.path).as_posix()

    def __enter__(self) -> Self:
        self._path.touch()
        return self

    def __exit__(self, *error: Any) -> None:
        self._path.unlink(missing_ok=True)


@contextmanager
def _without_log() -> Iterator[None]:
    """Keep what dask's client logs of a lost scheduler, with tracebacks, off the screen: a line says it."""
    log = logging.getLogger("distributed.client")
    level = log.level
    log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        log.setLevel(level)


def _sees(store: str, token: str) -> tuple[str, bool]:
    return socket.gethostname(), (Path(store) / token).exists()


def own_cluster(jobs: int) -> Any:
    """A dask cluster of worker processes of this machine, for a with statement.

    Raises
    ------
    BadInput
        If dask is not installed, or the workers cannot be started.
    """
    distributed = load("distributed", "dask", "backend 'dask'")
    settings = {"distributed.scheduler.allowed-failures": LIVES - 1}
    with ctrl_c_left_alone(), importlib.import_module("dask").config.set(settings):
        try:
            return distributed.LocalCluster(
                n_workers=jobs,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                env=PINNED,
                silence_logs="CRITICAL",
            )
        except RuntimeError as error:
            why = str(error).partition("\n")[0]
            remedy = 'in a script, call sweep below `if __name__ == "__main__":`'
            raise BadInput(f"dask workers cannot be started ({why}): {remedy}") from None


def _connected(distributed: Any, address: Any) -> Any:
    try:
        return distributed.Client(address, timeout=CONNECTING, set_as_default=False)
    except (OSError, ValueError) as error:
        why = str(error).partition("\n")[0] or type(error).__name__
        raise BadInput(f"scheduler '{address}' does not answer ({why}): start one with `dask scheduler`") from None
