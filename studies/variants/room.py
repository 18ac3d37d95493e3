"""The variants that are compared: what the paper leaves open, as keywords of `lin_room`."""

from typing import Any

from engine import Scenario, rooms
from engine.errors import require

DEFAULT = "RK"
KEPT = {"friction": "kept", "wall_friction": "kept"}
VARIANTS: dict[str, dict[str, Any]] = {
    "RK": {},
    "RS": {"wall_friction": "coulomb"},
    "W": KEPT,
    "W01": KEPT | {"wall_mu": 0.1},
    "R02": {"wall_friction": "reset", "wall_mu": 0.2},
    "WK": {"friction": "kept"},
    "WR": {"wall_friction": "reset"},
    "B": KEPT | {"wall_social": False},
    "RK-iso": {"phi": 0.0},
    "RK-disc": {"inertia": "disc"},
    "RK-wall": {"wall_social": False},
    "RK-A": {"wall_A": 300.0},
    "RK-dt": {"numerics": "paper"},
    "KK": {"friction": "kinetic"},
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
