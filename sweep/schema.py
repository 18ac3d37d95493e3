"""Names, dimensions, types, units and descriptions of everything that is stored."""

import hashlib
import platform
from collections.abc import Mapping
from operator import attrgetter
from types import MappingProxyType
from typing import Any, NamedTuple

import numba
import numpy as np

from engine import FINGERPRINT, OUTCOMES, Run, Scenario

SCHEMA_VERSION = 4
CONVENTIONS = "CF-1.11"
MM = 1e-3  # m, to which positions alone are stored; a moving person is seen to 1 % of its width
NOTHING = np.int32(-(2**31))  # in packed values
MISSING = OUTCOMES.index("missing")
FLAGS = {"flag_values": np.arange(len(OUTCOMES), dtype=np.int8), "flag_meanings": " ".join(OUTCOMES)}


class Variable(NamedTuple):
    """One variable of a run file, and of the gathered dataset if it has a value to pad with.

    Dimensions: `run` (length 1), `exit` (persons who left, in order), `person`, `sample`, `contact`, `wall`, `door`,
    `end` (x0, y0, x1, y1 of a line).
    """

    name: str
    dims: tuple[str, ...]
    dtype: str
    units: str
    long_name: str
    source: str  # where a Run has it
    pad: float | int | None = None  # in the gathered dataset, where there is none
    attrs: Mapping[str, Any] = MappingProxyType({})
    counts: str = ""  # CF contiguous ragged arrays: the dimension whose elements are counted
    resolution: float = 0.0  # where above 0, a file holds whole multiples of it (CF packed data, scale_factor)

    @property
    def stored_dtype(self) -> str:
        """Type of the values in a file."""
        return "i4" if self.resolution else self.dtype

    def attributes(self) -> dict[str, Any]:
        """What the variable says about itself wherever it stands."""
        return {"units": self.units, "long_name": self.long_name, **self.attrs}


RUN, EXIT, PERSON, STATE, CONTACT = ("run",), ("exit",), ("person",), ("sample", "person"), ("contact",)

