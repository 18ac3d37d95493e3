"""Drive: what makes a person walk."""

from typing import NamedTuple

from engine.dispatch import generic
from engine.laws.absent import Absent


class Relaxation(NamedTuple):
    """Relaxation towards the desired velocity (Lin et al. 2016, Eq. 1)."""

    tau: float  # s


@generic
def drive(p, mass, v_d, e, v):
    """Driving force along one axis, N; e: desired direction and v: velocity along that axis."""


@drive.law(Absent)
def _no_drive(p, mass, v_d, e, v):
    return 0.0


@drive.law(Relaxation)
def _relaxation(p, mass, v_d, e, v):
    return mass * (1.0 / p.tau) * (v_d * e - v)


@generic
def drive_rate(p):
    """Rate at which the drive takes velocity, 1/s."""


@drive_rate.law(Absent)
def _no_drive_rate(p):
    return 0.0


@drive_rate.law(Relaxation)
def _relaxation_rate(p):
    return 1.0 / p.tau
