"""One run of a crowd that leaves a room.

>>> from engine import rooms, simulate
>>> run = simulate(rooms.lin_room(v_d=1.0, N=200, seed=1))
"""

from engine import fingerprint

FINGERPRINT = fingerprint.fingerprint()
fingerprint.use_own_folder(FINGERPRINT)

from engine import models, rooms  # noqa: E402  the cache folder must be set before the first kernel
from engine.crowd import Crowd  # noqa: E402
from engine.errors import BadInput  # noqa: E402
from engine.kernel import laws  # noqa: E402
from engine.models import Model  # noqa: E402
from engine.options import Options, with_options  # noqa: E402
from engine.scenario import Scenario  # noqa: E402
from engine.scene import Exit, Scene  # noqa: E402
from engine.simulate import OUTCOMES, Run, Samples, simulate  # noqa: E402

__all__ = [
    "FINGERPRINT",
    "OUTCOMES",
    "BadInput",
    "Crowd",
    "Exit",
    "Model",
    "Options",
    "Run",
    "Samples",
    "Scenario",
    "Scene",
    "laws",
    "models",
    "rooms",
    "simulate",
    "with_options",
]
