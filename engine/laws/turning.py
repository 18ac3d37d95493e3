"""Rotation about the vertical."""

from typing import NamedTuple

from engine.dispatch import generic
from engine.laws.absent import Absent


class Turning(NamedTuple):
    """Bodies turn: I = shape m r^2 (Lin et al. 2016, Eqs. 5, 6); shape 0.4 for a sphere, 0.5 for a disc."""

    shape: float


@generic
def turns(p):
    """Whether bodies turn (a constant of the type)."""


@turns.law(Absent)
def _turns_not(p):
    return False


@turns.law(Turning)
def _turns(p):
    return True
