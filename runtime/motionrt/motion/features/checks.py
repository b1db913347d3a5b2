"""Shape check shared by the feature vectors."""

from __future__ import annotations

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray


def checked_features(features: FloatArray, width: int) -> FloatArray:
    """``features`` as float32 ``(F, width)``; InvalidInputError for any other shape or for no frames."""
    x = np.asarray(features, dtype=np.float32)
    if x.ndim != 2 or x.shape[1] != width or not len(x):
        raise InvalidInputError(f"features must have the shape (frames >= 1, {width}), not {x.shape}")
    return x
