"""Anisotropy of the social force: who in front weighs more."""

from typing import Annotated, NamedTuple

from engine.kernel.dispatch import generic
from engine.kernel.laws.absent import Absent
from engine.kernel.laws.parameters import between


class Cosine(NamedTuple):
    """1 + phi cos(beta) (Lin et al. 2016, Eq. 2)."""

    phi: Annotated[float, between(-1.0, 1.0, "1", "anisotropy; beyond, those in the back would attract")]


class Lambda(NamedTuple):
    """lambda + (1 - lambda)(1 + cos(beta))/2 (text of Lin et al. 2016; FDS+Evac, CrowdDMX)."""

    lam: Annotated[float, between(0.0, 1.0, "1", "weight of those straight behind")]


@generic()
def anisotropy(p, cos_beta):
    """Weight of the social force; beta: angle between the desired direction and that to the other person."""


@anisotropy.law(Absent)
def _isotropic(p, cos_beta):
    return 1.0


@anisotropy.law(Cosine)
def _cosine(p, cos_beta):
    return 1.0 + p.phi * cos_beta


@anisotropy.law(Lambda)
def _lambda_(p, cos_beta):
    return p.lam + (1.0 - p.lam) * (1.0 + cos_beta) / 2.0
