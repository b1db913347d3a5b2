"""Where a user's rig stands: its hips over its legs, its toes where those of the source are."""

from __future__ import annotations

import numpy as np

from motionrt.motion.batches import by_batches
from motionrt.motion.feet.two_bone import LEG_JOINTS, soft_limit, two_bone
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import FloatArray
from motionrt.motion.transforms import facing
from motionrt.rigs.alignment import SIDES
from motionrt.rigs.build import Build
from motionrt.rigs.drive import Turned
from motionrt.rigs.stance import Stance

_NEAR, _FAR = 0.15, 0.40  # metres above the floor: toes below are placed exactly, legs above only point the same way
_MAX_DROP = 0.06  # metres that the hips may sink where a standing foot is out of reach
_SMOOTH_S = 0.1


def place_legs(turned: Turned, motion: Motion, bends: Array, stance: Stance, build: Build) -> Array:
    """Bend the legs so that the toe joints are where those of ``motion`` are; returns the pelvis ``(F, 3)``, metres.

    The hips are as high above the ankles as they are in ``motion``, in the proportion of the legs; the soles stand on
    its floor. What a longer or shorter foot needs is taken up by the hips, which stay over the middle of the foot.

    Args:
        turned: global rotations of the rig, Y up; those of hips and knees are changed.
        motion: the source, ``smpl24``.
        bends: ``(F, 2, 3)`` which way its knees bend: :func:`knees_ahead`.
        stance: the rig.
        build: its measures.
    """
    joints = stance.roles.joints
    pelvis = turned[joints["pelvis"]]
    hips, wanted = _hip_centres(motion, build), _ankles(motion, turned, stance, build)
    root = hips - pelvis @ build.hips.mean(axis=0)
    chains = _chains(root, turned, stance, build)
    target = chains[:, :, 2] + _weights(motion)[..., None] * (wanted - chains[:, :, 2])
    drop = _drop(chains, target, motion)
    root[:, 1] -= drop
    chains[..., 1] -= drop[:, None, None]
    uppers = [[joints[f"{side}_{part}"] for part in ("hip", "knee")] for side in SIDES]

    def bend(chain: Array, aim: Array, ahead: Array, *legs: Array) -> Array:
        rotations = np.stack(legs, axis=1).reshape(-1, 2, 2, 3, 3)
        return two_bone(chain, rotations, aim, ahead)[1]

    bent = by_batches(bend, chains, target, bends, *(turned[joint] for pair in uppers for joint in pair))
    for side, pair in enumerate(uppers):
        for part, joint in enumerate(pair):
            turned[joint] = bent[:, side, part].astype(np.float32)
    return np.asarray(root)


def knees_ahead(turned: FloatArray) -> Array:
    """``(F, 2, 3)``: which way thighs of ``smpl24`` face, of global rotations ``(F, 24, 3, 3)``."""
    return turned[:, [leg[0] for leg in LEG_JOINTS]][..., 2].astype(np.float64)


def _hip_centres(motion: Motion, build: Build) -> Array:
    centres = motion.positions()[:, [leg[0] for leg in LEG_JOINTS]].mean(axis=1, dtype=np.float64)
    lift = np.array([0.0, build.rise + build.sole, 0.0])
    return np.asarray(centres + lift - build.ahead * facing(motion))


def _ankles(motion: Motion, turned: Turned, stance: Stance, build: Build) -> Array:
    """``(F, 2, 3)``: where the ankles must be for the toe joints to be where those of ``motion`` are."""
    toes = motion.positions()[:, [leg[3] for leg in LEG_JOINTS]] + np.array([0, build.sole, 0])
    feet = [turned[stance.roles.joints[f"{side}_ankle"]] @ build.feet[i] for i, side in enumerate(SIDES)]
    return np.asarray(toes - np.stack(feet, axis=1))


def _chains(root: Array, turned: Turned, stance: Stance, build: Build) -> Array:
    """Hip, knee and ankle joints ``(F, 2, 3, 3)`` as the rotations put them."""
    joints, chains = stance.roles.joints, []
    for i, side in enumerate(SIDES):
        hip = root + turned[joints["pelvis"]] @ build.hips[i]
        knee = hip + turned[joints[f"{side}_hip"]] @ build.thighs[i]
        chains.append(np.stack([hip, knee, knee + turned[joints[f"{side}_knee"]] @ build.shanks[i]], axis=1))
    return np.stack(chains, axis=1)


def _weights(motion: Motion) -> Array:
    """``(F, 2)``: 1 near the floor, 0 high above it."""
    height = motion.positions()[:, [leg[3] for leg in LEG_JOINTS], 1]
    share = np.clip((_FAR - height) / (_FAR - _NEAR), 0, 1)
    return np.asarray(share**2 * (3 - 2 * share))


def _drop(chains: Array, target: Array, motion: Motion) -> Array:
    """``(F,)`` metres that the hips sink so that feet near the floor are in reach: smooth, and never too little."""
    hip, knee, ankle = chains[..., 0, :], chains[..., 1, :], chains[..., 2, :]
    full = np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(ankle - knee, axis=-1)
    reach = soft_limit(np.linalg.norm(ankle - hip, axis=-1), full)
    aim = target - hip
    height = np.sqrt(np.maximum(reach**2 - aim[..., 0] ** 2 - aim[..., 2] ** 2, 0))
    need = np.clip(((-aim[..., 1] - height) * _weights(motion)).max(axis=1), 0, _MAX_DROP)
    half = max(1, round(_SMOOTH_S * motion.fps))
    most = np.lib.stride_tricks.sliding_window_view(np.pad(need, half), 2 * half + 1).max(axis=1)
    kernel = np.hanning(2 * half + 3)[1:-1]
    return np.convolve(np.pad(most, half, mode="edge"), kernel / kernel.sum(), mode="valid")
