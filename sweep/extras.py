"""Libraries that only some people need, brought by an extra of the installation."""

import importlib
from typing import Any

from engine import BadInput


def load(module: str, extra: str, purpose: str) -> Any:
    """The module of this name.

    Parameters
    ----------
    module : its name, such as "pedpy"
    extra : the extra of jamsweep that installs it
    purpose : what it is wanted for, as the message begins

    Raises
    ------
    BadInput
        If it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        raise BadInput(f"{purpose} needs {module}, which is not installed: pip install 'jamsweep[{extra}]'") from None
