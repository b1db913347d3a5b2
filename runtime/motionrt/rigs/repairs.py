"""What no body does but mocap solvers let happen: feet rolled onto their backs, heads upside down on the
neck.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, normalise
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.alignment import SIDES
from motionrt.rigs.pose import RigPose

_HEAD_LIMIT = float(np.cos(np.deg2rad(110.0)))


def unroll_feet(turned: Array, world: RigPose) -> None:
    """Turn feet that lie on their back about their length: no ankle rolls over, but mocap solvers do let it.

    The toes stay where they are; only the sole comes back down. (Several CMU trials hold the foot so for
    seconds.)
    """
    for side in SIDES:
        if f"{side}_foot" not in world.roles.joints:
            continue
        ankle, toe, knee = (SMPL24.index(f"{side}_{part}") for part in ("ankle", "foot", "knee"))
        rolled = (turned[:, ankle, :, 0] * turned[:, knee, :, 0]).sum(-1) < -0.2
        bone = normalise(world.bone(f"{side}_ankle", f"{side}_foot"))[rolled]
        half_turn = 2 * bone[:, :, None] * bone[:, None, :] - np.eye(3)
        for joint in (ankle, toe):
            turned[rolled, joint] = half_turn @ turned[rolled, joint]


def settle_head(turned: Array) -> None:
    """Let the head go with the neck in frames in which it is turned more than 110 degrees against it, in
    place.
    """
    neck, head = SMPL24.index("neck"), SMPL24.index("head")
    trace = (turned[:, neck] * turned[:, head]).sum((-2, -1))
    broken = (trace - 1) / 2 < _HEAD_LIMIT
    turned[broken, head] = turned[broken, neck]
