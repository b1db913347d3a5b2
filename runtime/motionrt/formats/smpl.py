"""AMASS ``.npz`` (SMPL, SMPL-H or SMPL-X poses) in and out, without any file of those body models."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.atomic import write_atomically
from motionrt.formats.text import LARGEST_VALUE, require_file
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import axis_angle_to_matrix, matrix_to_axis_angle
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.npz import read_arrays

Array = npt.NDArray[np.float64]

BODY_JOINTS = 22
"""The joints that SMPL, SMPL-H and SMPL-X have in common come first, in the order of ``smpl24``."""

# Width of `poses` -> the joints (of three numbers each) that stand for left_hand and right_hand. SMPL has one
# joint per hand; of the fifteen per hand that SMPL-H and SMPL-X have, the base of the middle finger.
_HANDS: dict[int, tuple[int, int] | None] = {66: None, 72: (22, 23), 156: (25, 40), 165: (28, 43)}
_SMPLH_WIDTH = 156
_FINGER_BASES = (0, 3, 6, 9)  # index, middle, little, ring finger among the fifteen joints of a SMPL-H hand
_ZIP_MARK, _NPY_MARK = b"PK", b"\x93NUMPY"
_RATE_KEYS = ("mocap_framerate", "mocap_frame_rate", "fps")
_Z_UP_TO_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def read_npz(path: str | Path, *, fps: float | None = None) -> RigClip:
    """Read an AMASS file: ``poses (F, 66 | 72 | 156 | 165)`` axis-angle, ``trans (F, 3)`` metres, Z up.

    The clip comes Y up, on the joints and proportions of ``smpl24``: body shape (``betas``) is not applied,
    and ``trans`` is taken for the position of the pelvis, from which it differs by a small constant that only
    the body model knows.

    Args:
        path: the file. Files with ``root_orient`` and ``pose_body`` in place of ``poses`` are read too.
        fps: frames per second to use instead of the file's ``mocap_framerate``.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: not an npz archive, a key is missing, or an array has a wrong shape or type.
    """
    path = Path(path)
    arrays = _read_arrays(path)
    poses, trans = _poses(arrays, path), _numbers(arrays, "trans", path)
    if trans.shape != (len(poses), 3):
        expected = f"expected ({len(poses)}, 3), one row for each of 'poses'"
        raise FormatError(path, f"'trans' has the shape {trans.shape}, {expected}")
    rate = _frame_rate(arrays, path) if fps is None else float(fps)
    rotations = axis_angle_to_matrix(_select_joints(poses))
    rotations[:, 0] = _Z_UP_TO_Y_UP @ rotations[:, 0]
    translations = np.tile(SMPL24.offsets, (len(poses), 1, 1))
    translations[:, 0] = trans @ _Z_UP_TO_Y_UP.T
    return RigClip(
        names=SMPL24.names,
        parents=SMPL24.parents,
        offsets=SMPL24.offsets,
        rotations=rotations.astype(np.float32),
        translations=translations,
        fps=rate,
        up="y",
        metres_per_unit=1.0,
    )


def write_npz(motion: Motion, path: str | Path) -> Path:
    """Write a motion in the SMPL-H layout of AMASS, whole or not at all; returns ``path``.

    ``poses (F, 156)`` axis-angle and ``trans (F, 3)`` metres, Z up; ``mocap_framerate``; ``betas`` zeros (16)
    and ``gender`` "neutral". A hand's rotation goes to the bases of its four fingers.

    Raises:
        InvalidInputError: the motion's skeleton is not ``smpl24``, or the file cannot be written.
    """
    if motion.skeleton.names != SMPL24.names:
        raise InvalidInputError("an AMASS file holds the joints of smpl24 only; write this skeleton as BVH")
    rotations = motion.rotations.astype(np.float64)
    rotations[:, 0] = _Z_UP_TO_Y_UP.T @ rotations[:, 0]
    vectors = matrix_to_axis_angle(rotations)
    poses = np.zeros((motion.frames, _SMPLH_WIDTH // 3, 3))
    poses[:, :BODY_JOINTS] = vectors[:, :BODY_JOINTS]
    for hand in range(2):
        fingers = [BODY_JOINTS + 15 * hand + base for base in _FINGER_BASES]
        poses[:, fingers] = vectors[:, BODY_JOINTS + hand, None]
    arrays = {
        "poses": poses.reshape(motion.frames, _SMPLH_WIDTH),
        "trans": motion.root.astype(np.float64) @ _Z_UP_TO_Y_UP,
        "mocap_framerate": np.array(float(motion.fps)),
        "betas": np.zeros(16),
        "gender": np.array("neutral"),
    }
    return write_atomically(path, lambda file: _save(file, arrays))


def _save(file: BinaryIO, arrays: dict[str, npt.NDArray[np.generic]]) -> None:
    np.savez_compressed(file, allow_pickle=False, **arrays)


def _read_arrays(path: Path) -> dict[str, npt.NDArray[np.generic]]:
    """The arrays that matter."""
    _require_archive(path)
    wanted = ("poses", "trans", "root_orient", "pose_body", *_RATE_KEYS)
    found, names = read_arrays(path, lambda reason, line: FormatError(path, reason, line), wanted)
    if "poses" not in found and not {"root_orient", "pose_body"} <= found.keys():
        raise FormatError(
            path, f"not an AMASS motion: it has no 'poses' (it holds {', '.join(sorted(names)[:12]) or 'nothing'})"
        )
    return found


def _require_archive(path: Path) -> None:
    require_file(path)
    with path.open("rb") as file:
        start = file.read(len(_NPY_MARK))
    if not start.startswith(_ZIP_MARK):
        reason = "a single NumPy array" if start == _NPY_MARK else "some other or an empty file"
        raise FormatError(path, f"{reason}, not an npz archive")


def _poses(arrays: dict[str, npt.NDArray[np.generic]], path: Path) -> Array:
    if "poses" in arrays:
        poses = _numbers(arrays, "poses", path)
    else:
        parts = [_numbers(arrays, key, path) for key in ("root_orient", "pose_body")]
        if any(part.ndim != 2 for part in parts) or len(parts[0]) != len(parts[1]):
            raise FormatError(path, "'root_orient' and 'pose_body' do not fit together")
        poses = np.concatenate(parts, axis=1)
    if poses.ndim != 2 or poses.shape[1] not in _HANDS:
        widths = " | ".join(map(str, _HANDS))
        raise FormatError(path, f"'poses' has the shape {poses.shape}, expected (frames, {widths})")
    if not len(poses):
        raise FormatError(path, "the file has no frames")
    return poses


def _numbers(arrays: dict[str, npt.NDArray[np.generic]], key: str, path: Path) -> Array:
    if key not in arrays:
        raise FormatError(path, f"not a whole AMASS motion: it has no '{key}'")
    if arrays[key].dtype.kind not in "fiu":
        raise FormatError(path, f"'{key}' does not hold numbers but {arrays[key].dtype}")
    values = arrays[key].astype(np.float64)
    bad = np.argwhere(~(np.abs(values) <= LARGEST_VALUE))
    if len(bad):
        where = f", first in frame {bad[0][0]}" if values.ndim else ""
        raise FormatError(path, f"'{key}' holds numbers that are not finite or too large{where}")
    return values


def _frame_rate(arrays: dict[str, npt.NDArray[np.generic]], path: Path) -> float:
    key = next((key for key in _RATE_KEYS if key in arrays), None)
    if key is None:
        raise FormatError(path, f"it has no frame rate ({' or '.join(_RATE_KEYS[:2])}); give fps=")
    values = _numbers(arrays, key, path)
    if values.size != 1 or not 1 <= values.item() <= 1000:
        raise FormatError(path, f"'{key}' is no frame rate between 1 and 1000; give fps= to replace it")
    return float(values.item())


def _select_joints(poses: Array) -> Array:
    """``(F, W)`` of any body model -> rotation vectors of the joints of ``smpl24``, ``(F, 24, 3)``."""
    vectors = poses.reshape(len(poses), -1, 3)
    out = np.zeros((len(poses), len(SMPL24), 3))
    out[:, :BODY_JOINTS] = vectors[:, :BODY_JOINTS]
    hands = _HANDS[poses.shape[1]]
    if hands is not None:
        out[:, BODY_JOINTS:] = vectors[:, list(hands)]
    return out
