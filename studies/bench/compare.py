"""All codes on one packing after the other, taking turns."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

from studies.bench.packing import Packing, jam, pairs_in_reach
from studies.bench.peers import EXTRA, Peer, Timing
from studies.bench.worker import Worker

REPEATS = {100: 15, 200: 15, 1000: 9, 10_000: 5, 100_000: 3}


class Found(NamedTuple):
    """All timings of one code at one N."""

    N: int
    pairs: int  # in reach
    code: str
    timings: list[Timing]
    note: str = ""  # how it was tuned, or why there are no timings


def compare(
    peers: Iterable[Peer], sizes: Iterable[int], repeats: dict[int, int], say: Callable[[str], None] = print
) -> list[Found]:
    """Time every code at every N; what is missing or fails has no timings and a note that says why."""
    chosen = list(peers)
    found: list[Found] = []
    for N in sizes:
        packing = jam(N)
        pairs = pairs_in_reach(packing)
        say(f"N = {N}: {pairs / N:.2f} pairs in reach per person ...")
        found += [Found(N, pairs, *row) for row in _in_turns(chosen, packing, repeats[N])]
    return found


def _in_turns(peers: list[Peer], packing: Packing, repeats: int) -> list[tuple[str, list[Timing], str]]:
    """Everybody once, then everybody again, so that the machine's noise hits all."""
    notes = {peer.name: _obstacle(peer, packing.N) for peer in peers}
    timings: dict[str, list[Timing]] = {peer.name: [] for peer in peers}
    workers: dict[str, Worker] = {}
    try:
        for peer in peers:
            if not notes[peer.name]:
                _try(peer.name, notes, lambda peer=peer: _start(peer, packing, workers, notes))  # type: ignore[misc]
        for _ in range(repeats):
            for name in list(workers):
                if not _try(name, notes, lambda name=name: timings[name].append(workers[name].ask())):  # type: ignore[misc]
                    timings[name].clear()
                    workers.pop(name).close()
    finally:
        for worker in workers.values():
            worker.close()
    return [(name, timings[name], notes[name]) for name in timings]


def _obstacle(peer: Peer, N: int) -> str:
    """Why a code is not timed at all; empty if it can be."""
    missing = peer.missing()
    if missing:
        return f"not installed ({', '.join(missing)}): {EXTRA}"
    return f"not run: {peer.why_most}" if peer.most < N else ""


def _start(peer: Peer, packing: Packing, workers: dict[str, Worker], notes: dict[str, str]) -> None:
    workers[peer.name] = Worker(peer, packing)
    notes[peer.name] = workers[peer.name].tuned


def _try(name: str, notes: dict[str, str], work: Callable[[], None]) -> bool:
    try:
        work()
    except (RuntimeError, OSError) as error:
        notes[name] = f"failed: {error}"
        return False
    return True
