"""Which models and integrators are put under stress, and how their numbers are changed without changing their laws.

A kernel is compiled for the types of a model's laws. So what is switched off here is switched off by numbers:
nobody is driven where tau is 1e30 s, and nothing is rubbed off where mu is 0.
"""

from collections.abc import Iterable

from engine import Model, models
from engine.kernel.integrators import INTEGRATORS
from engine.models import validated

FRICTION = (("kept", "kinetic"), ("kept", "kept"), ("reset", "reset"))  # of `models.lin_dem`: persons, walls
OTHERS = ("parisi_dorso", "helbing_2000", "lambda_anisotropic")  # functions of `engine.models` without arguments
MODELS: dict[str, Model] = {f"lin_dem ({a}, {b})": models.lin_dem(friction=a, wall_friction=b) for a, b in FRICTION} | {
    name: getattr(models, name)() for name in OTHERS if hasattr(models, name)
}

Kind = tuple[str, str]  # names of a model and of an integrator
KINDS: tuple[Kind, ...] = tuple((model, integrator) for integrator in INTEGRATORS for model in MODELS)
FEW: tuple[Kind, ...] = tuple(  # each model and each integrator once at least, for the quick form
    (list(MODELS)[k % len(MODELS)], list(INTEGRATORS)[k % len(INTEGRATORS)])
    for k in range(max(len(MODELS), len(INTEGRATORS)))
)

UNDRIVEN = {"tau": 1e30}  # s
ISOTROPIC = {"phi": 0.0, "lam": 1.0}
LOSSLESS = {"g_n": 0.0, "g_t": 0.0, "mu": 0.0, "kappa": 0.0}
STIFFNESSES, DAMPINGS = ("k_n", "k_t"), ("g_n", "g_t")


def with_values(model: Model, values: dict[str, float]) -> Model:
    """The model with these values in all laws that have parameters of these names."""
    return validated(Model(*(law._replace(**_own(law, values)) for law in model)))


def scaled(model: Model, names: Iterable[str], factor: float) -> Model:
    """The model with the parameters of these names multiplied in all laws."""
    chosen = set(names)
    return validated(
        Model(*(law._replace(**{n: v * factor for n, v in law._asdict().items() if n in chosen}) for law in model))
    )


def passive(model: Model) -> Model:
    """Nobody is driven, and everybody is pushed alike: energy can only fall."""
    return with_values(model, UNDRIVEN | ISOTROPIC)


def lossless(model: Model) -> Model:
    """As `passive`, without damping and friction: energy stays."""
    return with_values(model, UNDRIVEN | ISOTROPIC | LOSSLESS)


def is_passive(model: Model) -> bool:
    """Whether nobody is driven and pushes are mutual."""
    return with_values(model, UNDRIVEN | ISOTROPIC) == model


def is_lossless(model: Model) -> bool:
    """Whether energy stays."""
    return with_values(model, UNDRIVEN | ISOTROPIC | LOSSLESS) == model


def _own(law: object, values: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in values.items() if name in getattr(law, "_fields", ())}
