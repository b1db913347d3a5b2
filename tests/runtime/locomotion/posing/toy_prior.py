"""A pose prior without a network: every latent is one joint angle, left and right alike, float64 and smooth."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24

_SIDE = (
    "hip x",
    "hip y",
    "hip z",
    "knee x",
    "ankle x",
    "collar z",
    "shoulder x",
    "shoulder y",
    "shoulder z",
    "elbow y",
)
_MIDDLE = (
    *("pelvis x", "pelvis z", "spine1 x", "spine1 y", "spine1 z", "spine2 x", "spine2 y", "spine2 z"),
    *("spine3 x", "spine3 y", "neck x", "head y"),
)
ANGLES = (*(f"{side}_{angle}" for side in ("left", "right") for angle in _SIDE), *_MIDDLE)
RADIANS = 0.5  # per unit of a latent


class ToyPrior:
    """32 angles; the mean stands with its arms down."""

    latent = len(ANGLES)

    def decode(self, latents: np.ndarray) -> np.ndarray:
        vectors = np.zeros((len(latents), 24, 3))
        for column, angle in enumerate(ANGLES):
            joint, axis = angle.split()
            i = "xyz".index(axis)
            sign = -1.0 if joint.startswith("right_") and i else 1.0
            vectors[:, SMPL24.index(joint), i] += sign * RADIANS * np.asarray(latents, np.float64)[:, column]
        down = Rotation.from_euler("z", [[-1.2], [1.2]])
        rotations = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(-1, 24, 3, 3)
        for side, turn in zip(("left", "right"), down.as_matrix(), strict=True):
            joint = SMPL24.index(f"{side}_shoulder")
            rotations[:, joint] = turn @ rotations[:, joint]
        return rotations

    @cached_property
    def starts(self) -> tuple[np.ndarray, np.ndarray]:
        half = np.random.default_rng(0).normal(size=(20, self.latent)) * 0.5
        latents = np.concatenate([np.zeros((1, self.latent)), half, [mirrored_latent(row) for row in half]])
        return latents, np.stack([positions_by_scipy(pose, np.zeros(3)) for pose in self.decode(latents)])


def mirrored_latent(latent: np.ndarray) -> np.ndarray:
    """The latent of the mirror image."""
    swap = {"left": "right", "right": "left"}
    out = np.empty_like(latent)
    for column, angle in enumerate(ANGLES):
        side, _, rest = angle.partition("_")
        if side in swap:
            out[ANGLES.index(f"{swap[side]}_{rest}")] = latent[column]
        else:
            out[column] = latent[column] * (1.0 if angle.endswith("x") else -1.0)
    return out


def positions_by_scipy(rotations: np.ndarray, root: np.ndarray) -> np.ndarray:
    """Joint positions (24, 3) of one pose (24, 3, 3), by SciPy's rotations along every chain."""
    out = np.empty((24, 3))
    for joint in range(24):
        chain = [joint]
        while SMPL24.parents[chain[-1]] >= 0:
            chain.append(SMPL24.parents[chain[-1]])
        place, turn = np.array(root, np.float64), Rotation.identity()
        for at, below in zip(chain[::-1], [*chain[::-1][1:], None], strict=True):
            turn = turn * Rotation.from_matrix(rotations[at])
            if below is not None:
                place = place + turn.apply(SMPL24.offsets[below])
        out[joint] = place
    return out
