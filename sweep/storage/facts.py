"""What a run adds to the gathered dataset, out of its file or its shard, held against the hash that was noted."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import netCDF4
import numpy as np

from sweep.errors import DamagedFile
from sweep.report import tell
from sweep.schema import GATHERED
from sweep.storage import shard
from sweep.storage.durable import sha256_of
from sweep.storage.manifest import Entry
from sweep.storage.store import Store

Facts = dict[str, np.ndarray]
NAMES = [variable.name for variable in GATHERED]


class Source:
    """The finished runs of a store; damaged ones are set aside and said.

    Attributes
    ----------
    aside : number of runs that were set aside
    """

    def __init__(self, store: Store) -> None:
        self.aside = 0
        self._store = store
        self._shards: dict[str, dict[str, Facts]] = {}

    def facts(self, entry: Entry) -> Facts | None:
        """Values of the variables of `GATHERED`; None if the run is damaged, and was set aside.

        Raises
        ------
        DamagedFile
            If it cannot be set aside.
        """
        if entry.shard:
            return self._of_shard(entry.shard).get(entry.key)
        path = self._store.file(entry.key)
        try:
            return facts_of(path, entry)
        except FileNotFoundError:  # folded meanwhile
            now = self._store.finished().get(entry.key)
            return self.facts(now) if now and now.shard else None
        except DamagedFile as damage:
            with _possible(path):
                self._store.set_aside(entry.key, str(damage))
            self.aside += 1
            tell(f"{damage}; set aside as {path.name}.corrupt, a sweep runs it again")
            return None

    def _of_shard(self, name: str) -> dict[str, Facts]:
        if name not in self._shards:
            self._shards[name] = self._read_shard(name)
        return self._shards[name]

    def _read_shard(self, name: str) -> dict[str, Facts]:
        path, folded = self._store.shard(name), self._store.vouched.shards()[name]
        try:
            shard.require_whole(path, folded)
        except DamagedFile as damage:
            with _possible(path):
                self._store.set_shard_aside(name, str(damage))
            self.aside += folded.runs
            tell(f"shard '{path}' is damaged; set aside with its {folded.runs} runs, a sweep runs them again")
            return {}
        keys = [entry.key for entry in shard.entries(path)]
        return dict(zip(keys, shard.facts(path, NAMES), strict=True))


def facts_of(path: Path, entry: Entry) -> Facts:
    """What a run file holds of the variables of `GATHERED`.

    Raises
    ------
    FileNotFoundError
        If there is no file.
    DamagedFile
        If its bytes are not those that were noted, or it is not the file of this run.
    """
    if sha256_of(path) != entry.sha256:
        raise DamagedFile(f"run file '{path}' is damaged: its bytes are not those that were written")
    try:
        with netCDF4.Dataset(path) as file:
            file.set_auto_maskandscale(False)
            if (file.complete, file.run_key) != (1, entry.key):
                raise DamagedFile(f"run file '{path}' is damaged: it is not that of a whole run of this key")
            return {name: file.variables[name][:] for name in NAMES}
    except shard.UNREADABLE as error:
        if isinstance(error, DamagedFile):
            raise
        raise DamagedFile(f"run file '{path}' is damaged: it cannot be read") from None


@contextmanager
def _possible(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        why = (error.strerror or "refused").lower()
        raise DamagedFile(f"'{path}' is damaged and cannot be set aside ({why}): delete it and sweep again") from None
