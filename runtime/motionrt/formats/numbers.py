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
from motionrt.rigs.clip import RigClip
from motionrt.rigs.other_bodies import motion_of_body
from motionrt.untrusted import npz
from motionrt.untrusted.files import as_path

_PICKLED = (
    "holds pickled objects, which can run any program and are never loaded; in Python, save its joints alone:"
    " r = np.load(path, allow_pickle=True).item();"
    " np.save('joints.npy', r['motion'][0].transpose(2, 0, 1)), frames x 22 x 3"
)
_SHAPES = "expected (frames, 263) features of HumanML3D or (frames, 22, 3) joints"


def read_npy(path: Path, *, fps: float | None = None) -> RigClip:
    """Read ``(F, 263)`` features or ``(F, 22 | 24, 3)`` joints of HumanML3D, 20 fps unless said otherwise.

    Raises:
        FormatError: pickled objects, another shape, or numbers that are not finite.
    """
    path = as_path(path)
    require_file(path)
    if fps is not None:
        fps = checked_fps(fps)
    values = npz.read_npy(path, lambda reason, _: FormatError(path, _PICKLED if "pickled" in reason else reason))
    return as_clip(joints_as_motion(values, fps or guo263.FPS, path))


def joints_as_motion(values: npt.NDArray[np.generic], fps: float, path: Path) -> Motion:
    """The motion of an array of features ``(F, 263)`` or joints ``(F, 22 | 24, 3)``, Y up."""
    if values.dtype.kind not in "fiu":
        raise FormatError(path, f"does not hold numbers but {values.dtype}")
    numbers = values.astype(np.float64)
    if numbers.ndim == 4 and len(numbers) == 1:
        numbers = numbers[0]
    if not numbers.size or not (np.abs(numbers) <= LARGEST_VALUE).all():
        raise FormatError(path, "holds numbers that are not finite or too large, or none at all")
    if numbers.ndim == 3 and numbers.shape[0] in (22, 24) and numbers.shape[1] == 3:
        numbers = numbers.transpose(2, 0, 1)  # joints, axes, frames: how MDM stores a sample
    if numbers.ndim == 2 and numbers.shape[1] == guo263.WIDTH:
        numbers = guo263.positions(numbers.astype(np.float32)).astype(np.float64)
    if numbers.ndim != 3 or numbers.shape[1] not in (22, 24) or numbers.shape[2] != 3:
        raise FormatError(path, f"holds an array {values.shape}; {_SHAPES}")
    return motion_of_body(numbers, fps)


def as_clip(motion: Motion) -> RigClip:
    """``motion`` as a rig of its own joints: metres, Y up."""
    skeleton = motion.skeleton
    translations = np.tile(skeleton.offsets, (motion.frames, 1, 1))
    translations[:, 0] = motion.root
    return RigClip(
        skeleton.names, skeleton.parents, skeleton.offsets, motion.rotations, translations, motion.fps, "y", 1.0
    )
