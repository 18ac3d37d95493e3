"""Imports: trajectories of real crowds, or of other simulators, as the datasets that measures take."""

from sweep.imports.crossings import crossings
from sweep.imports.trajectories import read_trajectories

__all__ = ["crossings", "read_trajectories"]