VARIABLES = (
    Variable("exit_time", EXIT, "f8", "s", "time of leaving", "exit_time", np.nan),
    Variable("exit_person", EXIT, "i4", "1", "person who left, -1 for nobody", "exit_person", -1),
    Variable("exit_x", EXIT, "f8", "m", "x where the person left", "exit_x", np.nan),
    Variable("exit_y", EXIT, "f8", "m", "y where the person left", "exit_y", np.nan),
    Variable("exit_door", EXIT, "i2", "1", "exit that the person left by, -1 for none", "exit_door", -1),
    Variable("outcome", RUN, "i1", "1", "how the run ended", "outcome", MISSING, FLAGS),
    Variable("end_time", RUN, "f8", "s", "time at which the run ended", "end_time", np.nan),
    Variable("N_out", RUN, "i4", "1", "number of persons who left", "N_out", 0, counts="exit"),
    Variable("persons", RUN, "i4", "1", "number of persons at the start", "N", 0),
    Variable(
        "max_overlap",
        RUN,
        "f8",
        "m",
        "largest overlap of two bodies, or of one with a wall",
        "max_overlap",
        np.nan,
    ),
    Variable("max_speed", RUN, "f8", "m s-1", "largest speed of anybody", "max_speed", np.nan),
    Variable("steps", RUN, "i8", "1", "number of time steps", "steps", 0),
    Variable("rebuilds", RUN, "i8", "1", "number of times the neighbour lists were made", "rebuilds", 0),
    Variable(
        "substepped_steps",
        RUN,
        "i8",
        "1",
        "number of time steps that were cut into substeps",
        "substepped_steps",
        0,
    ),
    Variable(
        "unstable_person",
        RUN,
        "i4",
        "1",
        "person pressed or thrown through others, -1 for nobody",
        "unstable_person",
    ),
    Variable(
        "unstable_partner",
        RUN,
        "i4",
        "1",
        "the person it was pressed through, -1 for nobody",
        "unstable_partner",
    ),
    Variable("radius", PERSON, "f8", "m", "radius", "start.radius"),
    Variable("mass", PERSON, "f8", "kg", "mass", "start.mass"),
    Variable("v_d_person", PERSON, "f8", "m s-1", "desired speed", "start.v_d"),
    Variable("x0", PERSON, "f8", "m", "x at the start", "start.x"),
    Variable("y0", PERSON, "f8", "m", "y at the start", "start.y"),
    Variable("vx0", PERSON, "f8", "m s-1", "x component of the velocity at the start", "start.vx"),
    Variable("vy0", PERSON, "f8", "m s-1", "y component of the velocity at the start", "start.vy"),
    Variable("spin0", PERSON, "f8", "rad s-1", "angular velocity at the start", "start.spin"),
    Variable("wall", ("wall", "end"), "f8", "m", "ends of each wall: x0, y0, x1, y1", "scenario.scene.walls"),
    Variable("door", ("door", "end"), "f8", "m", "ends of each exit's line: x0, y0, x1, y1", "scenario.scene.doors"),
    Variable("time", ("sample",), "f8", "s", "time", "samples.time"),
    Variable("x", STATE, "f4", "m", "x, nan after leaving", "samples.x"),
    Variable("y", STATE, "f4", "m", "y, nan after leaving", "samples.y"),
    Variable("vx", STATE, "f4", "m s-1", "x component of the velocity", "samples.vx"),
    Variable("vy", STATE, "f4", "m s-1", "y component of the velocity", "samples.vy"),
    Variable("spin", STATE, "f4", "rad s-1", "angular velocity", "samples.spin"),
    Variable("row_size", ("sample",), "i4", "1", "number of contacts", "samples.row_size", counts="contact"),
    Variable("contact_i", CONTACT, "i4", "1", "person in touch", "samples.contact_i"),
    Variable("contact_j", CONTACT, "i4", "1", "person it touches, or wall w as -1 - w", "samples.contact_j"),
    Variable(
        "tangential_displacement",
        CONTACT,
        "f4",
        "m",
        "displacement of the tangential spring",
        "samples.tangential_displacement",
    ),
    Variable("contact_F_n", CONTACT, "f4", "N", "normal force on contact_i", "samples.contact_F_n"),
    Variable("contact_F_t", CONTACT, "f4", "N", "tangential force on contact_i", "samples.contact_F_t"),
)
BY_NAME = {variable.name: variable for variable in VARIABLES}
GATHERED = tuple(variable for variable in VARIABLES if variable.pad is not None)

PARAMETERS = {  # keywords of rooms: units and long_name of a coordinate
    "v_d": ("m s-1", "desired speed"),
    "N": ("1", "number of persons"),
    "seed": ("1", "number of the run"),
    "L": ("m", "width of the exit"),
    "A": ("N", "strength of the social force"),
    "B": ("m", "range of the social force"),
    "phi": ("1", "anisotropy of the social force"),
    "E": ("Pa", "Young's modulus of the bodies"),
    "poisson": ("1", "Poisson's ratio of the bodies"),
    "g_n": ("m-1 s-1", "normal damping"),
    "g_t": ("m-1 s-1", "tangential damping"),
    "mu": ("1", "friction coefficient"),
    "tau": ("s", "reaction time"),
    "friction": ("1", "friction between persons: reset, kept, kinetic, coulomb or none"),
    "wall_friction": ("1", "friction at walls: reset, kept, kinetic, coulomb or none"),
    "wall_mu": ("1", "friction coefficient at walls"),
    "wall_social": ("1", "whether walls exert the social force"),
    "wall_A": ("N", "strength of the social force of walls"),
    "inertia": ("1", "moment of inertia: sphere, disc or none"),
    "numerics": ("1", "accurate or paper"),
    "g": ("kg s-1", "normal damping of contacts"),
    "accuracy": ("1", "error tolerated: 2%, 1mm or 0.1mm"),
    "integrator": ("1", "velocity_verlet, predictor or theta"),
    "k_n": ("N m-1", "stiffness of contacts"),
    "kappa": ("kg m-1 s-1", "sliding friction"),
    "mass": ("kg", "mass of everybody"),
    "contacts": ("1", "also record who is in contact, and with what force"),
    "size": ("m", "side of the room"),
    "dt": ("s", "time step"),
    "solver_tolerance": ("m s-1", "change of a velocity at which contacts count as solved"),
    "force_tolerance": ("N", "social force that is neglected"),
    "skin": ("m", "how much farther than they interact pairs are listed, 0: adapted"),
    "stop_at_rest": ("1", "end a run as soon as it is certain that nobody will get out in time"),
    "blocked_after": ("s", "time without anybody leaving after which exits count as blocked"),
    "time_limit": ("s", "time at which a run is ended"),
    "record_every": ("s", "sampling interval"),
    "record": ("1", "what is recorded: full or positions"),
}
RANK = {"units": "1", "long_name": "rank in the order of leaving"}


