"""One run of a crowd that leaves a room.

>>> from engine import rooms, simulate
>>> run = simulate(rooms.lin_room(v_d=1.0, N=200, seed=1))
"""

from engine import cache

FINGERPRINT = cache.fingerprint()
cache.use_own_folder(FINGERPRINT)

from engine import laws, models, rooms  # noqa: E402  the cache folder must be set before the first kernel
from engine.crowd import Crowd  # noqa: E402
from engine.errors import BadInput  # noqa: E402
from engine.models import Model  # noqa: E402
from engine.scenario import Numerics, Record, Scenario, Stopping  # noqa: E402
from engine.scene import Exit, Scene  # noqa: E402
from engine.simulate import OUTCOMES, Run, Samples, simulate  # noqa: E402

__all__ = [
    "FINGERPRINT",
    "OUTCOMES",
    "BadInput",
    "Crowd",
    "Exit",
    "Model",
    "Numerics",
    "Record",
    "Run",
    "Samples",
    "Scenario",
    "Scene",
    "Stopping",
    "laws",
    "models",
    "rooms",
    "simulate",
]
