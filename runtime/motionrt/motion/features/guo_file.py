"""Is a file of ``new_joint_vecs`` (HumanML3D, or of a model trained on it) what :mod:`.guo263` says it is?

Two questions, each answered by a largest difference: do the joints that the published formula recovers move by the
velocities that the file states, and are the features of those joints the file again?
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.features import guo263
from motionrt.motion.features import guo_skeleton as skeleton
from motionrt.motion.features.checks import checked_features
from motionrt.motion.rotations import Array, axis_rotation, lengths
from motionrt.motion.skeleton import SMPL22_JOINTS, FloatArray

GROUPS = {
    "yaw step": slice(0, 1),
    "planar velocity": guo263.PLANAR,
    "height": slice(3, 4),
    "positions": guo263.POSITIONS,
    "rotations": guo263.ROTATIONS,
    "velocities": guo263.VELOCITIES,
    "contacts": guo263.CONTACTS,
}
RECOVERED_WITHIN = 1e-5  # metres
FEATURES_WITHIN = 1e-4  # metres, radians, metres per frame
ROTATIONS_WITHIN = 1e-3  # his pipeline counts in single precision, which short bones and half turns magnify
_BORDER = 1e-5  # of a squared step, around the threshold of contacts


@dataclass(frozen=True)
class FileCheck:
    """What :func:`check` found.

    Attributes:
        recovered: the largest distance in metres between a joint that the published formula recovers, and where the
            frame before and its velocities put it; rows with a wrong sign are left out.
        wrong_signs: rows whose column 0 has the wrong sign, where the heading passes half a turn.
        bone_lengths: the largest difference in metres between the file's bones and those of his skeleton.
        features: for each group, the largest difference between the file and our features of its joints.
    """

    recovered: float
    wrong_signs: tuple[int, ...]
    bone_lengths: float
    features: dict[str, float]

    @property
    def agrees(self) -> bool:
        """Whether the joints and every group of features are within their tolerances."""
        limits = dict.fromkeys(GROUPS, FEATURES_WITHIN) | {"rotations": ROTATIONS_WITHIN}
        within = all(self.features[name] <= limit for name, limit in limits.items())
        return within and self.recovered <= RECOVERED_WITHIN


def load(path: str | Path) -> FloatArray:
    """Features ``(F, 263)`` float32 of a ``.npy``; InvalidInputError for anything else."""
    try:
        return checked_features(np.load(path, allow_pickle=False), guo263.WIDTH)
    except (OSError, ValueError) as error:
        raise InvalidInputError(f"{path}: no .npy file of guo263 features (frames, 263): {error}") from error


def check(features: FloatArray) -> FileCheck:
    """Compare features ``(F, 263)`` at 20 fps of a whole clip, F >= 2, with what their joints give.

    The bones are measured, so that files made with another target skeleton are compared fairly; ``bone_lengths`` tells.
    """
    given = checked_features(features, guo263.WIDTH)
    if len(given) < 2 or not np.isfinite(given).all():
        raise InvalidInputError("a check needs at least two rows of finite numbers")
    wrong = _wrong_signs(given)
    mended = given.copy()
    mended[wrong, guo263.YAW_STEP] *= -1
    joints = _all_frames(mended)
    own = lengths(skeleton.bones(joints)).mean(axis=0)
    ours = guo263.encode_positions(joints, own)[: len(given)]
    return FileCheck(
        recovered=float(_step_errors(mended)[0].max()),
        wrong_signs=tuple(wrong.tolist()),
        bone_lengths=float(np.abs(own - skeleton.BONE_LENGTHS).max()),
        features={
            name: _difference(name, mended[:, columns], ours[:, columns], joints) for name, columns in GROUPS.items()
        },
    )


def _difference(name: str, file: Array, ours: Array, joints: Array) -> float:
    """The largest difference; contacts at the very threshold may be either."""
    apart = np.abs(file - ours)
    if name == "contacts":
        steps = np.diff(joints[:, guo263.CONTACT_JOINTS], axis=0)[: len(file)]
        apart[np.abs(np.square(steps).sum(axis=-1) - float(guo263.CONTACT_SPEED) ** 2) < _BORDER] = 0
    return float(apart.max())


def _all_frames(rows: FloatArray) -> Array:
    """Joints ``(F + 1, 22, 3)``: those of the rows, and where the last row's velocities lead."""
    joints = guo263.positions(rows).astype(np.float64)
    back = axis_rotation("Y", -2 * rows[:-1, guo263.YAW_STEP].astype(np.float64).sum())
    velocities = rows[-1, guo263.VELOCITIES].reshape(SMPL22_JOINTS, 3).astype(np.float64)
    return np.concatenate([joints, [joints[-1] + velocities @ back.T]])


def _step_errors(rows: FloatArray) -> tuple[Array, Array]:
    """``(F - 1,)`` metres each: how far the next row's joints are from where this row's velocities lead.

    With column 0 as it is, and with its sign changed.
    """
    root = np.zeros((len(rows), 1, 3))
    root[:, 0, 1] = rows[:, guo263.HEIGHT]
    others = rows[:, guo263.POSITIONS].reshape(len(rows), SMPL22_JOINTS - 1, 3)
    joints = np.concatenate([root, others], axis=1)
    velocities = rows[:-1, guo263.VELOCITIES].reshape(-1, SMPL22_JOINTS, 3)
    moved = joints[1:].copy()
    moved[..., ::2] += rows[:-1, None, guo263.PLANAR]  # seen from this row's root, in the next row's heading
    expected = joints[:-1] + velocities
    errors = []
    for sign in (1, -1):
        back = axis_rotation("Y", -2 * sign * rows[:-1, guo263.YAW_STEP].astype(np.float64))
        errors.append(lengths(moved @ np.swapaxes(back, -1, -2) - expected).max(axis=1))
    return errors[0], errors[1]


def _wrong_signs(rows: FloatArray) -> npt.NDArray[np.intp]:
    """Rows ``(n,)`` whose velocities agree with the opposite yaw step only."""
    stated, opposite = _step_errors(rows)
    return np.flatnonzero((stated > 10 * RECOVERED_WITHIN) & (opposite < stated / 10))
