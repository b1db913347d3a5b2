"""Where the joints of a rig are, by 4 x 4 matrices one joint after the other: a check on everything cleverer."""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array
from motionrt.rigs.clip import RigClip


def joint_transforms(clip: RigClip) -> Array:
    """Global transforms ``(F, J, 4, 4)`` of all joints, file units and axes; shares no code with the retargeting."""
    frames, joints = clip.rotations.shape[:2]
    local = np.zeros((frames, joints, 4, 4))
    local[..., 3, 3] = 1.0
    local[..., :3, :3] = clip.rotations
    local[..., :3, 3] = clip.translations
    out = np.empty_like(local)
    for joint, parent in enumerate(clip.parents):
        out[:, joint] = local[:, joint] if parent < 0 else np.matmul(out[:, parent], local[:, joint])
    return out


def angles_between(one: Array, two: Array) -> Array:
    """Angles in degrees between vectors ``(..., 3)``; 0 where either has no length."""
    sizes = np.linalg.norm(one, axis=-1) * np.linalg.norm(two, axis=-1)
    cosine = (one * two).sum(axis=-1) / np.where(sizes > 0, sizes, 1)
    return np.asarray(np.where(sizes > 0, np.degrees(np.arccos(np.clip(cosine, -1, 1))), 0.0))
