"""Retargeting out: a :class:`Motion` of ``smpl24`` onto a character of the user's own.

1. The rig is understood as on the way in (``stance``): roles, a standing pose, alignments, the vertical.
2. Its joints follow their counterparts; spines of other lengths share the turns (``drive``).
3. Hips and path are scaled by the length of the legs; legs are bent so that the toes stand where those of the source
   stand, on the rig's own soles (``legs``).
4. Twist bones take their share of a turn, fingers hang relaxed (``secondary``); what else has no counterpart (props,
   helpers) stays as it is at rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from motionrt.errors import InvalidInputError, RigError
from motionrt.limits import how_to_raise, limits
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.build import read_build
from motionrt.rigs.clip import RigClip
from motionrt.rigs.drive import drive
from motionrt.rigs.legs import knees_ahead, place_legs
from motionrt.rigs.root_motion import carry
from motionrt.rigs.secondary import relaxed, share_twists
from motionrt.rigs.stance import Stance, read_stance
from motionrt.rigs.target import Rig, RigMotion
from motionrt.rigs.tree import RigTree
from motionrt.untrusted.arguments import check_kind, checked_mapping

_ENOUGH = 30
"""Frames from which the animation of a rig may say how its joints are turned, if none of its poses does."""


def _hangs(clip: RigClip, stance: Stance, ankle: str) -> bool:
    """Whether a foot hangs on the shin, so that it can be driven by rotations alone."""
    joints = stance.roles.joints
    return RigTree(clip).is_above(joints[ankle.replace("ankle", "knee")], joints[ankle])


def to_rig(
    motion: Motion, rig: Rig, *, mapping: Mapping[str, str] | None = None, root_motion: bool | str = False
) -> RigMotion:
    """Retarget ``motion`` to ``rig``.

    The motion keeps its frame rate, its ground (y = 0) and the way it faces; its path is scaled by leg length, so
    strides fit the rig. Limbs point where those of the source point, except legs near the floor, which are bent so that
    standing toes stand: foot skate is that of the source.

    Args:
        motion: a motion of ``smpl24``.
        rig: see :func:`motionrt.formats.load_target`.
        mapping: ``smpl24`` joint name -> rig joint name, for rigs that are not recognised; may be partial.
        root_motion: ``True`` puts place on the floor and heading on the joint above the pelvis (Unreal's ``root``), or
            on the joint of that name, and leaves height and sway on the pelvis. Otherwise the pelvis has it all.

    Raises:
        RigError: the rig is no humanoid, has no known standing pose, or no joint that can travel; says what to do.
        InvalidInputError: another skeleton than ``smpl24``, or too many frames for so many joints.
    """
    check_kind(motion, Motion, "motion", "a Motion")
    check_kind(rig, Rig, "rig", "what load_target gave")
    check_kind(root_motion, (bool, str), "root_motion", "True, False or the name of a joint")
    given = checked_mapping(mapping, "mapping")
    if motion.skeleton != SMPL24:
        raise InvalidInputError("only motions of the smpl24 skeleton can be retargeted")
    if motion.frames * len(rig.clip.names) > limits().values:
        many = f"{motion.frames:,} frames of {len(rig.clip.names)} joints are too many"
        raise InvalidInputError(f"{many}: cut the motion; {how_to_raise('values')}")
    mapping = {**rig.clip.known, **(given or {})} or None
    stance = read_stance(rig.clip, mapping, rig.poses)
    off = [name for name in ("left_ankle", "right_ankle") if not _hangs(rig.clip, stance, name)]
    if off:
        raise RigError(f"{' and '.join(off)} of the rig hang on controls, not on the shins: bake it to plain bones")
    if stance.local is None and rig.clip.frames < _ENOUGH:
        raise RigError(
            "the rig has no known standing pose: neither its rest pose nor its first frame is a T- or A-pose;"
            " save it in its T-pose"
        )
    local = rig.clip.rest_rotations() if stance.local is None else stance.local
    source = motion.global_rotations()
    turned, bends = drive(source, rig.clip, stance, local), knees_ahead(source)
    del source  # the largest of all: long motions fill the memory
    build = read_build(rig.clip, stance, local)
    root = place_legs(turned, motion, bends, stance, build)
    share_twists(turned, rig.clip, stance, local)
    still = relaxed(rig.clip, stance, local)
    rotations, translations = carry(motion, turned, build.units * root, rig, stance, still, root_motion)
    clip = replace(
        rig.clip, rotations=rotations, translations=translations, fps=motion.fps, rest=local, up=rig.clip.up
    )  # fmt: skip
    up = stance.to_world[1].astype(np.float32)
    return RigMotion(clip, rig, build.units, up, build.units * build.sole, stance.to_world.astype(np.float32))
