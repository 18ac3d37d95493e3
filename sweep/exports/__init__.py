"""Exports: runs and datasets in the forms that other tools open."""

from sweep.exports.files import write_hdf5, write_sqlite, write_text
from sweep.exports.forces import forces_on_persons, forces_on_walls
from sweep.exports.pedpy_ import ForPedPy, to_pedpy
from sweep.exports.tables import to_dataframe

__all__ = [
    "ForPedPy",
    "forces_on_persons",
    "forces_on_walls",
    "to_dataframe",
    "to_pedpy",
    "write_hdf5",
    "write_sqlite",
    "write_text",
]
