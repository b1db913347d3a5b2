"""How each joint of a rig is turned against its ``smpl24`` counterpart, found from the animation itself.

For rigs whose rest pose says nothing (all bones along one axis, a crouch, ...). Positions give every body
part a frame: a bone and a hinge (the axis about which knee or elbow bends), the line of the hips, the sole of
a foot on the floor. ``A_j`` is the rotation nearest to the mean of ``R_j(t)^T F_j(t)`` over all frames, the
clearer ones counting more.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, normalise, project_to_so3, rotation_between
from motionrt.rigs.alignment import SIDES, Alignments, rest_direction, role_rotations
from motionrt.rigs.pose import RigPose

_STRAIGHT = 0.05
"""Weight of the neutral hinge against the sine of the bend: it decides only where a limb is straight."""

_APART = 0.04
"""Two joints nearer than this share of the leg give no direction."""

_X, _Y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


def align_from_motion(pose: RigPose, up: Array) -> Alignments:
    """Alignments from all frames of a clip.

    Args:
        pose: positions and rotations of all frames.
        up: unit vector ``(3,)``, the vertical in file axes (only the soles of the feet need it).
    """
    alignments: Alignments = {}
    _align_trunk(pose, alignments)
    _align_neck(pose, alignments)
    for side in SIDES:
        _align_collar(pose, side, alignments)
        _align_limb(pose, side, ("hip", "knee", "ankle"), _X, alignments)
        _align_limb(pose, side, ("shoulder", "elbow", "wrist"), -_Y if side == "left" else _Y, alignments)
        _align_foot(pose, side, up, alignments)
        _align_hand(pose, side, alignments)
    return alignments


def _leg(pose: RigPose) -> float:
    """Usual distance from the ankles to the hips, file units."""
    return float(np.median(np.linalg.norm(pose.legs(), axis=-1)))


def frame_of(primary: Array, secondary: Array) -> Array:
    """Orthonormal frames ``(..., 3, 3)``: first column along ``primary``, second towards ``secondary``."""
    x = normalise(primary)
    y = normalise(secondary - (secondary * x).sum(-1, keepdims=True) * x)
    return np.stack([x, y, np.cross(x, y)], axis=-1)


def matched(source: tuple[Array, Array], target: tuple[Array, Array]) -> Array:
    """Rotations ``(F, 3, 3)`` that take the target's two directions to the source's: the first exactly."""
    return frame_of(*source) @ np.swapaxes(frame_of(*target), -1, -2)


def _mean_alignment(pose: RigPose, joint: int, frames: Array, weights: Array | None = None) -> Array:
    local = np.swapaxes(pose.rotations[:, joint], -1, -2) @ frames
    mean = local.mean(0) if weights is None else np.einsum("f,fij->ij", weights, local)
    return np.asarray(project_to_so3(mean))


def _align_trunk(pose: RigPose, out: Alignments) -> None:
    """Pelvis by the hip line; spine joints by hip and shoulder lines; all by the bones of the trunk."""
    joints = pose.roles.joints
    line = (*pose.roles.spine, pose.roles.neck[0])
    distances = [np.median(np.linalg.norm(pose.positions[:, j] - pose.hip_centre(), axis=-1)) for j in line]
    far = [joint for joint, distance in zip(line, distances, strict=True) if distance > _APART * _leg(pose)]
    above = far[0] if far else line[-1]
    hips, shoulders = normalise(pose.across()), normalise(pose.across("shoulder"))
    rise = 0.5 * (rest_direction("left_hip", "spine1") + rest_direction("right_hip", "spine1"))
    source = (hips, pose.positions[:, above] - pose.hip_centre())
    out[joints["pelvis"]] = _mean_alignment(pose, joints["pelvis"], matched(source, (_X, normalise(rise))))
    for i, joint in enumerate(pose.roles.spine):
        share = (i + 1) / len(pose.roles.spine)
        bone = _next_bone(pose, (*pose.roles.spine[i:], *pose.roles.neck))
        frames = matched((bone, (1 - share) * hips + share * shoulders), (_spine_direction(share), _X))
        out[joint] = _mean_alignment(pose, joint, frames)


def _spine_direction(share: float) -> Array:
    chain = ("spine1", "spine2", "spine3", "neck")
    lower = min(max(round(3 * share), 1), 3) - 1
    return rest_direction(chain[lower], chain[lower + 1])


def _next_bone(pose: RigPose, line: tuple[int, ...]) -> Array:
    """Vectors ``(F, 3)`` from the first joint of ``line`` to the next one that stands elsewhere."""
    for joint in line[1:]:
        bone = pose.positions[:, joint] - pose.positions[:, line[0]]
        if np.median(np.linalg.norm(bone, axis=-1)) > 0.5 * _APART * _leg(pose):
            return np.asarray(bone)
    return pose.trunk()


def _align_neck(pose: RigPose, out: Alignments) -> None:
    """Neck joints by their bones and the shoulder line; the head as it is held on average over the neck."""
    neck = pose.roles.neck
    shoulders = pose.across("shoulder")
    for i, joint in enumerate(neck[:-1]):
        frames = matched((_next_bone(pose, neck[i:]), shoulders), (rest_direction("neck", "head"), _X))
        out[joint] = _mean_alignment(pose, joint, frames)
    below = neck[-2] if len(neck) > 1 else (pose.roles.spine or (pose.roles.joints["pelvis"],))[-1]
    out[neck[-1]] = _mean_alignment(pose, neck[-1], role_rotations(pose, out, below))


def _chest(pose: RigPose, alignments: Alignments) -> Array:
    return role_rotations(pose, alignments, (pose.roles.spine or (pose.roles.joints["pelvis"],))[-1])


def _align_collar(pose: RigPose, side: str, out: Alignments) -> None:
    collar, shoulder = f"{side}_collar", f"{side}_shoulder"
    if collar not in pose.roles.joints:
        return
    source = (pose.bone(collar, shoulder), _chest(pose, out)[..., 1])
    frames = matched(source, (rest_direction(collar, shoulder), _Y))
    out[pose.roles.joints[collar]] = _mean_alignment(pose, pose.roles.joints[collar], frames)


def _align_limb(pose: RigPose, side: str, line: tuple[str, str, str], axis: Array, out: Alignments) -> None:
    """The two long bones of a limb: exact along the bone, turned about it by the hinge between them."""
    top, middle, end = (f"{side}_{part}" for part in line)
    base = role_rotations(pose, out, pose.roles.joints["pelvis"]) if line[0] == "hip" else _chest(pose, out)
    upper, lower = normalise(pose.bone(top, middle)), normalise(pose.bone(middle, end))
    swung = rotation_between(base @ rest_direction(top, middle), upper) @ base
    hinge = np.cross(upper, lower) + _STRAIGHT * (swung @ axis)
    weights = np.linalg.norm(hinge, axis=-1)
    for role, bone, below in ((top, upper, middle), (middle, lower, end)):
        frames = matched((bone, hinge), (rest_direction(role, below), axis))
        out[pose.roles.joints[role]] = _mean_alignment(pose, pose.roles.joints[role], frames, weights)


def _align_foot(pose: RigPose, side: str, up: Array, out: Alignments) -> None:
    """Foot and toes by the moments when the sole rests on the floor, else by bone and knee."""
    ankle, toe = f"{side}_ankle", f"{side}_foot"
    shank = role_rotations(pose, out, pose.roles.joints[f"{side}_knee"])
    if toe not in pose.roles.joints:
        out[pose.roles.joints[ankle]] = _mean_alignment(pose, pose.roles.joints[ankle], shank)
        return
    bone = pose.bone(ankle, toe)
    frames = matched((bone, shank[..., 0]), (rest_direction(ankle, toe), _X))
    still = _resting(pose, side, up)
    if still.sum() >= 3:
        level = np.broadcast_to(up, bone.shape)
        frames = np.where(still[:, None, None], matched((level, bone), (_Y, np.array([0.0, 0.0, 1.0]))), frames)
    weights = still.astype(np.float64) if still.sum() >= 3 else np.ones(len(bone))
    for role in (ankle, toe):
        out[pose.roles.joints[role]] = _mean_alignment(pose, pose.roles.joints[role], frames, weights)


def _resting(pose: RigPose, side: str, up: Array) -> Array:
    """``(F,)`` bool: ankle and toe are low and hardly move, so the foot stands flat."""
    leg = _leg(pose)
    ankle, toe = pose.at(f"{side}_ankle"), pose.at(f"{side}_foot")
    out = np.ones(len(ankle), dtype=bool)
    for joint in (ankle, toe):
        height = joint @ up
        step = np.linalg.norm(np.gradient(joint, axis=0), axis=-1) if len(joint) > 1 else np.zeros(len(joint))
        out &= (height < np.percentile(height, 2) + 0.04 * leg) & (step <= np.percentile(step, 30))
    return out


def _align_hand(pose: RigPose, side: str, out: Alignments) -> None:
    wrist, hand = f"{side}_wrist", f"{side}_hand"
    joint = pose.roles.joints[wrist]
    forearm = role_rotations(pose, out, pose.roles.joints[f"{side}_elbow"])
    frames = forearm
    if hand in pose.roles.joints:
        bone = pose.bone(wrist, hand)
        if np.median(np.linalg.norm(bone, axis=-1)) > 1e-6:
            frames = matched((bone, forearm[..., 1]), (rest_direction(wrist, hand), _Y))
    out[joint] = _mean_alignment(pose, joint, frames)
    if hand in pose.roles.joints:
        follows = role_rotations(pose, out, joint)
        out[pose.roles.joints[hand]] = _mean_alignment(pose, pose.roles.joints[hand], follows)
