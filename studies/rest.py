"""Whether the early verdict "frozen" agrees with the full wait, on slow and blocked runs of both models."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from joblib import Parallel, delayed

from engine import Run, Scenario, rooms, simulate
from studies.presentation.verdicts import columns
from studies.variants.room import variant_room

FOLDER = Path("results/rest")
VARIANTS = (  # of what the friction of Lin's model may be
    "kept 0.3",
    "reset",
    "reset to zero (1 ms)",
    "reset / Coulomb",
    "reset / reset",
    "kept 0.5",
    "kept 0.5 / kept",
)
SLOW = 20.0  # s, a wait that ended
HEAD = ("runs", "tested", "blocked", "slow", "frozen early", "agree", "simulated time saved")


class Pair(NamedTuple):
    """One scenario, run with and without the early verdict."""

    kind: str
    blocked: bool
    slow: bool  # somebody waited longer than SLOW and got out
    frozen: bool
    agree: bool
    full_end: float  # s
    early_end: float  # s


def scenarios(quick: bool) -> Iterator[tuple[str, Scenario]]:
    """Rooms that block: Lin's at high desired speeds, Parisi & Dorso's with a narrow door."""
    seeds = range(2 if quick else 10)
    for variant in VARIANTS[::4] if quick else VARIANTS:
        for v_d in (2.0, 2.4):
            for seed in seeds:
                yield f"Lin, {variant}", variant_room(variant, v_d, N=150, seed=seed)
    for v_d in (4.0, 6.0, 8.0):
        for seed in seeds if quick else range(20):
            yield "Parisi & Dorso, door of 0.6 m", rooms.parisi_room(v_d=v_d, N=100, seed=seed, L=0.6)


def both(kind: str, scenario: Scenario) -> Pair:
    """Run a scenario with and without the early verdict."""
    early = simulate(scenario)
    full = simulate(scenario, stop_at_rest=False)
    same = early.exit_time.tolist() == full.exit_time.tolist()
    verdict = full.outcome == "blocked" if early.outcome == "frozen" else early.outcome == full.outcome
    return Pair(
        kind,
        blocked=full.outcome == "blocked",
        slow=_longest_wait(full) > SLOW,
        frozen=early.outcome == "frozen",
        agree=same and verdict,
        full_end=full.end_time,
        early_end=early.end_time,
    )


def _longest_wait(run: Run) -> float:
    return max((b - a for a, b in zip(run.exit_time, run.exit_time[1:], strict=False)), default=0.0)


def table(pairs: list[Pair]) -> str:
    """How often the two agree, for each kind of run."""
    kinds = [*Counter(pair.kind for pair in pairs), "all"]
    return columns([HEAD, *(_row(kind, [p for p in pairs if kind in ("all", p.kind)]) for kind in kinds)])


def _row(kind: str, pairs: list[Pair]) -> tuple[str, ...]:
    saved = sum(p.full_end - p.early_end for p in pairs) / max(sum(p.full_end for p in pairs), 1e-9)
    return (
        kind,
        str(len(pairs)),
        str(sum(p.blocked for p in pairs)),
        str(sum(p.slow for p in pairs)),
        str(sum(p.frozen for p in pairs)),
        str(sum(p.agree for p in pairs)),
        f"{saved:.0%}",
    )


def main(quick: bool = False, jobs: int = 2) -> None:
    """Run all pairs and print the table.

    Raises
    ------
    SystemExit
        If an early verdict and the full wait disagree.
    """
    simulate(rooms.parisi_room(N=1, time_limit=0.1))
    pairs = Parallel(n_jobs=jobs)(delayed(both)(kind, scenario) for kind, scenario in scenarios(quick))
    text = table([pair for pair in pairs if pair.blocked or pair.slow])
    print(text)
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "table.txt").write_text(text + "\n", "utf-8")
    wrong = [pair for pair in pairs if not pair.agree]
    if wrong:
        raise SystemExit(f"{len(wrong)} early verdicts disagree with the full wait: {wrong[0]}")
