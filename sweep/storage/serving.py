"""Which runs of a store serve a grid, and what becomes of those that another state of the engine made."""

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from engine import FINGERPRINT
from engine.errors import require
from sweep.errors import SweepStopped
from sweep.schema import SCHEMA_VERSION
from sweep.storage.keys import Wanted
from sweep.storage.manifest import Entry
from sweep.storage.store import Store

ERROR, RERUN, ACCEPT = "error", "rerun", "accept"
ON_CODE_CHANGE = (ERROR, RERUN, ACCEPT)


class Serving(NamedTuple):
    """What a store has of the runs that it is asked for."""

    entries: dict[str, Entry]  # key asked for -> the run that serves it
    stale: dict[str, Entry]  # key asked for -> a run of the same scenario by another engine, which does not serve

    def engines(self) -> dict[str, int]:
        """Fingerprint of each other engine -> number of runs of it that serve."""
        others = (entry.engine for key, entry in self.entries.items() if entry.key != key)
        return dict(Counter(others))

    def content(self, wanted: Iterable[Wanted], grid: str) -> str:
        """Hash of what a dataset is made of: the grid, and the files of its runs."""
        files = [(w.key, self.entries[w.key].sha256 if w.key in self.entries else "") for w in wanted]
        return hashlib.sha256(json.dumps([grid, files]).encode()).hexdigest()


def serving(wanted: Iterable[Wanted], store: Store, on_code_change: str = RERUN) -> Serving:
    """What serves, and what would if the engine had not been edited.

    Parameters
    ----------
    on_code_change : "accept" lets runs of other engines serve where there is none of this one

    Raises
    ------
    BadInput
        If the choice is none of ON_CODE_CHANGE.
    SweepStopped
        If it is "error", and there are such runs.
    """
    remedy = f"choose one of {', '.join(ON_CODE_CHANGE)}"
    require(on_code_change in ON_CODE_CHANGE, "on_code_change", repr(on_code_change), "is not known", remedy)
    finished, wanted = store.finished(), list(wanted)
    entries = {w.key: finished[w.key] for w in wanted if w.key in finished}
    missing = [w for w in wanted if w.key not in entries]
    others = _by_scenario(finished) if missing else {}
    stale = {w.key: others[w.scenario] for w in missing if w.scenario in others}
    if stale and on_code_change == ERROR:
        raise SweepStopped(f"{changed(stale, len(wanted))}: choose on_code_change = 'rerun' or 'accept'")
    return Serving(entries | stale, {}) if on_code_change == ACCEPT else Serving(entries, stale)


def changed(stale: Mapping[str, Entry], total: int) -> str:
    """How many runs are of another engine, and of which."""
    engines = ", ".join(sorted({entry.engine for entry in stale.values()}))
    are = "is" if len(stale) == 1 else "are"
    which = f"another state of the engine or of a law ({engines}; now {FINGERPRINT})"
    return f"{len(stale)} of {total} runs {are} done by {which}"


def _by_scenario(finished: Mapping[str, Entry]) -> dict[str, Entry]:
    """Scenario -> the run of another engine that was finished last."""
    return {e.scenario: e for e in finished.values() if e.engine != "" and e.schema == SCHEMA_VERSION}
