"""``guo263``: the 263 retrieval features per frame at 20 fps  [TMR 4.1, Guo et al. 2022].

========  =====================================================================================
0         root angular velocity about Y: half the yaw step to the next frame, radians
1:3       root planar velocity (x, z) to the next frame in the heading frame, metres per frame
3         root height, metres
4:67      positions of joints 1..21 in the heading frame (root x and z removed), metres
67:193    6D rotations of joints 1..21, local; children of the pelvis relative to the heading
193:259   velocities of joints 0..21 to the next frame in the heading frame, metres per frame
259:263   foot contacts: left ankle, left toe, right ankle, right toe (1 while nearly still)
========  =====================================================================================

The last frame repeats the velocities of the frame before it, so F frames give F rows. The vector does not know where
the motion started nor which way it faced, and it describes 22 joints: decoding starts at the origin, facing +Z.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion.features.checks import checked_features
from motionrt.motion.kinematics import global_to_local
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation, matrix_from_6d, matrix_to_6d, project_to_so3, wrapped
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24, FloatArray
from motionrt.motion.transforms import heading

WIDTH = 263
FPS = 20.0
YAW_STEP, PLANAR, HEIGHT = 0, slice(1, 3), 3
POSITIONS, ROTATIONS = slice(4, 67), slice(67, 193)
VELOCITIES, CONTACTS = slice(193, 259), slice(259, 263)
CONTACT_JOINTS = tuple(map(SMPL24.index, ("left_ankle", "left_foot", "right_ankle", "right_foot")))
CONTACT_SPEED = np.float32(0.002**0.5)  # metres per frame at 20 fps: a squared step of 0.002

_PELVIS_CHILDREN = tuple(joint for joint in range(1, SMPL22_JOINTS) if SMPL24.parents[joint] == 0)


def encode(motion: Motion) -> FloatArray:
    """``(F, 263)`` float32 features; resample the motion to 20 fps first, and ground it if its floor is not y = 0."""
    yaw = heading(motion)
    to_heading = axis_rotation("Y", -yaw)
    positions = motion.positions()[:, :SMPL22_JOINTS]
    steps = _forward_difference(positions)
    local = positions - positions[:, :1] * np.array([1, 0, 1], dtype=np.float32)
    root_step = _turn(to_heading, steps[:, :1])[:, 0]
    contacts = np.linalg.norm(steps[:, CONTACT_JOINTS], axis=-1) < CONTACT_SPEED
    parts = [
        (wrapped(_forward_difference(yaw)) / 2)[:, None],
        root_step[:, [0, 2]],
        positions[:, 0, 1:2],
        _turn(to_heading, local[:, 1:]).reshape(motion.frames, -1),
        matrix_to_6d(_heading_rotations(motion, to_heading)).reshape(motion.frames, -1),
        _turn(to_heading, steps).reshape(motion.frames, -1),
        contacts,
    ]
    return np.concatenate(parts, axis=1).astype(np.float32)


def positions(features: FloatArray) -> FloatArray:
    """Joint positions ``(F, 22, 3)`` in metres that the features describe, from the origin, facing +Z."""
    x = checked_features(features, WIDTH)
    root, from_heading = _trajectory(x)
    local = x[:, POSITIONS].reshape(len(x), SMPL22_JOINTS - 1, 3)
    joints = _turn(from_heading, local) + root[:, None] * np.array([1, 0, 1], dtype=np.float32)
    return np.concatenate([root[:, None], joints], axis=1).astype(np.float32)


def decode(features: FloatArray, fps: float = FPS) -> Motion:
    """A ``smpl24`` motion from the features, from the origin, facing +Z; exact for features of a real motion.

    The pelvis' own tilt, which the rotations leave out, is found from the positions of its three children.
    """
    x = checked_features(features, WIDTH)
    root, from_heading = _trajectory(x)
    sixd = x[:, ROTATIONS].reshape(len(x), SMPL22_JOINTS - 1, 6)
    rotations = np.tile(np.eye(3, dtype=np.float32), (len(x), len(SMPL24), 1, 1))
    rotations[:, 1:SMPL22_JOINTS] = matrix_from_6d(sixd)
    tilt = _pelvis_tilt(x)
    rotations[:, 0] = from_heading @ tilt
    for joint in _PELVIS_CHILDREN:
        rotations[:, joint] = np.swapaxes(tilt, -1, -2) @ rotations[:, joint]
    return Motion(rotations, root, fps)


def mirror(features: Array) -> Array:
    """Features of the mirrored motion, ``(..., 263)`` of the same dtype: equal to encoding :meth:`Motion.mirror`."""
    return np.asarray(features[..., _MIRROR_SOURCE] * _MIRROR_SIGN.astype(features.dtype))


def _mirror_table() -> tuple[npt.NDArray[np.int64], Array]:
    """For every feature, the one that it becomes in the mirror (x = 0), and its sign."""
    source, sign = np.arange(WIDTH), np.ones(WIDTH)
    partners = np.array(SMPL24.mirrored_joints[:SMPL22_JOINTS])
    blocks = (
        (POSITIONS, partners[1:] - 1, [-1, 1, 1]),
        (ROTATIONS, partners[1:] - 1, [1, -1, -1, -1, 1, 1]),  # M R M, first two columns
        (VELOCITIES, partners, [-1, 1, 1]),
        (CONTACTS, np.array([2, 3, 0, 1]), [1]),
    )
    for columns, order, signs in blocks:
        source[columns] = source[columns].reshape(len(order), -1)[order].ravel()
        sign[columns] = np.tile(signs, len(order))
    sign[[YAW_STEP, PLANAR.start]] = -1
    return source, sign


_MIRROR_SOURCE, _MIRROR_SIGN = _mirror_table()


def _pelvis_tilt(x: FloatArray) -> Array:
    """Pelvis rotation relative to the heading ``(F, 3, 3)``: Kabsch on its children's offsets."""
    local = x[:, POSITIONS].reshape(len(x), SMPL22_JOINTS - 1, 3)[:, [j - 1 for j in _PELVIS_CHILDREN]]
    local = local - x[:, None, HEIGHT, None] * np.array([0, 1, 0], dtype=np.float32)
    covariance = np.einsum("fji,jk->fik", local.astype(np.float64), SMPL24.offsets[list(_PELVIS_CHILDREN)])
    return np.asarray(project_to_so3(covariance), dtype=np.float32)