def run_key(scenario: Scenario) -> str:
    """What a run is found by: hash of its exact description, the schema and the engine (64 hex digits)."""
    return key_of(scenario.canonical(), engine=engine_of(scenario))


def engine_of(scenario: Scenario) -> str:
    """The state of the engine that a scenario is run by: its fingerprint, and that of laws of one's own."""
    laws = scenario.law_fingerprint
    return f"{FINGERPRINT}-{laws}" if laws else FINGERPRINT


def key_of(canonical: str, schema: int | None = None, engine: str = "") -> str:
    """The key of a run whose scenario has this canonical text; of this schema and engine if no others are named."""
    parts = (canonical, str(schema or SCHEMA_VERSION), engine or FINGERPRINT)
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def scenario_hash(canonical: str) -> str:
    """What runs of one scenario share, whichever engine made them (64 hex digits)."""
    return hashlib.sha256(canonical.encode()).hexdigest()


FULL_STATE = {"vx", "vy", "spin", "tangential_displacement", "contact_F_n", "contact_F_t"}  # not with positions alone


def recorded(run: Run) -> tuple[Variable, ...]:
    """The variables that this run has."""
    absent: set[str] = set()
    if run.samples is None:
        absent |= {"sample", "contact"}
    elif not run.scenario.options.contacts:
        absent |= {"contact"}
    have = (v for v in VARIABLES if not absent.intersection((*v.dims, v.counts)))
    if run.scenario.options.record == "full":
        return tuple(have)
    return tuple(_rounded(v) if v.name in ("x", "y") else v for v in have if v.name not in FULL_STATE)


def named(name: str, packed: bool = False) -> Variable:
    """The variable of this name, as a file may hold it.

    Raises
    ------
    KeyError
        If the schema has none.
    """
    return _rounded(BY_NAME[name]) if packed else BY_NAME[name]


def _rounded(position: Variable) -> Variable:
    """A position that is stored to 1 mm."""
    return position._replace(dtype="f8", resolution=MM)


def fact(run: Run, variable: Variable) -> np.ndarray:
    """The values of a variable, of its type and with its dimensions."""
    value = attrgetter(variable.source)(run)
    value = OUTCOMES.index(value) if variable.name == "outcome" else value
    values = np.array(value, dtype=variable.dtype, ndmin=1)
    if variable.resolution:
        return unpacked(packed(values, variable.resolution), variable.resolution)
    return values.reshape(-1, 4) if variable.dims[-1] == "end" else values  # even where there are no walls


def packed(values: np.ndarray, resolution: float) -> np.ndarray:
    """Whole multiples of the resolution, NOTHING for nan and for what is out of all bounds."""
    multiples = np.rint(values / resolution)
    good = np.abs(multiples) < -float(NOTHING)
    return np.where(good, multiples, NOTHING).astype(np.int32)


def unpacked(multiples: np.ndarray, resolution: float) -> np.ndarray:
    """What a reader makes of them: float64, nan for NOTHING."""
    return np.where(multiples == NOTHING, np.nan, multiples * resolution)


def run_attributes(run: Run) -> dict[str, Any]:
    """Global attributes of a run file; the last one says that the others and all values are there."""
    return {
        "Conventions": CONVENTIONS,
        "title": "One run of a crowd that leaves a room",
        "comment": str(run),
        "scenario": run.scenario.to_json(),
        "run_key": run_key(run.scenario),
        "schema_version": np.int32(SCHEMA_VERSION),
        "engine_fingerprint": engine_of(run.scenario),
        "numba_version": numba.__version__,
        "numpy_version": np.__version__,
        "python_version": platform.python_version(),
        "complete": np.int32(1),
    }
