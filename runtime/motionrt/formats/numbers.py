"""Results of text-to-motion models: ``.npy`` arrays of features or joints, and ``.npz`` files of joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.formats.text import LARGEST_VALUE, require_file
from motionrt.motion.checks import checked_fps
from motionrt.motion.features import guo263
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import normalise
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.clip import RigClip
from motionrt.rigs.other_bodies import motion_of_body
from motionrt.untrusted import npz
from motionrt.untrusted.arguments import checked_up
from motionrt.untrusted.files import as_path

Array = npt.NDArray[np.float64]

_PICKLED = (
    "holds pickled objects, which can run any program and are never loaded; in Python, save its joints alone:"
    " r = np.load(path, allow_pickle=True).item();"
    " np.save('joints.npy', r['motion'][0].transpose(2, 0, 1)), frames x 22 x 3"
)
_FLAT = (66, 72)
"""Numbers of the joints of a frame in one row."""
_UPRIGHT, _FLOOR = 0.75, 0.25
"""Cosine between feet-to-head and an axis from which on a body stands along it; metres of its soles from zero."""
_Z_UP_TO_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
_SHAPES = "expected (frames, 263) features of HumanML3D or (frames, 22, 3) joints"


def read_npy(path: Path, *, fps: float | None = None, up: str | None = None) -> RigClip:
    """Read ``(F, 263)`` features or ``(F, 22 | 24, 3)`` joints of HumanML3D, 20 fps unless said otherwise.

    Joints are Y up unless ``up`` says ``"z"``, or the body always stands along Z on a floor at 0.

    Raises:
        FormatError: pickled objects, another shape, or numbers that are not finite.
    """
    path = as_path(path)
    require_file(path)
    checked_up(up)
    if fps is not None:
        fps = checked_fps(fps)
    values = npz.read_npy(path, lambda reason, _: FormatError(path, _PICKLED if "pickled" in reason else reason))
    return as_clip(joints_as_motion(values, fps or guo263.FPS, path, up))


def joints_as_motion(values: npt.NDArray[np.generic], fps: float, path: Path, up: str | None = None) -> Motion:
    """The motion of an array of features ``(F, 263)`` or joints ``(F, 22 | 24, 3)``; ``up`` as :func:`read_npy`."""
    if values.dtype.kind not in "fiu":
        raise FormatError(path, f"does not hold numbers but {values.dtype}")
    numbers = values.astype(np.float64)
    if numbers.ndim == 4 and len(numbers) == 1:
        numbers = numbers[0]
    if numbers.ndim == 3 and numbers.shape[0] == 1 and numbers.shape[2] in (guo263.WIDTH, *_FLAT):
        numbers = numbers[0]
    if numbers.ndim == 2 and numbers.shape[1] in _FLAT:
        numbers = numbers.reshape(len(numbers), -1, 3)
    if not numbers.size or not (np.abs(numbers) <= LARGEST_VALUE).all():
        raise FormatError(path, "holds numbers that are not finite or too large, or none at all")
    if numbers.ndim == 3 and numbers.shape[0] in (22, 24) and numbers.shape[1] == 3:
        numbers = numbers.transpose(2, 0, 1)  # joints, axes, frames: how MDM stores a sample
    if numbers.ndim == 2 and numbers.shape[1] == guo263.WIDTH:
        numbers = guo263.positions(numbers.astype(np.float32)).astype(np.float64)
    if numbers.ndim != 3 or numbers.shape[1] not in (22, 24) or numbers.shape[2] != 3:
        raise FormatError(path, f"holds an array {values.shape}; {_SHAPES}")
    turned = (up or _vertical(numbers)) == "z" and values.shape[-1] != guo263.WIDTH
    return motion_of_body(numbers @ _Z_UP_TO_Y_UP.T if turned else numbers, fps)


def _vertical(joints: Array) -> str:
    """``"z"`` where the body stands along Z over a floor at 0, and never along Y; else ``"y"``."""
    feet = 0.5 * (joints[:, SMPL24.index("left_ankle")] + joints[:, SMPL24.index("right_ankle")])
    shares = (normalise(joints[:, SMPL24.index("head")] - feet) > _UPRIGHT).mean(axis=0)
    on_floor = abs(float(np.percentile(joints[..., 2].min(axis=1), 5))) < _FLOOR
    return "z" if shares[2] > 0.5 and shares[1] < 0.02 and on_floor else "y"


def as_clip(motion: Motion) -> RigClip:
    """``motion`` as a rig of its own joints: metres, Y up."""
    skeleton = motion.skeleton
    translations = np.tile(skeleton.offsets, (motion.frames, 1, 1))
    translations[:, 0] = motion.root
    return RigClip(
        skeleton.names, skeleton.parents, skeleton.offsets, motion.rotations, translations, motion.fps, "y", 1.0
    )
