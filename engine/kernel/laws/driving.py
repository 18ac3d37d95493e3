"""Driving force: what makes a person walk."""

from typing import Annotated, NamedTuple

from engine.kernel.compiled import formula
from engine.kernel.dispatch import generic
from engine.kernel.laws.absent import Absent
from engine.kernel.laws.parameters import above


class Relaxation(NamedTuple):
    """Relaxation towards the desired velocity, m (v_d e - v)/tau (Lin et al. 2016, Eq. 1)."""

    tau: Annotated[float, above(0.0, "s", "reaction time")]


@generic()
def drive(p, mass, v_d, e, v):
    """Driving force along one axis, N, linear in v; e: desired direction and v: velocity along that axis."""


@drive.law(Absent)
def _no_drive(p, mass, v_d, e, v):
    return 0.0


@drive.law(Relaxation)
def _relaxation(p, mass, v_d, e, v):
    return mass * (1.0 / p.tau) * (v_d * e - v)


@formula
def drive_rate(p):
    """Rate at which the drive takes velocity, 1/s, from its difference over 1 m/s."""
    return drive(p, 1.0, 0.0, 0.0, 0.0) - drive(p, 1.0, 0.0, 0.0, 1.0)
