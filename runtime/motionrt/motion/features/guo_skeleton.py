"""The one skeleton on which ``guo263`` is measured, and the rotations that follow from joint positions on it.

Facts of HumanML3D [Guo et al. 2022; github.com/EricGuo5513/HumanML3D: paramUtil.py, common/skeleton.py,
motion_representation.ipynb]: the joint order of SMPL without its hands; a rest direction for every bone; five chains,
of which the arms' start anew from the root's rotation; bone lengths of the first frame of clip 000021.

Two habits of the published inverse kinematics decide the numbers of every published file, so they are kept: the heading
is found with the hips' ends exchanged (shoulders minus hips, not plus; issues 119 and 131 there), and that of frame 0
is +Z by definition (issues 45 and 74).
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.batches import by_batches
from motionrt.motion.rotations import Array, axis_rotation, lengths, yaw_angle
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24

PARENTS = SMPL24.parents[:SMPL22_JOINTS]
_X, _Y, _Z, _DOWN = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0)
_RIGHT = (-1, 0, 0)

# Rest direction and length in metres of the bone that ends in joint 1, 2, ... 21.
_BONES = (
    (_X, 0.10307395),
    (_RIGHT, 0.10988335),
    (_Y, 0.13156825),
    (_DOWN, 0.39362314),
    (_DOWN, 0.39018813),
    (_Y, 0.14319026),
    (_DOWN, 0.43243298),
    (_DOWN, 0.42564332),
    (_Y, 0.057364706),
    (_Z, 0.14338174),
    (_Z, 0.14941867),
    (_Y, 0.21936000),
    (_X, 0.13748683),
    (_RIGHT, 0.14338283),
    (_Z, 0.10303927),
    (_DOWN, 0.13161398),
    (_DOWN, 0.12298430),
    (_DOWN, 0.25683984),
    (_DOWN, 0.26309186),
    (_DOWN, 0.26601186),
    (_DOWN, 0.26987630),
)
REST_DIRECTIONS = np.array([direction for direction, _ in _BONES], dtype=np.float64)
"""``(21, 3)``: where the bone that ends in joint 1, 2, ... 21 points at rest."""
BONE_LENGTHS = np.array([length for _, length in _BONES], dtype=np.float64)
"""``(21,)`` metres, of the bones in the same order."""

LEFT_HIP, RIGHT_HIP, LEFT_SHOULDER, RIGHT_SHOULDER = (
    SMPL24.index(name) for name in ("left_hip", "right_hip", "left_shoulder", "right_shoulder")
)
_LEG = [SMPL24.index(name) - 1 for name in ("right_knee", "right_ankle")]  # the leg that gives the scale
_CHAIN_STARTS = [SMPL24.index(name) - 1 for name in ("left_hip", "right_hip", "spine1", "left_collar", "right_collar")]
_SMOOTHING = 20  # frames, the deviation of the Gaussian over headings
_REACH = 4 * _SMOOTHING  # frames to either side, where SciPy's gaussian_filter1d cuts it
_TINY = 1e-9
_OPPOSITE = 1e-6  # the length of 1 + cos, sin below which two directions count as opposite
_HALF_TURNS = np.array([(0, 0, 1, 0) if direction == _Z else (0, 0, 0, 1) for direction, _ in _BONES]).T[..., None]


def _ancestors() -> Array:
    """``(22, 21)``: 1 where a bone lies between the root and a joint."""
    table = np.zeros((SMPL22_JOINTS, SMPL22_JOINTS - 1))
    for joint in range(1, SMPL22_JOINTS):
        table[joint] = table[PARENTS[joint]]
        table[joint, joint - 1] = 1
    return table


def _smoothing_weights() -> Array:
    weights = np.exp(-0.5 * (np.arange(-_REACH, _REACH + 1) / _SMOOTHING) ** 2)
    return np.asarray(weights / weights.sum())


_ANCESTORS, _WEIGHTS = _ancestors(), _smoothing_weights()


def bones(joints: Array) -> Array:
    """``(F, 21, 3)``: every joint of ``(F, 22, 3)`` but the root, seen from its parent, metres."""
    return np.asarray(joints[:, 1:] - joints[:, PARENTS[1:]])


def directions(vectors: Array) -> Array:
    """Unit vectors of bones ``(F, 21, 3)``; a bone of no length points as it does at rest."""
    size = lengths(vectors)[..., None]
    return np.asarray(np.where(size > _TINY, vectors / np.maximum(size, _TINY), REST_DIRECTIONS))


def scale_to_target(joints: Array, bone_lengths: Array = BONE_LENGTHS) -> float:
    """By how much the root's path grows: the target's right leg over that of frame 0 of ``(F, 22, 3)``."""
    leg = float(lengths(bones(joints[:1]))[0, _LEG].sum())
    return float(bone_lengths[_LEG].sum()) / leg if leg > _TINY else 1.0


def with_lengths(pointing: Array, root: Array, bone_lengths: Array) -> Array:
    """Joints ``(F, 22, 3)`` of bones ``(F, 21, 3)`` that point so and are so long, from a root ``(F, 3)``."""
    return np.asarray(root[:, None] + _ANCESTORS @ (pointing * bone_lengths[:, None]))


def placed(joints: Array) -> Array:
    """The lowest joint of all frames at height 0; frame 0 above the origin and facing +Z."""
    start, floor = joints[0, 0] * np.array([1.0, 0, 1]), by_batches(_lowest, joints).min()
    first = joints[0] - start
    across = first[RIGHT_HIP] - first[LEFT_HIP] + first[RIGHT_SHOULDER] - first[LEFT_SHOULDER]
    turn = axis_rotation("Y", -yaw_angle(_forward(across))).T

    def moved(part: Array) -> Array:
        out = part - start
        out[..., 1] -= floor
        return np.asarray(out @ turn)

    return by_batches(moved, joints)


def _lowest(joints: Array) -> Array:
    """``(F,)`` height of the lowest joint."""
    return np.asarray(joints[..., 1].min(axis=1))


def headings(joints: Array) -> Array:
    """The yaw ``(F,)`` radians, from +Z towards +X, in whose frame the features of placed joints stand."""
    across = joints[:, LEFT_HIP] - joints[:, RIGHT_HIP] + joints[:, RIGHT_SHOULDER] - joints[:, LEFT_SHOULDER]
    size = lengths(across)[:, None]
    smooth = _smoothed(_forward(across / np.maximum(size, _TINY)))
    yaw = yaw_angle(smooth)
    yaw[0] = 0
    return yaw


def chain_rotations(pointing: Array, yaw: Array) -> Array:
    """6D rotations of joints 1..21 ``(F, 21, 6)``, each relative to the joint before it in its chain.

    Every bone turns the shortest way from its rest direction to where it points; nothing is left for twist. The first
    joint of a chain is relative to the root's quaternion, which turns the heading to +Z.

    Args:
        pointing: ``(F, 21, 3)`` unit vectors in the world.
        yaw: ``(F,)`` radians, the heading.
    """
    turned = _shortest(np.ascontiguousarray(pointing.transpose(2, 1, 0)))
    before = turned[:, [max(parent - 1, 0) for parent in PARENTS[1:]]]
    root = np.zeros((4, 1, len(yaw)))
    root[0], root[2] = np.cos(yaw / 2), -np.sin(yaw / 2)
    before[:, _CHAIN_STARTS] = root
    return np.ascontiguousarray(_columns(_relative(before, turned)).transpose(2, 1, 0))


def _shortest(pointing: Array) -> Array:
    """Quaternions ``(4, 21, F)`` wxyz from the rest directions to ``(3, 21, F)``; half a turn to the opposite one."""
    x, y, z = REST_DIRECTIONS.T[..., None]
    a, b, c = pointing
    turn = np.stack([1 + (x * a + y * b + z * c), y * c - z * b, z * a - x * c, x * b - y * a])
    size = np.sqrt(np.einsum("ijk,ijk->jk", turn, turn))
    opposite = size < _OPPOSITE
    turn /= np.where(opposite, 1, size)
    return np.where(opposite, _HALF_TURNS, turn)


def _relative(before: Array, after: Array) -> Array:
    """Quaternions ``before^-1 after`` of two ``(4, ...)``."""
    w, x, y, z = before
    a, b, c, d = after
    return np.stack(
        [
            w * a + x * b + y * c + z * d,
            w * b - x * a - y * d + z * c,
            w * c - y * a - z * b + x * d,
            w * d - z * a - x * c + y * b,
        ]
    )


def _columns(turn: Array) -> Array:
    """The first two columns ``(6, ...)`` of the matrices of unit quaternions ``(4, ...)``."""
    w, x, y, z = turn
    xx, yy, zz, xy, wz = x * x, y * y, z * z, x * y, w * z
    first = [1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (x * z - w * y)]
    second = [2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (y * z + w * x)]
    return np.stack([*first, *second])


def _forward(across: Array) -> Array:
    """Up x across (from left to right): ``(..., 3)``."""
    return np.stack([across[..., 2], np.zeros_like(across[..., 0]), -across[..., 0]], axis=-1)


def _smoothed(vectors: Array) -> Array:
    """``(F, 3)`` vectors in the ground plane under a Gaussian in time; the ends go on as they are."""
    wide = np.pad(vectors, ((_REACH, _REACH), (0, 0)), mode="edge")
    x, z = (np.convolve(wide[:, axis], _WEIGHTS, mode="valid") for axis in (0, 2))
    return np.stack([x, np.zeros_like(x), z], axis=-1)
