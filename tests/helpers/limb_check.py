"""Which way limbs point, by SciPy one joint after the other: what readers and retargeting are held against."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion

BONES = [
    (SMPL24.index(f"{side}_{a}"), SMPL24.index(f"{side}_{b}"))
    for side in ("left", "right")
    for a, b in (("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"))
]


def places_of(motion: Motion) -> np.ndarray:
    """Joint positions ``(F, 24, 3)`` by SciPy."""
    places, turns = np.zeros((motion.frames, 24, 3)), list[Rotation]()
    for joint, parent in enumerate(SMPL24.parents):
        turn = Rotation.from_matrix(motion.rotations[:, joint].astype(float))
        offset = SMPL24.offsets[joint].astype(float)
        places[:, joint] = motion.root if parent < 0 else places[:, parent] + turns[parent].apply(offset)
        turns.append(turn if parent < 0 else turns[parent] * turn)
    return places


def limbs(places: np.ndarray, bones: list[tuple[int, int]] = BONES) -> np.ndarray:
    """Unit vectors ``(F, 8, 3)``."""
    ways = np.stack([places[:, lower] - places[:, upper] for upper, lower in bones], axis=1)
    return ways / np.linalg.norm(ways, axis=-1, keepdims=True)


def furthest(found: np.ndarray, truth: np.ndarray) -> float:
    """The largest mean angle in degrees of a limb, after the turn about the vertical that fits best."""
    flat = np.einsum("fbi,fbj->ij", found[..., [0, 2]], truth[..., [0, 2]])
    yaw = np.arctan2(flat[1, 0] - flat[0, 1], flat[0, 0] + flat[1, 1])
    turned = found @ Rotation.from_euler("y", yaw).as_matrix().T
    return float(np.degrees(np.arccos(np.clip((turned * truth).sum(-1), -1, 1))).mean(axis=0).max())
