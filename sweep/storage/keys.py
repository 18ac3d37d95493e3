"""Keys of the points of a grid, without building more scenarios than it takes to know them."""

import hashlib
import json
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

from engine.fingerprint import package_fingerprint
from sweep import schema
from sweep.errors import CannotWrite
from sweep.grid import SEED, Grid, Point
from sweep.storage.store import Store

FILE = "keys.json"


class Wanted(NamedTuple):
    """What a store is asked for: a run."""

    key: str
    scenario: str  # hash of the scenario, whatever the engine


def keys_of(grid: Grid, store: Store | None = None) -> list[Wanted]:
    """Keys of all points, in their order; kept in the store, if one is given, until grid, schema or engine change."""
    if store is None or not grid.seeds_alone:  # rooms of one's own may be edited, which no fingerprint tells
        return [_wanted(text) for text in _canonical(grid)] if grid.seeds_alone else _of_each(grid)
    mark = key_mark(grid)
    kept = _kept(store, mark, len(grid))
    if kept is None:
        kept = list(map(_wanted, _canonical(grid)))
        with suppress(CannotWrite):  # a store that cannot be written to is asked more slowly
            store.note(FILE, json.dumps({"mark": mark, "digest": _digest(kept), "keys": kept}))
    return kept


def key_mark(grid: Grid) -> str:
    """Hash of what decides about the keys of a grid: rooms and options are part of it, which no run's key names."""
    return schema.key_of(grid.to_json(), engine=package_fingerprint())


def _wanted(canonical: str, engine: str = "") -> Wanted:
    return Wanted(schema.key_of(canonical, engine=engine), schema.scenario_hash(canonical))


def _of_each(grid: Grid) -> list[Wanted]:
    """Keys of all points of a room of one's own."""
    return [_wanted(s.canonical(), schema.engine_of(s)) for s in map(grid.scenario, grid.points())]


def _canonical(grid: Grid) -> Iterator[str]:
    """Canonical texts of a room of the engine, where the seed decides nothing else; a cell's scenario is built once."""
    cells: dict[tuple[object, ...], tuple[str, str]] = {}
    for point in grid.points():
        cell = grid.cell(point)
        if cell not in cells:
            cells[cell] = _around_seed(grid, point)
        before, after = cells[cell]
        yield f"{before}{grid.seed_of(point)}{after}"


def _around_seed(grid: Grid, point: Point) -> tuple[str, str]:
    """What stands before and after the seed in the canonical text of a cell's runs."""
    scenario = grid.scenario(point)
    text, seed = scenario.canonical(), f"{scenario.seed}}}"
    assert text.endswith(f'"{SEED}":{seed}'), "the canonical text of a scenario ends with its seed"
    return text.removesuffix(seed), "}"


def _kept(store: Store, mark: str, number: int) -> list[Wanted] | None:
    try:
        kept = json.loads((store.path / FILE).read_text("utf-8"))
        keys = [Wanted(*pair) for pair in kept["keys"]] if kept["mark"] == mark else []
        return keys if len(keys) == number and kept["digest"] == _digest(keys) else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _digest(keys: list[Wanted]) -> str:
    return hashlib.sha256("".join(map("".join, keys)).encode()).hexdigest()
