"""Where runs are run, by name: in this process, in worker processes of this machine, on a dask cluster."""

from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from queue import SimpleQueue
from typing import Protocol, Self

from engine.errors import require
from sweep.running.limits import Limits
from sweep.running.slot import Job, Slot
from sweep.running.worker import Result, work

SERIAL, LOKY, DASK = BACKENDS = ("serial", "loky", "dask")
PATIENCE = 0.2  # s between two looks whether no more runs shall begin, or more workers have come


class Backend(Protocol):
    """Something that runs jobs."""

    def __enter__(self) -> Self:
        """Take up work."""
        ...

    def __exit__(self, *error: object) -> None:
        """End what still runs."""
        ...

    def places(self) -> int:
        """How many jobs may run at once now."""
        ...

    def begin(self, job: Job) -> "Future[Result]":
        """Begin a job."""
        ...


class Serial:
    """The process itself, one run after the other: nothing is started, and nothing can end a run from outside."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        pass

    def places(self) -> int:
        """One."""
        return 1

    def begin(self, job: Job) -> "Future[Result]":
        """Run a job; it has ended when this returns."""
        future: Future[Result] = Future()
        future.set_result(work(job.scenario, job.store, job.key))
        return future


class Loky:
    """Worker processes of this machine: as many slots, each with a thread that waits for its worker."""

    def __init__(self, jobs: int) -> None:
        self._slots = [Slot() for _ in range(jobs)]
        self._free: SimpleQueue[Slot] = SimpleQueue()
        for slot in self._slots:
            self._free.put(slot)
        self._threads = ThreadPoolExecutor(jobs, "slot")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        for slot in self._slots:
            slot.stop()
        self._threads.shutdown(wait=True, cancel_futures=True)
        for slot in self._slots:
            slot.close()

    def places(self) -> int:
        """As many as there are slots."""
        return len(self._slots)

    def begin(self, job: Job) -> "Future[Result]":
        """Begin a job in a slot that is free."""
        return self._threads.submit(self._run, job)

    def _run(self, job: Job) -> Result:
        slot = self._free.get()
        try:
            return slot.run(job)
        finally:
            self._free.put(slot)


def chosen(backend: str | None, jobs: int, scheduler: str | None, limits: Limits) -> str:
    """The name of the back end: by default serial for one job without limits, else loky.

    Raises
    ------
    BadInput
        If there is none of that name, or it does not go with the rest.
    """
    name = backend or (DASK if scheduler else SERIAL if jobs == 1 and not limits.given else LOKY)
    require(name in BACKENDS, "backend", repr(name), "is not known", f"choose one of {', '.join(BACKENDS)}")
    alone = scheduler is None or name == DASK
    require(alone, "scheduler", repr(scheduler), f"is of no use to backend {name}", f"choose backend {DASK}")
    ends = name != SERIAL or not limits.given
    remedy = f"choose backend {LOKY}, also for one job"
    require(ends, "backend", repr(name), "cannot end a run that takes too much time or memory", remedy)
    return name


def results(backend: Backend, jobs: Iterator[Job], drain: Callable[[], bool]) -> Generator[Result]:
    """Run jobs; results come in the order in which the runs end.

    Parameters
    ----------
    jobs : in the order in which they shall begin
    drain : says whether no further job shall begin; those that run are waited for
    """
    running: set[Future[Result]] = set()
    while True:
        while not drain() and len(running) < backend.places():
            job = next(jobs, None)
            if job is None:
                break
            running.add(backend.begin(job))
        if not running:
            return
        ended, running = wait(running, PATIENCE, FIRST_COMPLETED)
        yield from (future.result() for future in ended)
