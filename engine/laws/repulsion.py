"""Social force: keeping a distance."""

import math
from typing import NamedTuple

from engine.dispatch import generic
from engine.exponential import exp
from engine.laws.absent import Absent


class Exponential(NamedTuple):
    """A exp(-gap/B), going on in overlap (Lin et al. 2016, Eq. 2; Helbing et al. 2000).

    `cut` is taken off, so that the force ends without a jump at the gap where it has fallen to `cut`.
    """

    A: float  # N
    B: float  # m
    cut: float = 0.0  # N


@generic
def social(p, gap):
    """Repulsion at a gap between two surfaces (negative in overlap), N."""


@social.law(Absent)
def _no_social(p, gap):
    return 0.0


@social.law(Exponential)
def _exponential(p, gap):
    return max(p.A * exp(gap * (-1.0 / p.B)) - p.cut, 0.0)


@generic
def social_stiffness(p):
    """Change of the force with the gap where two surfaces meet, N/m."""


@social_stiffness.law(Absent)
def _no_social_stiffness(p):
    return 0.0


@social_stiffness.law(Exponential)
def _exponential_stiffness(p):
    return p.A / p.B


@generic
def cut_at(p, tolerance):
    """The same law, ending without a jump where it has fallen to `tolerance` (N)."""


@cut_at.law(Absent)
def _nothing_to_cut(p, tolerance):
    return p


@cut_at.law(Exponential)
def _cut_exponential(p, tolerance):
    return p._replace(cut=tolerance)


@generic
def reach(p):
    """Largest gap at which a law that has been cut acts, m."""


@reach.law(Absent)
def _reaches_nobody(p):
    return 0.0


@reach.law(Exponential)
def _reach_of_exponential(p):
    return p.B * math.log(p.A / p.cut) if p.cut < p.A else 0.0
