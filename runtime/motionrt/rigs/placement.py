"""Where the target stands: root translation scaled to its size, on the floor of the file."""

from __future__ import annotations

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.kinematics import fk, global_to_local
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.alignment import SIDES
from motionrt.rigs.pose import RigPose

_NEAR_FLOOR = 0.05
"""Toes up to this height in metres above their lowest may be standing ..."""

_RESTING = 0.25
"""... if they move slower than this, metres per second."""

_RIG_DIFFERENCE = 0.06
"""Up to this height in metres above zero, resting toes are taken to stand on the floor."""

_OWN_HEIGHT = 0.08
"""Metres at the size of the target up to which a rig's own toe joints are on the floor of the file."""


def place_root(turned: Array, world: RigPose, fps: float) -> Array:
    """Pelvis positions ``(F, 3)`` in metres.

    Args:
        turned: global target rotations ``(F, 24, 3, 3)``, Y up.
        world: the rig, Y up, file units.
        fps: frames per second.
    """
    scale = leg_scale(world)
    rest = SMPL24.rest_positions.astype(np.float64)
    hips = 0.5 * (rest[SMPL24.index("left_hip")] + rest[SMPL24.index("right_hip")])
    root = scale * world.hip_centre() - turned[:, 0] @ hips
    positions, _ = fk(global_to_local(turned, SMPL24.parents), root, SMPL24.offsets, SMPL24.parents)
    root[:, 1] -= floor_offset(positions, fps, _stands_on_zero(world, scale))
    return np.asarray(root)


def _stands_on_zero(world: RigPose, scale: float) -> bool:
    """Whether the rig's own toes come down to the floor of the file, however high its feet are."""
    toes = [world.at(f"{side}_foot")[:, 1] for side in SIDES if f"{side}_foot" in world.roles.joints]
    return bool(toes) and abs(scale * float(np.percentile(np.min(toes, axis=0), 2))) < _OWN_HEIGHT


def leg_scale(world: RigPose) -> float:
    """Metres of the target per unit of the rig: the ratio of the leg lengths, along the bones."""
    source = target = 0.0
    for side in SIDES:
        for upper, lower in (("hip", "knee"), ("knee", "ankle")):
            bone = world.bone(f"{side}_{upper}", f"{side}_{lower}")
            source += float(np.median(np.linalg.norm(bone, axis=-1)))
            target += float(np.linalg.norm(SMPL24.offsets[SMPL24.index(f"{side}_{lower}")]))
    if not source > 1e-9:
        raise RigError("the legs of the rig have no length")
    return target / source


def floor_offset(positions: Array, fps: float, on_zero: bool = False) -> float:
    """Height in metres at which resting feet stand, if it is a matter of the rig and not of the motion.

    Rigs differ in the height of ankles and toe joints above the sole, and captures in where they put zero.
    The toes' usual height while they rest near their lowest point is taken for the floor if it is below zero
    (nobody walks under the floor) or a little above; clips that play well above the floor, on a ladder or a
    stool, are left there.

    Args:
        positions: target joints ``(F, 24, 3)`` on the floor of the file, metres.
        fps: frames per second.
        on_zero: whether the rig itself is known to stand on zero.
    """
    toes = positions[:, [SMPL24.index("left_foot"), SMPL24.index("right_foot")]]
    height = toes[..., 1]
    speed = np.linalg.norm(np.gradient(toes, axis=0), axis=-1) * fps if len(toes) > 1 else np.zeros(height.shape)
    low = height < np.percentile(height.min(axis=1), 2) + _NEAR_FLOOR
    resting = low & (speed < _RESTING)
    floor = float(np.median(height[resting if resting.any() else low]))
    return floor if on_zero or floor < _RIG_DIFFERENCE else 0.0
