"""The engine of this repository with the laws that LAMMPS computes here: equal work.

Springs at walls as between persons, nobody looks, and walls do not push socially.
"""

from engine import laws, models
from studies.bench.peers import Peer
from studies.bench.peers.jamsweep_ import preparing

LAWS = models.lin_dem(friction="kept", wall_friction="kept", wall_social=False)._replace(anisotropy=laws.Absent())
PEER = Peer("jamsweep_as_lammps", "LAMMPS's laws", ("jamsweep",), preparing(LAWS))
