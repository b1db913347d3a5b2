"""Any humanoid armature as a rig of motionrt's: Mixamo, Rigify's meta-rig, Unreal's mannequin, your own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np

from . import axes

if TYPE_CHECKING:
    from motionrt import Motion
    from motionrt.rigs.clip import RigClip
    from motionrt.rigs.target import Rig, RigMotion

_SAME = 1e-5


class _Armature:
    """Where a rig of motionrt's keeps its file; keys are written instead."""

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """Not a file."""
        raise NotImplementedError(f"{motion} is an armature of this Blender: export it to {path} from there")


def keys(armature: bpy.types.Object, motion: Motion) -> list[tuple[str, str, np.ndarray]]:
    """(bone, channel, values (F, N)) for the bones that move; fingers, twist bones and props stay as they are."""
    shown = motion.retarget_to(rig_of(armature)).clip
    rests, offsets = _rest(armature)
    out = []
    for joint, name in enumerate(shown.names):
        turns = rests[joint].T @ shown.rotations[:, joint].astype(np.float64)
        moves = (shown.translations[:, joint] - offsets[joint]) @ rests[joint]
        if np.abs(turns - np.eye(3)).max() > _SAME:
            out.append((name, "rotation_quaternion", axes.quaternions(turns)))
        if np.abs(moves).max() > _SAME * np.abs(offsets).max():
            out.append((name, "location", moves))
    return out


def motion(armature: bpy.types.Object, poses: np.ndarray, fps: float) -> Motion:
    """What poses ``(F, J, 4, 4)`` of the bones, in the armature, mean for ``smpl24``."""
    from motionrt.rigs.retarget_in import to_smpl24

    parents = _parents(armature)
    local = poses.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            local[:, joint] = np.linalg.inv(poses[:, parent]) @ poses[:, joint]
    clip = _clip(armature, local[:, :, :3, :3], local[:, :, :3, 3], fps)
    return to_smpl24(clip, reference=clip.rest)


def metres(armature: bpy.types.Object, point: np.ndarray) -> np.ndarray:
    """A point in the armature in metres of ``smpl24``, Y up."""
    from motionrt.rigs.build import read_build
    from motionrt.rigs.stance import read_stance

    rig = rig_of(armature)
    stance = read_stance(rig.clip, None, rig.poses)
    local = rig.clip.rest_rotations() if stance.local is None else stance.local
    return stance.to_world @ point / read_build(rig.clip, stance, local).units


def rig_of(armature: bpy.types.Object) -> Rig:
    """The armature at rest."""
    from motionrt.rigs.target import Rig

    rests, offsets = _rest(armature)
    clip = _clip(armature, rests[None], offsets[None], 30.0)
    return Rig(clip, [clip.rest_rotations()], [True] * len(rests), _Armature())


def _clip(armature: bpy.types.Object, rotations: np.ndarray, translations: np.ndarray, fps: float) -> RigClip:
    from motionrt.rigs.clip import RigClip

    names, parents = tuple(armature.data.bones.keys()), tuple(_parents(armature))
    rests, offsets = (part.astype(np.float32) for part in _rest(armature))
    turns, moves = rotations.astype(np.float32), translations.astype(np.float32)
    return RigClip(names, parents, offsets, turns, moves, fps, rest=rests)


def _parents(armature: bpy.types.Object) -> list[int]:
    bones = armature.data.bones
    return [bones.find(bone.parent.name) if bone.parent else -1 for bone in bones]


def _rest(armature: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Rotations ``(J, 3, 3)`` and translations ``(J, 3)`` of the bones at rest, each in its parent."""
    bones = armature.data.bones
    whole = [
        bone.parent.matrix_local.inverted() @ bone.matrix_local if bone.parent else bone.matrix_local for bone in bones
    ]
    local = np.array(whole, dtype=np.float64)
    return local[:, :3, :3], local[:, :3, 3]
