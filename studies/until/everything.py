"""Seeds where they are needed, tried: coverage of intervals that end a sweep, and runs saved on Fig. 10's grid."""

from pathlib import Path

import numpy as np
import xarray as xr

from engine import rooms
from studies import measures
from studies.presentation.verdicts import MARKS, columns, interval
from studies.until.planted import Covered, cells, coverage, settled
from studies.until.rules import Boundaries, HalfWidths
from sweep import Grid, Until, sweep
from sweep.until import account

FOLDER = Path("results/until")
SUPPLY = 120  # seeds; a blocked share of a half is known to 0.1 after 93
GRID = Grid(
    rooms.lin_room,
    v_d=[0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0],
    N=[100, 200, 300],
    seed=range(SUPPLY),
)
RULE = Until(HalfWidths(clearance_time=0.05, blocked_share=0.1), least=10, batch=10)
REFINED = Until(RULE.excess, RULE.least, RULE.batch, refine=Boundaries(0.1))
COPIES, QUICK_COPIES = 2000, 100
LEAST_COVERAGE = 0.90  # asked for
LARGEST_SHARE = 0.60  # of the runs of a uniform grid, asked for
PLANTED_BLOCKING = (0.0, 0.0, 0.0, 0.0, 0.05, 0.2, 0.5, 0.8)  # of a planted column over the same v_d


def coverage_table(found: list[Covered]) -> str:
    """One line for each planted cell."""
    head = ("interval of", "planted", "seeds when stopped", "held the planted value", "at least 90 %")
    rows = [
        (
            c.what,
            f"share {c.planted:g}" if c.what == "blocked share" else f"scatter {c.planted:g}",
            f"{c.seeds:.1f}",
            f"{interval(100 * c.share, 100 * c.low, 100 * c.high, 1)} %",
            MARKS[c.share >= LEAST_COVERAGE],
        )
        for c in found
    ]
    return columns([head, *rows])


def planted_share(copies: int, until: Until = RULE) -> str:
    """Runs that a planted column takes, beside a uniform grid."""
    rng = np.random.default_rng(1)
    columns_of = [cells(rng, copies, SUPPLY, share, 0.08) for share in PLANTED_BLOCKING]
    ds = xr.concat([column.isel(copy=slice(0, copies)) for column in columns_of], "cell")
    seeds = settled(ds, until)
    part = seeds.sum(axis=0) / (seeds.shape[0] * seeds.max(axis=0))
    return f"planted column: {seeds.sum(axis=0).mean():.0f} runs, {part.mean():.0%} of a uniform grid's"


def cell_table(ds: xr.Dataset) -> str:
    """Seeds, blocked share and mean clearance time of each cell, with half-widths."""
    shares = measures.blocked_share(ds)
    facts = measures.clearance(ds)
    means = measures.mean_over(facts.clearance_time.where(measures.outcome_is(ds, "all_out")), censored=facts.censored)
    rows: list[tuple[str, ...]] = [
        ("N", "v_d / m/s", "seeds", "blocked share", "clearance time of those out / s", "excess")
    ]
    for N in ds.N.values:
        for v_d in ds.v_d.values:
            at = {"N": N, "v_d": v_d}
            if ds.seeds_given.sel(at) > 0:
                rows.append(
                    (
                        f"{N}",
                        f"{v_d:g}",
                        f"{int(ds.seeds_given.sel(at))}",
                        *_words(shares.sel(at), means.sel(at)),
                        f"{float(ds.excess.sel(at)):.2f}",
                    )
                )
    return columns(rows)


def _words(share: xr.Dataset, mean: xr.Dataset) -> tuple[str, str]:
    return _with_limits(share, "blocked_share", 2), _with_limits(mean, "clearance_time", 0)


def _with_limits(of: xr.Dataset, name: str, digits: int) -> str:
    mean, low, high = (float(of[f"{name}{end}"]) for end in ("", "_low", "_high"))
    return interval(mean, low, high, digits)


def boundary_table(ds: xr.Dataset) -> str:
    """The boundaries of each N, with intervals."""
    found = measures.states(ds)
    rows: list[tuple[str, ...]] = [("N", "transition from / m/s", "phase separation from / m/s")]
    for N in ds.N.values:
        column = found.sel(N=N)
        rows.append((f"{N}", *(_boundary(column, name) for name in ("transition_from", "phase_separation_from"))))
    return columns(rows)


def _boundary(column: xr.Dataset, name: str) -> str:
    at, low, high = (float(column[f"{name}{end}"]) for end in ("", "_low", "_high"))
    decision = column[f"{name}_decision"]
    why = decision.attrs["flag_meanings"].split()[int(decision)].replace("_", " ")
    return interval(at, low, high, 2) if np.isfinite(at) else f"undecided: {why}, [{low:.2f}, {high:.2f}]"


def main(quick: bool = False, jobs: int = 2) -> None:
    """Measure coverage on planted data; unless quick, sweep the grid of Fig. 10 until its goals are reached."""
    parts = [coverage_table(coverage(RULE, QUICK_COPIES if quick else COPIES)), planted_share(100)]
    print(*parts, sep="\n\n", flush=True)
    if not quick:
        ds = sweep(GRID, FOLDER, jobs, until=RULE)
        saved = ds.attrs["runs_given"] / ds.attrs["runs_uniform"] <= LARGEST_SHARE and not ds.attrs["cells_open"]
        parts += [cell_table(ds), f"{account(ds)}; at most {LARGEST_SHARE:.0%}: {MARKS[saved]}", boundary_table(ds)]
        print(*parts[2:], sep="\n\n", flush=True)
        finer = sweep(GRID, FOLDER, jobs, until=REFINED)
        parts += [f"with v_d refined: {account(finer)}", boundary_table(finer)]
        print(*parts[5:], sep="\n\n")
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "table.txt").write_text("\n\n".join(parts) + "\n", "utf-8")
