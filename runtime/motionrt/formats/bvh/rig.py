"""From the joints and channel values of a BVH file to a :class:`RigClip`."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import numpy.typing as npt

from motionrt.formats.bvh.hierarchy import BvhJoint
from motionrt.formats.bvh.values import Values
from motionrt.motion.batches import by_batches
from motionrt.motion.rotations import euler_to_matrix
from motionrt.rigs.clip import RigClip

_DIFFERENCE = 0.1
_BLOCK = 1024  # frames at a time: keeps the float64 intermediates of an hour of motion small


def build_rig(joints: list[BvhJoint], values: Values, fps: float) -> RigClip:
    """The clip of channel values ``(F, C)``; conventions as in :func:`motionrt.formats.bvh.read.read_bvh`."""
    offsets = np.array([joint.offset or (0.0, 0.0, 0.0) for joint in joints])
    translations = _translations(joints, offsets, values)
    for j, joint in enumerate(joints):
        if j and joint.positions and not offsets[j].any():
            offsets[j] = np.median(translations[:, j], axis=0)  # described by its positions alone
    return RigClip(
        names=tuple(joint.name for joint in joints),
        parents=tuple(joint.parent for joint in joints),
        offsets=offsets.astype(np.float32),
        rotations=_rotations(joints, values),
        translations=by_batches(lambda part: part.astype(np.float32), translations),
        fps=fps,
    )


def _first_columns(joints: list[BvhJoint]) -> list[int]:
    counts = [len(joint.channels) for joint in joints]
    return [sum(counts[:j]) for j in range(len(counts))]


def _translations(joints: list[BvhJoint], offsets: Values, values: Values) -> Values:
    def placed(part: Values) -> Values:
        out = np.tile(offsets, (len(part), 1, 1))
        for j, (joint, first) in enumerate(zip(joints, _first_columns(joints), strict=True)):
            for i, axis in joint.positions:
                out[:, j, axis] = part[:, first + i]
        return out

    out = by_batches(placed, values)
    relative = joints_with_differences(joints, offsets, out)
    if relative:
        out[:, relative] += offsets[relative]
    return out


def joints_with_differences(joints: list[BvhJoint], offsets: Values, translations: Values) -> list[int]:
    """Joints whose position channels are to be added to the offset.

    Decided for all joints but the root together: their positions stay within a tenth of their offsets.
    """
    length = np.linalg.norm(offsets, axis=-1)
    moved = [j for j, joint in enumerate(joints) if j and len(joint.positions) == 3 and length[j] > 0]
    if not moved:
        return []
    usual = np.linalg.norm(np.median(translations[:, moved], axis=0), axis=-1)
    return moved if np.median(usual / length[moved]) < _DIFFERENCE else []


def _rotations(joints: list[BvhJoint], values: Values) -> npt.NDArray[np.float32]:
    out = np.empty((len(values), len(joints), 3, 3), dtype=np.float32)
    first = _first_columns(joints)
    groups: defaultdict[str, list[int]] = defaultdict(list)
    for j, joint in enumerate(joints):
        groups[joint.rotation_order].append(j)
    still = groups.pop("", [])
    columns = {
        order: [[first[j] + i for i in joints[j].rotations] for j in members] for order, members in groups.items()
    }
    for start in range(0, len(values), _BLOCK):
        block = slice(start, start + _BLOCK)
        out[block, still] = np.eye(3, dtype=np.float32)
        for order, members in groups.items():
            out[block, members] = euler_to_matrix(np.deg2rad(values[block, columns[order]]), order)
    return out
