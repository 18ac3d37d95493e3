"""Vision: who in front weighs more."""

from typing import NamedTuple

from engine.dispatch import generic
from engine.laws.absent import Absent


class Cosine(NamedTuple):
    """1 + phi cos(beta) (Lin et al. 2016, Eq. 2)."""

    phi: float


class Lambda(NamedTuple):
    """lambda + (1 - lambda)(1 + cos(beta))/2 (text of Lin et al. 2016; FDS+Evac, CrowdDMX)."""

    lam: float


@generic
def vision(p, cos_beta):
    """Weight of the social force; beta: angle between the desired direction and that to the other person."""


@vision.law(Absent)
def _all_round(p, cos_beta):
    return 1.0


@vision.law(Cosine)
def _cosine(p, cos_beta):
    return 1.0 + p.phi * cos_beta


@vision.law(Lambda)
def _lambda(p, cos_beta):
    return p.lam + (1.0 - p.lam) * (1.0 + cos_beta) / 2.0


@generic
def looks(p):
    """Whether the vision depends on the angle (a constant of the law's type)."""


@looks.law(Absent)
def _looks_not(p):
    return False


@looks.law(Cosine, Lambda)
def _looks(p):
    return True