def _heading_rotations(motion: Motion, to_heading: Array) -> Array:
    """Rotations of joints 1..21 ``(F, 21, 3, 3)``, local, but the pelvis' children relative to the heading."""
    turned = motion.global_rotations()[:, :SMPL22_JOINTS].copy()
    turned[:, 0] = np.swapaxes(to_heading, -1, -2)
    return global_to_local(turned, SMPL24.parents[:SMPL22_JOINTS])[:, 1:]


def _trajectory(x: FloatArray) -> tuple[Array, Array]:
    """Root positions ``(F, 3)`` and rotations from the heading frame to the world ``(F, 3, 3)``."""
    yaw = np.concatenate([[0], np.cumsum(2 * x[:-1, YAW_STEP], dtype=np.float64)])
    from_heading = axis_rotation("Y", yaw)
    step = np.zeros((len(x), 1, 3))
    step[:, 0, [0, 2]] = x[:, PLANAR]
    planar = np.cumsum(_turn(from_heading, step)[:-1, 0], axis=0)
    root = np.concatenate([np.zeros((1, 3)), planar])
    root[:, 1] = x[:, HEIGHT]
    return root.astype(np.float32), from_heading.astype(np.float32)


def _turn(matrices: Array, vectors: Array) -> Array:
    """Per-frame rotations ``(F, 3, 3)`` of vectors ``(F, J, 3)``."""
    return np.asarray(vectors @ np.swapaxes(matrices, -1, -2))


def _forward_difference(values: Array) -> Array:
    """``values[i + 1] - values[i]`` with the last difference repeated; zero for a single frame."""
    if len(values) == 1:
        return np.zeros_like(values)
    steps = np.diff(values, axis=0)
    return np.concatenate([steps, steps[-1:]])
