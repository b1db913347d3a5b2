"""``guo263``: the 263 features per frame of HumanML3D at 20 fps  [Guo et al. 2022; TMR 4.1].

========  =====================================================================================
0         half the yaw step to the next frame, radians, positive to the character's right
1:3       root planar velocity (x, z) to the next frame, in the next frame's heading, metres per frame
3         root height, metres
4:67      positions of joints 1..21 in the heading frame (root x and z removed), metres
67:193    6D rotations of joints 1..21 (first two columns), each relative to the joint before it in its chain
193:259   velocities of joints 0..21 to the next frame in the heading frame, metres per frame
259:263   foot contacts: left ankle, left toe, right ankle, right toe (1 while nearly still)
========  =====================================================================================

These are the columns of his files, from joint positions alone (see :mod:`.guo_skeleton`): the joints are brought onto
his one skeleton, the lowest joint to height 0, frame 0 above the origin and facing +Z. A rig's twist never enters.

A file of ``new_joint_vecs`` has one row fewer than its motion has frames, as every row holds a step to the next frame.
Here ``F`` frames give ``F`` rows: rows ``[:-1]`` are his, and the last row is the last pose with the steps of the row
before. In one point his files are not followed: where the heading passes half a turn from the start, his column 0 has
the wrong sign for one frame, and the path that his own formula recovers bends there. Ours has the right sign.

Rotations and headings depend on the whole clip (the heading is smoothed over seconds, and rotations are measured from
the heading of frame 0), so features of a part differ from that part of the features, as with his files. :func:`part`
gives the former.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from motionrt.motion.batches import BATCH, by_batches
from motionrt.motion.features import guo_skeleton as skeleton
from motionrt.motion.features.checks import checked_features
from motionrt.motion.from_positions import checked_joints, from_positions
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation, lengths, wrapped
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24, FloatArray

WIDTH = 263
FPS = 20.0
YAW_STEP, PLANAR, HEIGHT = 0, slice(1, 3), 3
POSITIONS, ROTATIONS = slice(4, 67), slice(67, 193)
VELOCITIES, CONTACTS = slice(193, 259), slice(259, 263)
CONTACT_JOINTS = tuple(map(SMPL24.index, ("left_ankle", "left_foot", "right_ankle", "right_foot")))
CONTACT_SPEED = np.float32(0.002**0.5)  # metres per frame at 20 fps: a squared step of 0.002

_GROUND = np.array([1.0, 0, 1])
_MIRRORED_JOINTS = list(SMPL24.mirrored_joints[:SMPL22_JOINTS])
_SMPL24_LENGTHS = lengths(SMPL24.offsets[1:SMPL22_JOINTS].astype(np.float64))


def encode(motion: Motion) -> FloatArray:
    """``(F, 263)`` float32 features; resample the motion to 20 fps first."""
    return encode_positions(motion.positions())


def encode_positions(joints: Array, bone_lengths: Array = skeleton.BONE_LENGTHS) -> FloatArray:
    """``(F, 263)`` float32 features of joint positions at 20 fps, in the order of ``smpl24``.

    Args:
        joints: ``(F, 22 or 24, 3)`` metres, Y up, of any proportions; hands are not looked at.
        bone_lengths: ``(21,)`` metres of the skeleton to measure on, where it is not his.
    """
    given = checked_joints(joints)[:, :SMPL22_JOINTS]
    root = given[:, 0] * skeleton.scale_to_target(given, bone_lengths)
    pointing = by_batches(_pointing, given)
    del given  # a long motion is not held in more forms than are needed
    return _features(pointing, root, bone_lengths)


def positions(features: FloatArray) -> FloatArray:
    """Joint positions ``(F, 22, 3)`` in metres on his skeleton, by the published formula: what ``new_joints`` holds.

    From the origin, facing +Z.
    """
    return _joints(checked_features(features, WIDTH)).astype(np.float32)


def decode(features: FloatArray, fps: float = FPS) -> Motion:
    """A ``smpl24`` motion from the features, from the origin, facing +Z; bones keep their directions.

    The root's path is scaled to the legs of ``smpl24``, and the lowest joint keeps its height above the floor. For
    features of a ``smpl24`` motion every joint comes back; twist, which they do not hold, is zero.
    """
    his = _joints(checked_features(features, WIDTH))
    scale = skeleton.scale_to_target(his, _SMPL24_LENGTHS)
    pointing = skeleton.directions(skeleton.bones(his))
    joints = skeleton.with_lengths(pointing, his[:, 0] * scale, _SMPL24_LENGTHS)
    joints[..., 1] += his[..., 1].min() * scale - joints[..., 1].min()
    return from_positions(joints, fps)


def part(features: FloatArray, start: int, stop: int) -> FloatArray:
    """Features of frames ``start`` to ``stop`` (exclusive) alone: equal to encoding that part of the motion.

    A slice of the features is measured from the first frame and the floor of the whole clip; this is not.
    """
    return _encoded_again(_joints(checked_features(features[start:stop], WIDTH)))


def mirror(features: Array) -> Array:
    """Features of the mirrored motion, ``(F, 263)`` of the same dtype: equal to encoding :meth:`Motion.mirror`.

    His skeleton is not symmetric, so that this is no exchange of columns: the joints are found, mirrored and encoded
    again. Give whole clips; to have many mirrored clips, encode ``motion.mirror()`` once.
    """
    his = _joints(checked_features(features, WIDTH))
    mirrored = his[:, _MIRRORED_JOINTS] * np.array([-1.0, 1, 1])
    return _encoded_again(mirrored).astype(np.asarray(features).dtype)


def _encoded_again(joints: Array) -> FloatArray:
    """Features of bones that point as those of ``joints`` ``(F, 22, 3)``, on the same path of the root."""
    return _features(skeleton.directions(skeleton.bones(joints)), joints[:, 0])


def _features(pointing: Array, root: Array, bone_lengths: Array = skeleton.BONE_LENGTHS) -> FloatArray:
    """Features of bones ``(F, 21, 3)`` that point so, on a root's path ``(F, 3)``, placed as he does."""
    longer = by_batches(partial(skeleton.with_lengths, bone_lengths=bone_lengths), pointing, root)
    joints = skeleton.placed(longer)
    del longer
    yaw = skeleton.headings(joints)
    to_heading = by_batches(partial(axis_rotation, "Y"), -yaw)
    turns = wrapped(-_forward_difference(yaw)) / 2
    rows = np.empty((len(joints), WIDTH), np.float32)
    for start in range(0, len(joints), BATCH):
        here = slice(start, start + BATCH)
        steps, to_next = _next(joints, here) - joints[here], _next(to_heading, here)
        rows[here] = _rows(joints[here], yaw[here], to_heading[here], to_next, steps, turns[here])
    if len(rows) > 1:  # the steps of the last frame are those of the row before
        rows[-1, YAW_STEP : PLANAR.stop], rows[-1, VELOCITIES.start :] = (
            rows[-2, YAW_STEP : PLANAR.stop],
            rows[-2, VELOCITIES.start :],
        )
    return rows


