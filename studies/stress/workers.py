"""Worker processes that may hang or crash: what they work on is named, and the others go on.

A compiled loop holds Python's lock, so only another process can end it: each worker is watched by its parent,
ended when its time is up, and replaced.
"""

import multiprocessing
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from typing import Any, NamedTuple

CONTEXT = multiprocessing.get_context("spawn")


class Hung(NamedTuple):
    """The task took longer than it may."""

    patience: float  # s


class Crashed(NamedTuple):
    """The process ended without an answer."""

    exit_code: int | None


class _Worker:
    def __init__(self, work: Callable[[Any], Any]) -> None:
        self.pipe, theirs = CONTEXT.Pipe()
        self.process = CONTEXT.Process(target=_serve, args=(work, theirs), daemon=True)
        self.process.start()
        theirs.close()
        self.task: Any = None
        self.deadline = float("inf")

    def give(self, task: Any, patience: float) -> None:
        self.task, self.deadline = task, time.monotonic() + patience
        self.pipe.send(task)

    def end(self) -> int | None:
        self.process.kill()
        self.process.join()
        self.pipe.close()
        return self.process.exitcode


def answers(
    work: Callable[[Any], Any], tasks: Iterable[Any], jobs: int, patience: float
) -> Iterator[tuple[Any, Any | Hung | Crashed]]:
    """Each task with its answer, in the order in which they come.

    Parameters
    ----------
    work : a module's function, which the workers import
    jobs : number of worker processes
    patience : time that one task may take, s
    """
    waiting = iter(tasks)
    workers = [_Worker(work) for _ in range(jobs)]
    try:
        busy = [worker for worker in workers if _next(worker, waiting, patience)]
        while busy:
            for worker in _ready(busy):
                task, answer = worker.task, _answer(worker, patience)
                if isinstance(answer, Hung | Crashed):
                    busy.remove(worker)
                    workers.append(_Worker(work))
                    busy.append(workers[-1])
                    worker = workers[-1]
                if not _next(worker, waiting, patience):
                    busy.remove(worker)
                yield task, answer
    finally:
        for worker in workers:
            worker.end()


def _ready(busy: list[_Worker]) -> list[_Worker]:
    """Workers that have answered, ended, or used up their time."""
    left = max(min(worker.deadline for worker in busy) - time.monotonic(), 0.0)
    spoke = wait([worker.pipe for worker in busy], left)
    return [worker for worker in busy if worker.pipe in spoke or time.monotonic() >= worker.deadline]


def _answer(worker: _Worker, patience: float) -> Any | Hung | Crashed:
    if not worker.pipe.poll():
        worker.end()
        return Hung(patience)
    try:
        return worker.pipe.recv()
    except (EOFError, ConnectionResetError):
        return Crashed(worker.end())


def _next(worker: _Worker, waiting: Iterator[Any], patience: float) -> bool:
    for task in waiting:
        worker.give(task, patience)
        return True
    return False


def _serve(work: Callable[[Any], Any], pipe: Connection) -> None:
    """What a worker does until its parent is gone; Ctrl-C is the parent's to handle."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        try:
            task = pipe.recv()
        except EOFError:
            return
        pipe.send(work(task))
