"""From an ASF skeleton and AMC channels to a :class:`RigClip`."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.formats.acclaim.asf import AsfSkeleton, Bone
from motionrt.motion.rotations import euler_to_matrix
from motionrt.rigs.clip import RigClip

Values = npt.NDArray[np.float64]


def build_rig(skeleton: AsfSkeleton, channels: dict[str, Values], degrees: bool, fps: float) -> RigClip:
    """The clip of the channels ``(F, n)`` of every moving bone; conventions as in :func:`read_amc`."""
    bones = list(skeleton.bones.values())
    parents = [list(skeleton.bones).index(bone.parent) if bone.parent else -1 for bone in bones]
    ends = [j for j in range(len(bones)) if j not in parents]
    frames = len(next(iter(channels.values())))
    starts = [skeleton.root_position] + [bones[p].direction * bones[p].length for p in parents[1:]]
    tips = [bones[j].direction * bones[j].length for j in ends]
    offsets = np.array(starts + tips)
    rotations = np.empty((frames, len(offsets), 3, 3), dtype=np.float32)
    rotations[:] = np.eye(3, dtype=np.float32)
    translations = np.tile(offsets, (frames, 1, 1))
    for j, bone in enumerate(bones):
        if bone.name in channels:
            values = channels[bone.name]
            rotations[:, j] = _bone_rotation(bone, values, degrees)
            translations[:, j] += _bone_translation(bone, values)
    return RigClip(
        names=tuple(bone.name for bone in bones) + tuple(f"{bones[j].name}_end" for j in ends),
        parents=tuple(parents) + tuple(ends),
        offsets=offsets.astype(np.float32),
        rotations=rotations,
        translations=translations.astype(np.float32),
        fps=fps,
        up="y",
        metres_per_unit=skeleton.metres_per_unit,
    )


def _bone_frame(bone: Bone) -> Values:
    """``C``, the bone's own axes: turns about fixed axes in the order listed, so intrinsically in reverse."""
    angles = [bone.axis["XYZ".index(axis)] for axis in bone.axis_order]
    return np.asarray(euler_to_matrix(angles[::-1], bone.axis_order[::-1]))


def _bone_rotation(bone: Bone, values: Values, degrees: bool) -> Values:
    """``C M C^-1``, with the channels applied about fixed axes in the order listed."""
    turns = [i for i, dof in enumerate(bone.dof) if dof.startswith("r")]
    frame = _bone_frame(bone)
    if not turns:
        return np.broadcast_to(np.eye(3), (len(values), 3, 3))
    angles = np.deg2rad(values) if degrees else values
    order = "".join(bone.dof[i][1] for i in turns).upper()
    return np.asarray(frame @ euler_to_matrix(angles[:, turns[::-1]], order[::-1]) @ frame.T)


def _bone_translation(bone: Bone, values: Values) -> Values:
    """Translation channels as ``(F, 3)``: the root's along the world's axes, another bone's along its own."""
    out = np.zeros((len(values), 3))
    for i, dof in enumerate(bone.dof):
        if dof.startswith("t"):
            out[:, "xyz".index(dof[1])] = values[:, i]
    return out if not bone.parent else np.asarray(out @ _bone_frame(bone).T)
