"""Where the last bones of a skeleton end: no joint says so, but every importer wants a bone to have a length."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.motion.rotations import Array

# Of smpl24, metres from the joint in the rest pose: crown, toe tips, finger tips.
_SMPL24_TIPS = {
    "head": (0.0, 0.170, 0.0),
    "left_foot": (0.0, 0.0, 0.070),
    "right_foot": (0.0, 0.0, 0.070),
    "left_hand": (0.100, 0.0, 0.0),
    "right_hand": (-0.100, 0.0, 0.0),
}


def bone_tips(names: Sequence[str], parents: Sequence[int], offsets: Array) -> dict[int, Array]:
    """Ends ``(3,)`` of the bones of all joints without children, metres from the joint, in the axes of ``offsets``.

    Those of ``smpl24`` are known; any other bone goes on for half its parent's length.
    """
    inner = set(parents)
    ends = [joint for joint in range(len(names)) if joint not in inner and not names[joint].endswith("_end")]
    return {
        joint: np.array(_SMPL24_TIPS[names[joint]])
        if names[joint] in _SMPL24_TIPS
        else np.asarray(offsets[joint], dtype=np.float64) / 2
        for joint in ends
    }
