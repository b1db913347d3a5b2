"""Retargeting in: any humanoid rig's animation -> a :class:`Motion` of the canonical skeleton ``smpl24``.

1. ``stance`` understands the rig: ``roles`` finds which joint plays which role (names, the user's
   mapping, structure).
2. A constant rotation per joint carries the rig's bone axes to those of ``smpl24``: from a known standing
   pose (``alignment``) or, where there is none, from the animation (``calibration``).
   Pelvis and chest go by what hangs on them where their joints do not carry the body (``steady_trunk``).
3. The limbs' directions are copied exactly (``limbs``); trunk and neck of any length are resampled.
4. The hips follow the rig's hips, scaled by the ratio of the leg lengths, which makes the file's unit
   irrelevant (``placement``).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from motionrt.motion.kinematics import global_to_local
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, matrix_to_quaternion, quaternion_to_matrix, slerp
from motionrt.motion.skeleton import SMPL24, FloatArray
from motionrt.rigs.alignment import Alignments, role_rotations
from motionrt.rigs.clip import RigClip
from motionrt.rigs.limbs import swing_limbs
from motionrt.rigs.native import as_own_motion
from motionrt.rigs.placement import place_root
from motionrt.rigs.pose import RigPose
from motionrt.rigs.repairs import settle_head, unroll_feet
from motionrt.rigs.rest_bend import without_rest_bend
from motionrt.rigs.roles import assign_roles
from motionrt.rigs.stance import read_stance
from motionrt.rigs.steady_trunk import with_steady_trunk
from motionrt.rigs.tree import RigTree
from motionrt.untrusted.arguments import check_kind, checked_mapping


def to_smpl24(
    clip: RigClip, *, mapping: Mapping[str, str] | None = None, reference: FloatArray | None = None
) -> Motion:
    """Retarget ``clip`` to ``smpl24``.

    World directions of thighs, shanks, upper arms and forearms are those of the rig; feet that stand flat
    stay flat. The floor of the file stays the floor (``y = 0``): resting toes within 6 cm above it, or below
    it, are put on it; a clip that plays higher up stays there, see :meth:`Motion.grounded`.

    Args:
        clip: a humanoid rig in any unit, facing any way, Y or Z up.
        mapping: ``smpl24`` joint name -> rig joint name, for rigs that are not recognised; may be partial.
        reference: ``(J, 3, 3)`` local rotations of a pose in which the figure stands in a T, an A or with its
            arms down, if the file's rest pose is none. Ignored when it turns out not to be such a pose.

    Returns:
        A Motion with the clip's frames and fps.

    Raises:
        RigError: the rig is no humanoid, or joints are missing or ambiguous; the message says which and what
            to do.
    """
    check_kind(clip, RigClip, "clip", "a RigClip")
    given = checked_mapping(mapping, "mapping")
    own = as_own_motion(clip) if given is None else None
    mapping = {**clip.known, **(given or {})} or None
    if own is not None:
        return own
    poses = [clip.rest_rotations()] if reference is None else [reference, clip.rest_rotations()]
    roles = assign_roles(RigTree(clip), mapping)
    clip = without_rest_bend(clip, roles, reference)
    stance = read_stance(clip, mapping, poses, roles)
    motion, to_world = with_steady_trunk(clip, stance), stance.to_world
    turned = to_world @ _follow(motion, stance.alignments)
    world = RigPose(motion.positions @ to_world.T, motion.rotations, stance.roles)
    swing_limbs(turned, world)
    unroll_feet(turned, world)
    settle_head(turned)
    root = place_root(turned, world, clip.fps)
    local = global_to_local(turned, SMPL24.parents)
    return Motion(local.astype(np.float32), root.astype(np.float32), clip.fps)


def _follow(motion: RigPose, alignments: Alignments) -> Array:
    """Global target rotations ``(F, 24, 3, 3)`` in file axes; joints the rig lacks follow their parents."""
    joints = motion.roles.joints
    turned = np.empty((len(motion.positions), len(SMPL24), 3, 3))
    resampled = _resampled(motion, alignments)
    for target, role in enumerate(SMPL24.names):
        if role in resampled:
            turned[:, target] = resampled[role]
        elif role in joints and joints[role] in alignments:
            turned[:, target] = role_rotations(motion, alignments, joints[role])
        else:
            turned[:, target] = turned[:, SMPL24.parents[target]]
    return turned


def _resampled(motion: RigPose, alignments: Alignments) -> dict[str, Array]:
    """Spine and neck of the target from chains of any length, except joints that the user has mapped."""
    joints = motion.roles.joints
    trunk = [joints["pelvis"], *motion.roles.spine]
    out = {f"spine{k}": _between(motion, alignments, trunk, k / 3) for k in (1, 2, 3) if f"spine{k}" not in joints}
    chain = [trunk[-1], *motion.roles.neck]
    if "neck" not in joints:
        out["neck"] = _between(motion, alignments, chain, 0.5)
    out["head"] = _between(motion, alignments, chain, 1.0)
    return out


def _between(motion: RigPose, alignments: Alignments, chain: list[int], share: float) -> Array:
    """Rotation at ``share`` (0 to 1) of a chain, counted in joints; between two of them by slerp."""
    place = share * (len(chain) - 1)
    below = min(int(place + 1e-9), len(chain) - 1)
    weight = place - below
    lower = role_rotations(motion, alignments, chain[below])
    if weight < 1e-6:
        return lower
    upper = role_rotations(motion, alignments, chain[below + 1])
    start, end = matrix_to_quaternion(lower), matrix_to_quaternion(upper)
    return np.asarray(quaternion_to_matrix(slerp(start, end, np.full(len(start), weight))))
