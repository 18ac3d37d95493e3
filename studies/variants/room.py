"""The variants that are compared: what the paper leaves open, as keywords of `lin_room`."""

from typing import Any

from engine import Scenario, rooms
from engine.errors import require

DEFAULT = "kept 0.3"
RESET = {"friction": "reset", "mu": 0.5}
KEPT_WALLS = {"mu": 0.5, "wall_friction": "kept"}
VARIANTS: dict[str, dict[str, Any]] = {
    "kept 0.3": {},
    "kept 0.2": {"mu": 0.2},
    "kept 0.25": {"mu": 0.25},
    "kept 0.4": {"mu": 0.4},
    "kept 0.5": {"mu": 0.5},
    "reset": RESET,
    "reset to zero (1 ms)": RESET | {"friction": "reset_to_zero", "numerics": "paper"},
    "reset / Coulomb": RESET | {"wall_friction": "coulomb"},
    "reset / reset": RESET | {"wall_friction": "reset"},
    "reset / reset 0.2": RESET | {"wall_friction": "reset", "wall_mu": 0.2},
    "kept 0.5 / kept": KEPT_WALLS,
    "kept 0.5 / kept 0.1": KEPT_WALLS | {"wall_mu": 0.1},
    "kept 0.5 / kept, no social force": KEPT_WALLS | {"wall_social": False},
    "walls without social force": {"wall_social": False},
    "walls of A = 300 N": {"wall_A": 300.0},
    "isotropic": {"phi": 0.0},
    "discs": {"inertia": "disc"},
    "kinetic 0.5": {"friction": "kinetic", "mu": 0.5},
    "paper's numerics": {"numerics": "paper"},
}


def variant_room(variant: str, v_d: float, N: int, seed: int, A: float = 300.0, rotation: bool = True) -> Scenario:
    """The room of Lin, Ma & Lo (2016) under one of `VARIANTS`.

    Parameters
    ----------
    variant : str
        A key of `VARIANTS`.
    v_d : float
        Desired speed of everybody, m/s.
    N : int
        Number of persons.
    seed : int
        Number of the run; the same seed means the same bodies and positions in all variants.
    A : float
        Strength of the social force, N.
    rotation : bool
        Whether bodies rotate (Fig. 5 has runs in which they do not).

    Raises
    ------
    BadInput
        If the variant is not known, or `lin_room` refuses a parameter.
    """
    require(variant in VARIANTS, "variant", repr(variant), "is not known", f"choose one of {', '.join(VARIANTS)}")
    still = {} if rotation else {"inertia": "none"}
    return rooms.lin_room(v_d=v_d, N=N, seed=seed, A=A, **(VARIANTS[variant] | still))
