"""What a :class:`motionrt.motion.motion.Motion` must be made of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.limits import SLOWEST_FPS, how_to_raise, limits
from motionrt.motion.batches import BATCH, by_batches
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import real
from motionrt.untrusted.words import shown

NOT_A_ROTATION = 0.02
"""By how much rows of a rotation may differ from unit length, from right angles and from a right-handed frame."""


def frozen(array: FloatArray, name: str, shape: tuple[int, ...]) -> FloatArray:
    """A read-only float32 copy of ``array`` with ``shape`` behind its frame axis."""
    try:
        with np.errstate(over="ignore"):
            out = by_batches(lambda part: np.array(part, dtype=np.float32), np.asarray(array))
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInputError(f"{name} must be an array of numbers, not {shown(array)}") from error
    if out.shape[1:] != shape or out.ndim != len(shape) + 1 or not len(out):
        expected = ", ".join(map(str, shape))
        raise InvalidInputError(f"{name} must have the shape (frames >= 1, {expected}), not {out.shape}")
    if len(out) > limits().frames:
        raise InvalidInputError(f"{name} has {len(out):,} frames: {how_to_raise('frames')}")
    for first in range(0, len(out), BATCH):
        finite = np.isfinite(out[first : first + BATCH])
        if not finite.all():
            bad = first + int(np.argmin(finite.reshape(len(finite), -1).all(axis=1)))
            raise InvalidInputError(f"{name} holds a number that is not finite, first in frame {bad}")
    out.setflags(write=False)
    return out


def check_rotations(rotations: FloatArray, names: Sequence[str]) -> None:
    """InvalidInputError unless all of ``(F, J, 3, 3)`` are rotations: orthonormal and right-handed."""
    for first in range(0, len(rotations), BATCH):
        part = rotations[first : first + BATCH]
        off = _off_rotations(part).reshape(part.shape[:2])
        if not (off <= NOT_A_ROTATION).all():
            frame, joint = (int(i) for i in np.argwhere(~(off <= NOT_A_ROTATION))[0])
            raise InvalidInputError(
                f"rotations holds a matrix that is no rotation, first in frame {first + frame} at '{names[joint]}': "
                "its rows must have unit length, be at right angles and right-handed"
            )


def _off_rotations(matrices: FloatArray) -> FloatArray:
    """``(N,)``: by how much rows of matrices ``[..., 3, 3]`` miss unit length, right angles and right-handed frames."""
    a, b, c, d, e, f, g, h, i = np.ascontiguousarray(matrices.reshape(-1, 9).T)  # entry by entry: no strides
    with np.errstate(over="ignore", invalid="ignore"):
        off: FloatArray = np.abs(a * a + b * b + c * c - 1)
        for miss in (
            d * d + e * e + f * f - 1,
            a * d + b * e + c * f,
            b * f - c * e - g,
            c * d - a * f - h,
            a * e - b * d - i,
        ):
            np.maximum(off, np.abs(miss), out=off)
    return off


def check_root(root: FloatArray) -> None:
    """InvalidInputError for a place ``(F, 3)`` farther from the origin than the limit."""
    if np.abs(root).max() > limits().metres:
        bad = int(np.argmax(np.abs(root).max(axis=1)))
        raise InvalidInputError(f"root is too far from the origin in frame {bad}: {how_to_raise('metres')}")


def checked_fps(fps: object) -> float:
    """A frame rate within range; InvalidInputError otherwise."""
    number = real(fps)
    if not (np.isfinite(number) and number > 0):
        raise InvalidInputError(f"fps must be a positive number, not {shown(fps)}")
    if not SLOWEST_FPS <= number <= limits().fps:
        raise InvalidInputError(f"fps must lie between {SLOWEST_FPS:g} and {limits().fps:g}, not {number:g}")
    return number