def _pointing(joints: Array) -> Array:
    """Where the bones of joints ``(F, 22, 3)`` point, ``(F, 21, 3)``."""
    return skeleton.directions(skeleton.bones(joints))


def _rows(joints: Array, yaw: Array, to_heading: Array, to_next: Array, steps: Array, turns: Array) -> FloatArray:
    """Features ``(F, 263)`` of placed joints, their headings and their steps to the next frame."""
    count = len(joints)
    parts = [
        turns[:, None],
        _turn(to_next, steps[:, :1])[:, 0, ::2],
        joints[:, 0, 1:2],
        _turn(to_heading, joints[:, 1:] - joints[:, :1] * _GROUND).reshape(count, -1),
        skeleton.chain_rotations(_pointing(joints), yaw).reshape(count, -1),
        _turn(to_heading, steps).reshape(count, -1),
        np.square(steps[:, CONTACT_JOINTS]).sum(axis=-1) < float(CONTACT_SPEED) ** 2,
    ]
    return np.concatenate(parts, axis=1).astype(np.float32)


def _joints(x: Array) -> Array:
    """The published recovery: joints ``(F, 22, 3)`` float64."""
    yaw = np.concatenate([[0], np.cumsum(-2 * x[:-1, YAW_STEP].astype(np.float64))])
    from_heading = axis_rotation("Y", yaw)
    step = np.zeros((len(x), 1, 3))
    step[1:, 0, ::2] = x[:-1, PLANAR]
    root = np.cumsum(_turn(from_heading, step)[:, 0], axis=0)
    local = x[:, POSITIONS].reshape(len(x), SMPL22_JOINTS - 1, 3).astype(np.float64)
    joints = _turn(from_heading, local) + root[:, None]
    root[:, 1] = x[:, HEIGHT]
    return np.concatenate([root[:, None], joints], axis=1)


def _turn(matrices: Array, vectors: Array) -> Array:
    """Per-frame rotations ``(F, 3, 3)`` of vectors ``(F, J, 3)``."""
    return np.asarray(vectors @ np.swapaxes(matrices, -1, -2))


def _next(values: Array, here: slice = slice(None)) -> Array:
    """For the frames ``here`` the values of the next one; the last frame's stay."""
    start, stop, _ = here.indices(len(values))
    if stop < len(values):
        return values[start + 1 : stop + 1]
    return np.concatenate([values[start + 1 :], values[-1:]])


def _forward_difference(values: Array) -> Array:
    """``values[i + 1] - values[i]``; zero for the last frame."""
    return np.asarray(_next(values) - values)
