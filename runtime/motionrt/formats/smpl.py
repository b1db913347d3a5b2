"""``.npz`` of SMPL, SMPL-H or SMPL-X poses in (AMASS, video capture) and out, without any file of those body models."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.atomic import write_atomically
from motionrt.formats.numbers import as_clip, joints_as_motion
from motionrt.formats.text import LARGEST_VALUE, require_file
from motionrt.motion.batches import by_batches
from motionrt.motion.checks import NOT_A_ROTATION, checked_fps
from motionrt.motion.kinematics import fk
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import axis_angle_to_matrix, matrix_to_axis_angle, normalise
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.arguments import check_kind, checked_up
from motionrt.untrusted.files import as_path
from motionrt.untrusted.npz import read_arrays, write_arrays

Array = npt.NDArray[np.float64]

BODY_JOINTS = 22
"""The joints that SMPL, SMPL-H and SMPL-X have in common come first, in the order of ``smpl24``."""

# Width of `poses` -> the joints (of three numbers each) that stand for left_hand and right_hand. SMPL has one
# joint per hand; of the fifteen per hand that SMPL-H and SMPL-X have, the base of the middle finger.
_HANDS: dict[int, tuple[int, int] | None] = {66: None, 72: (22, 23), 156: (25, 40), 159: (26, 41), 165: (28, 43)}
_SMPLH_WIDTH = 156
_FINGER_BASES = (0, 3, 6, 9)  # index, middle, little, ring finger among the fifteen joints of a SMPL-H hand
_GENERATED_FPS = 30.0
_UPRIGHT = 0.75
"""Cosine between feet-to-head and an axis from which on a body stands along it."""

_FLOOR, _FAR = 0.5, 1.0
"""Metres from zero within which the lowest joint of a standing body is on the floor; of a way that is walked."""

_ZIP_MARK, _NPY_MARK = b"PK", b"\x93NUMPY"
_LAYOUTS = (
    ("poses",), ("root_orient", "pose_body"), ("global_orient", "body_pose"), ("root_pose", "body_pose"),
    ("pose_world",), ("pose",), ("fullpose",),
)  # fmt: skip
"""Names of the poses: AMASS, its second stage, SMPL-X results, video capture."""

_PLACES = ("trans", "transl", "translation", "trans_world", "root_trans")
"""Names of where the pelvis is."""

_RATE_KEYS = ("mocap_framerate", "mocap_frame_rate", "fps", "frame_rate", "framerate")
_Z_UP_TO_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def read_npz(path: str | Path, *, fps: float | None = None, up: str | None = None) -> RigClip:
    """Read poses of a body model: ``(F, 66 | 72 | 156 | 159 | 165)`` or ``(F, J, 3)`` axis-angle, ``(F, 3)`` metres.

    The names are those of AMASS (``poses``, or ``root_orient`` and ``pose_body``, with ``trans``) or of SMPL-X results
    (``global_orient``, ``body_pose``, ``transl``; ``pose_world``, ``trans_world``) and their like; rotation matrices
    ``(F, J, 3, 3)`` and a batch of one are read as well. The clip comes Y up, on the joints
    and proportions of ``smpl24``: body shape (``betas``) is not applied, and the place is taken for that of the pelvis,
    from which it differs by a small constant that only the body model knows. ``posed_joints`` of motion generators are
    read as positions.

    Args:
        path: the file. Without a place the figure stays on the spot.
        fps: frames per second to use instead of the file's ``mocap_framerate``.
        up: ``"y"`` or ``"z"``, the vertical of the file; by default Z as in AMASS, or Y if the body stands along it.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: not an npz archive, a key is missing, or an array has a wrong shape or type.
    """
    path = as_path(path)
    checked_up(up)
    arrays = _read_arrays(path)
    if "posed_joints" in arrays:
        return _from_joints(arrays, path, fps)
    place = next((name for name in _PLACES if name in arrays), _PLACES[0])
    arrays = _unbatched(arrays, place)
    poses = _poses(arrays, next((keys for keys in _LAYOUTS if set(keys) <= arrays.keys()), _LAYOUTS[0]), path)
    trans, notes = _places(arrays, place, len(poses), path)
    rate = _frame_rate(arrays, path) if fps is None else checked_fps(fps)
    rotations = by_batches(_rotations, poses)
    turn = np.eye(3) if (up or _vertical(rotations, trans)) == "y" else _Z_UP_TO_Y_UP
    rotations[:, 0] = by_batches(lambda part: turn.astype(np.float32) @ part, rotations[:, 0])
    translations = by_batches(lambda places: _standing(places @ turn.T), trans)
    return RigClip(
        names=SMPL24.names,
        parents=SMPL24.parents,
        offsets=SMPL24.offsets,
        rotations=rotations,
        translations=translations,
        fps=rate,
        up="y",
        metres_per_unit=1.0,
        notes=notes,
    )


def _from_joints(arrays: dict[str, npt.NDArray[np.generic]], path: Path, fps: float | None) -> RigClip:
    joints = _numbers(arrays, "posed_joints", path)
    if joints.ndim != 3 or joints.shape[1:] not in ((22, 3), (24, 3)):
        hint = "only those of the 22 joints of SMPL are known; export BVH instead"
        raise FormatError(path, f"'posed_joints' has the shape {joints.shape}; {hint}")
    known = any(key in arrays for key in _RATE_KEYS)
    rate = fps or (_frame_rate(arrays, path) if known else _GENERATED_FPS)
    return as_clip(joints_as_motion(joints, rate, path))


def _places(
    arrays: dict[str, npt.NDArray[np.generic]], key: str, frames: int, path: Path
) -> tuple[Array, tuple[str, ...]]:
    """Where the pelvis is ``(F, 3)``, and a note where the file does not say."""
    if key not in arrays:
        return np.zeros((frames, 3)), (f"has no '{key}': the figure stays on the spot",)
    trans = _numbers(arrays, key, path)
    if trans.shape != (frames, 3):
        raise FormatError(path, f"'{key}' has the shape {trans.shape}, expected ({frames}, 3), one row for each pose")
    return trans, ()


def _vertical(rotations: npt.NDArray[np.floating], trans: Array) -> str:
    """``"y"`` where the body stands along Y, over a floor at 0 or on a way along Z, and never along Z; else ``"z"``."""
    body = by_batches(_bearing, rotations, trans)
    shares = (body[:, :3] > _UPRIGHT).mean(axis=0)
    on_floor = abs(float(np.percentile(body[:, 3], 5))) < _FLOOR or not trans.any()
    _, high, far = np.ptp(trans, axis=0)
    walks = far > max(_FAR, 4 * high)  # nobody who lies moves so far up or down
    return "y" if shares[1] > 0.5 and shares[2] < 0.02 and (on_floor or walks) else "z"


def _bearing(rotations: npt.NDArray[np.floating], trans: Array) -> Array:
    """``(F, 4)``: the unit vector from feet to head, and the height of the lowest joint along Y, metres."""
    places, _ = fk(rotations, trans, SMPL24.offsets, SMPL24.parents)
    feet = 0.5 * (places[:, SMPL24.index("left_ankle")] + places[:, SMPL24.index("right_ankle")])
    body = normalise(places[:, SMPL24.index("head")] - feet)
    return np.concatenate([body, places[..., 1].min(axis=1)[:, None]], axis=1)


def write_npz(motion: Motion, path: str | Path) -> Path:
    """Write a motion in the SMPL-H layout of AMASS, whole or not at all; returns ``path``.

    ``poses (F, 156)`` axis-angle and ``trans (F, 3)`` metres, Z up; ``mocap_framerate``; ``betas`` zeros (16)
    and ``gender`` "neutral". A hand's rotation goes to the bases of its four fingers.

    Raises:
        InvalidInputError: the motion's skeleton is not ``smpl24``, or the file cannot be written.
    """
    check_kind(motion, Motion, "motion", "a Motion")
    if motion.skeleton.names != SMPL24.names:
        raise InvalidInputError("an AMASS file holds the joints of smpl24 only; write this skeleton as BVH")
    arrays = {
        "poses": by_batches(_smplh_poses, motion.rotations),
        "trans": motion.root.astype(np.float64) @ _Z_UP_TO_Y_UP,
        "mocap_framerate": np.array(float(motion.fps)),
        "betas": np.zeros(16),
        "gender": np.array("neutral"),
    }
    return write_atomically(path, lambda file: write_arrays(file, arrays, compressed=True))


def _smplh_poses(rotations: npt.NDArray[np.float32]) -> Array:
    """``(F, 156)`` axis-angle, Z up, of ``(F, 24, 3, 3)`` Y up."""
    turned = rotations.astype(np.float64)
    turned[:, 0] = _Z_UP_TO_Y_UP.T @ turned[:, 0]
    vectors = matrix_to_axis_angle(turned)
    poses = np.zeros((len(turned), _SMPLH_WIDTH // 3, 3))
    poses[:, :BODY_JOINTS] = vectors[:, :BODY_JOINTS]
    for hand in range(2):
        fingers = [BODY_JOINTS + 15 * hand + base for base in _FINGER_BASES]
        poses[:, fingers] = vectors[:, BODY_JOINTS + hand, None]
    return poses.reshape(len(turned), _SMPLH_WIDTH)


def _read_arrays(path: Path) -> dict[str, npt.NDArray[np.generic]]:
    """The arrays that matter."""
    _require_archive(path)
    wanted = (*(key for keys in _LAYOUTS for key in keys), *_PLACES, "posed_joints", *_RATE_KEYS)
    found, names = read_arrays(path, lambda reason, line: FormatError(path, reason, line), wanted)
    if "posed_joints" not in found and not any(set(keys) <= found.keys() for keys in _LAYOUTS):
        layouts = ", or ".join(" and ".join(map(repr, keys)) for keys in _LAYOUTS)
        held = ", ".join(sorted(names)[:12]) or "nothing"
        raise FormatError(path, f"not poses of SMPL: it has no {layouts} (it holds {held})")
    return found


def _require_archive(path: Path) -> None:
    require_file(path)
    with path.open("rb") as file:
        start = file.read(len(_NPY_MARK))
    if not start.startswith(_ZIP_MARK):
        reason = "a single NumPy array" if start == _NPY_MARK else "some other or an empty file"
        raise FormatError(path, f"{reason}, not an npz archive")


def _poses(arrays: dict[str, npt.NDArray[np.generic]], keys: tuple[str, ...], path: Path) -> Array:
    """``(F, W)`` rotation vectors of all joints, root first."""
    parts = [_as_vectors(_numbers(arrays, key, path), key, path) for key in keys]
    odd = next((key for key, part in zip(keys, parts, strict=True) if part.ndim not in {2, 3}), None)
    if odd is not None:
        raise FormatError(path, f"'{odd}' has the shape {arrays[odd].shape}, expected one row for each frame")
    parts = [part.reshape(len(part), -1) if part.ndim == 3 and part.shape[2] == 3 else part for part in parts]
    if any(part.ndim != 2 or len(part) != len(parts[0]) for part in parts):
        raise FormatError(path, f"{' and '.join(map(repr, keys))} do not fit together")
    poses = by_batches(lambda *some: np.concatenate(some, axis=1), *parts) if len(parts) > 1 else parts[0]
    if poses.shape[1] == 69 and len(parts) > 1:
        poses = np.concatenate([poses, np.zeros((len(poses), 3))], axis=1)
    if poses.shape[1] == 63:
        hint = "63 numbers a frame are a body without its root; add the root's rotation as 'root_orient'"
        raise FormatError(path, f"'{keys[0]}' has the shape {poses.shape}: {hint} and call these 'pose_body'")
    if poses.shape[1] not in _HANDS:
        widths = " | ".join(map(str, _HANDS))
        raise FormatError(path, f"'{keys[0]}' has the shape {poses.shape}, expected (frames, {widths})")
    if not len(poses):
        raise FormatError(path, "the file has no frames")
    return poses


def _unbatched(arrays: dict[str, npt.NDArray[np.generic]], place: str) -> dict[str, npt.NDArray[np.generic]]:
    """Without the axis of a batch of one, which the place ``(1, F, 3)`` shows."""
    if place not in arrays or arrays[place].ndim != 3 or len(arrays[place]) != 1:
        return arrays
    return {name: value[0] if value.ndim > 1 and len(value) == 1 else value for name, value in arrays.items()}


def _as_vectors(values: Array, key: str, path: Path) -> Array:
    """Rotation matrices ``(F, J, 3, 3)`` as rotation vectors ``(F, J, 3)``; all else as it is."""
    if values.ndim != 4 or values.shape[2:] != (3, 3) or not len(values):
        return values
    if by_batches(_off_rotation, values).max() > NOT_A_ROTATION:
        raise FormatError(path, f"'{key}' holds matrices that are no rotations")
    return by_batches(matrix_to_axis_angle, values)


def _off_rotation(matrices: Array) -> Array:
    """``(F,)``: how far matrices ``(F, J, 3, 3)`` are from being orthonormal and right-handed."""
    square = np.abs(np.swapaxes(matrices, -1, -2) @ matrices - np.eye(3)).max(axis=(-2, -1))
    return np.asarray(np.where(np.linalg.det(matrices) > 0, square, 1.0).max(axis=-1))


def _numbers(arrays: dict[str, npt.NDArray[np.generic]], key: str, path: Path) -> Array:
    if key not in arrays:
        raise FormatError(path, f"not a whole AMASS motion: it has no '{key}'")
    if arrays[key].dtype.kind not in "fiu":
        raise FormatError(path, f"'{key}' does not hold numbers but {arrays[key].dtype}")
    values = arrays[key]
    rows = values.reshape(len(values) if values.ndim and values.size else 1, -1)
    good = by_batches(lambda part: (np.abs(part.astype(np.float64)) <= LARGEST_VALUE).all(axis=1), rows)
    if not good.all():
        where = f", first in frame {int(np.argmin(good))}" if values.ndim else ""
        raise FormatError(path, f"'{key}' holds numbers that are not finite or too large{where}")
    return by_batches(lambda part: part.astype(np.float64), values) if values.ndim else values.astype(np.float64)


def _frame_rate(arrays: dict[str, npt.NDArray[np.generic]], path: Path) -> float:
    key = next((key for key in _RATE_KEYS if key in arrays), None)
    if key is None:
        raise FormatError(path, f"it has no frame rate ({' or '.join(_RATE_KEYS[:2])}); give fps=")
    try:
        rate = float(arrays[key].item()) if arrays[key].dtype.kind in "fiuSU" else 0.0
    except (ValueError, TypeError):
        rate = 0.0
    if not 1 <= rate <= 1000:
        raise FormatError(path, f"'{key}' is no frame rate between 1 and 1000; give fps= to replace it")
    return rate


def _rotations(poses: Array) -> npt.NDArray[np.float32]:
    """``(F, W)`` -> ``(F, 24, 3, 3)``."""
    return axis_angle_to_matrix(_select_joints(poses)).astype(np.float32)


def _standing(places: Array) -> npt.NDArray[np.float32]:
    """Local translations ``(F, 24, 3)`` of joints whose root is at ``places``."""
    out = np.tile(SMPL24.offsets, (len(places), 1, 1))
    out[:, 0] = places
    return out


def _select_joints(poses: Array) -> Array:
    """``(F, W)`` of any body model -> rotation vectors of the joints of ``smpl24``, ``(F, 24, 3)``."""
    vectors = poses.reshape(len(poses), -1, 3)
    out = np.zeros((len(poses), len(SMPL24), 3))
    out[:, :BODY_JOINTS] = vectors[:, :BODY_JOINTS]
    hands = _HANDS[poses.shape[1]]
    if hands is not None:
        out[:, BODY_JOINTS:] = vectors[:, list(hands)]
    return out
