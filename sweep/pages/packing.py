"""Numbers as text of a page: whole multiples, differences, bytes in planes, zlib, base64."""

import base64
import zlib
from typing import Any

import numpy as np

NOTHING = -(2**31)  # where there is no number


def packed(multiples: np.ndarray, differences: bool = False) -> dict[str, Any]:
    """Whole numbers as a page holds them; `assets/decode.js` reads them back.

    Parameters
    ----------
    multiples : int32 of any shape
    differences : keep each number but the first of a row (last axis) as the difference from the one before,
        modulo 2^32

    Returns
    -------
    dict with `shape`, `differences` and `base64`: zlib of the bytes, all lowest ones first, of the numbers in zigzag
    code (0, -1, 1, -2 ... as 0, 1, 2, 3 ...), in which small differences have three bytes of zero
    """
    numbers = np.ascontiguousarray(multiples, dtype=np.int32)
    if differences and numbers.size:
        numbers = np.diff(numbers.view(np.uint32), axis=-1, prepend=np.uint32(0)).view(np.int32)
    zigzag = ((numbers << 1) ^ (numbers >> 31)).astype("<u4")
    planes = zigzag.reshape(-1, 1).view(np.uint8).T.tobytes()
    text = base64.b64encode(zlib.compress(planes, 9)).decode("ascii")
    return {"shape": list(numbers.shape), "differences": differences, "base64": text}


def in_multiples(values: np.ndarray, resolution: float) -> np.ndarray:
    """Whole multiples of the resolution as int32; NOTHING for what is not finite."""
    good = np.isfinite(values)
    return np.where(good, np.rint(np.where(good, values, 0.0) / resolution), NOTHING).astype(np.int32)
