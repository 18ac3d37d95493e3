"""Timings -> the table, what it says of the goals, and the page in the docs."""

import datetime
from collections.abc import Iterable
from statistics import median
from typing import NamedTuple

from studies.bench.compare import Found
from studies.bench.packing import DENSITY, DEPTH, V_D
from studies.bench.peers import NAMES, load
from studies.presentation.machine import machine

OURS, SAME_LAWS = "jamsweep", "jamsweep_as_lammps"
HEAD = (
    "N",
    "code",
    "time per step, x jamsweep",
    "jamsweep's person-s per CPU s, x",
    "ns per person-step",
    "ns per pair in reach",
    "person-s per CPU s",
    "spread",
    "steps per list",
)
LAMMPS_GOAL, JUPEDSIM_GOAL, GROWTH_GOAL = 0.35, 50.0, 1.5


class Row(NamedTuple):
    """One code at one N, medians over the repeats."""

    N: int
    code: str
    per_person: float  # ns per person-step
    per_pair: float  # ns per pair in reach and step
    pace: float  # simulated person-seconds per CPU second, with the code's own step
    spread: float  # half the range of the repeats over their median
    steps_per_list: float  # nan where the code does not tell


def row(found: Found) -> Row:
    """The medians of what was found."""
    times = [t.seconds / t.steps for t in found.timings]  # s per step
    step = median(times)
    steps, rebuilds = (sum(getattr(t, name) for t in found.timings) for name in ("steps", "rebuilds"))
    return Row(
        found.N,
        found.code,
        per_person=step / found.N * 1e9,
        per_pair=step / found.pairs * 1e9,
        pace=found.N * found.timings[0].dt / step,
        spread=(max(times) - min(times)) / (2 * step),
        steps_per_list=steps / rebuilds if rebuilds else float("nan"),
    )


def table(found: list[Found]) -> str:
    """The table in Markdown, goals and notes below."""
    rows = [row(f) for f in found if f.timings]
    ours = {r.N: r for r in rows if r.code == OURS}
    lines = [HEAD, tuple("---" for _ in HEAD), *(_cells(f, ours) for f in found)]
    text = "\n".join(f"| {' | '.join(line)} |" for line in lines)
    return "\n\n".join([text, _bullets(goals(rows)), _bullets(notes(found))])


def _cells(found: Found, ours: dict[int, Row]) -> tuple[str, ...]:
    if not found.timings:
        return (f"{found.N:,}", found.code, found.note.partition(":")[0], *[""] * (len(HEAD) - 3))
    r = row(found)
    mine = ours.get(r.N)
    ratios = (f"{r.per_person / mine.per_person:.3g}", f"{mine.pace / r.pace:.3g}") if mine else ("", "")
    lists = f"{r.steps_per_list:.0f}" if r.steps_per_list == r.steps_per_list else ""
    bare = (f"{r.per_person:.4g}", f"{r.per_pair:.3g}", f"{r.pace:,.0f}", f"{r.spread:.0%}")
    return (f"{r.N:,}", r.code, *ratios, *bare, lists)


def _bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def goals(rows: list[Row]) -> list[str]:
    """What the rows say of the project's goals, as far as they can."""
    at = {(r.code, r.N): r for r in rows}
    said = []
    for ours, laws in ((SAME_LAWS, "the same laws"), (OURS, "all of Lin's laws")):
        if (ours, 200) in at and ("lammps", 200) in at:
            ratio = at[ours, 200].per_pair / at["lammps", 200].per_pair
            said.append(_goal(f"time per pair in reach, N = 200, {laws}, of LAMMPS's", ratio, "<=", LAMMPS_GOAL))
    if (OURS, 200) in at and ("jupedsim", 200) in at:
        ratio = at["jupedsim", 200].per_person / at[OURS, 200].per_person
        said.append(_goal("agent-steps per second, N = 200, of JuPedSim's", ratio, ">=", JUPEDSIM_GOAL))
    if (OURS, 200) in at and (OURS, 10_000) in at:
        ratio = at[OURS, 10_000].per_person / at[OURS, 200].per_person
        said.append(_goal("cost per person-step, N = 10,000 of N = 200", ratio, "<=", GROWTH_GOAL))
    if (OURS, 100_000) in at:
        said.append("100,000 persons in one hall: they run")
    return said


def _goal(what: str, ratio: float, sense: str, goal: float) -> str:
    met = ratio <= goal if sense == "<=" else ratio >= goal
    return f"{what}: {ratio:.3g} (goal {sense} {goal:g}: {'met' if met else 'NOT met'})"


def notes(found: list[Found]) -> list[str]:
    """How it was measured, what each code computed, and what is missing."""
    common = [
        f"One jam for all: {DENSITY:g} persons/m^2 in a closed hall {DEPTH:g} m deep and as wide as N asks for, "
        f"everybody pressing towards one long side at v_d = {V_D:g} m/s; equal arrays for every code.",
        "Medians of process CPU time, one thread, codes taking turns. Compilation, set-up and the first steps are "
        "not in it (jamsweep: two runs of different length, subtracted).",
        "Pairs in reach: gap below the one where Lin's social force ends by the paper's numerics, counted "
        "once at the start; the same count divides every code's time, whatever its own reach is.",
        "Person-seconds per CPU second use each code's own usual step, whether or not it is stable with it.",
        "LAMMPS has the same contact law, social force, drive and walls, but no anisotropy and no social walls; "
        "jamsweep_as_lammps is this engine with just these laws.",
        "JuPedSim and PySocialForce compute their own models; everybody is steered straight ahead.",
    ]
    return common + [f"{code}: {text}" for code, text in _said_once(found)]


def _said_once(found: list[Found]) -> list[tuple[str, str]]:
    """Each code's notes with the N they belong to."""
    where: dict[tuple[str, str], list[str]] = {}
    for f in found:
        if f.note:
            where.setdefault((f.code, f.note), []).append(f"{f.N:,}")
    return [(f"{code} (N = {'; '.join(sizes)})", note) for (code, note), sizes in where.items()]


# --- Page -----------------------------------------------------------------------------------------------


def peers() -> str:
    """The codes that were at hand, and their versions."""
    found = [load(name) for name in NAMES]
    return ", ".join(f"{peer.name} {peer.version()}" for peer in found if not peer.missing())


def page(text: str, command: str) -> str:
    """The page of the docs."""
    return (
        "# Benchmark\n\n"
        f"Measured on {datetime.date.today().isoformat()} with `{command}` on: {machine()}; {peers()}.\n\n"
        "Quote the ratios: bare times are those of this machine on that day.\n\n"
        f"{text}\n"
    )
