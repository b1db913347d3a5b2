"""A decoder with several frames to a token leaves small jumps between tokens; here they are smoothed."""

from __future__ import annotations

import numpy as np

from motionrt.motion.skeleton import FloatArray

DEVIATION = 0.8  # frames: as smooth as recordings are (jerk), and nothing slower than 5 Hz is touched


def smoothed(features: FloatArray, deviation: float = DEVIATION) -> FloatArray:
    """Features ``(F, D)`` convolved in time with a normal distribution of ``deviation`` frames; the ends stay."""
    reach = min(int(np.ceil(3.0 * deviation)), len(features) - 1)
    if reach < 1:
        return features
    before = 2.0 * features[0] - features[reach:0:-1]  # reflected in the end points, so that these do not move
    after = 2.0 * features[-1] - features[-2 : -reach - 2 : -1]
    longer = np.concatenate([before, features, after])
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    weights /= weights.sum()
    smooth = np.zeros_like(features)
    for first, weight in enumerate(weights.astype(features.dtype)):
        smooth += weight * longer[first : first + len(features)]
    return smooth
