"""BVH out: a ``Motion`` as a hierarchy with Euler angles."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.formats.atomic import write_atomically
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import matrix_to_euler
from motionrt.motion.skeleton import Skeleton

_ORDER = "ZXY"
_ROTATIONS = " ".join(f"{axis}rotation" for axis in _ORDER)
_POSITIONS = "Xposition Yposition Zposition"

# Where a last bone of smpl24 ends, metres from its joint: crown, toe tips, finger tips.
_TIPS = {
    "head": (0.0, 0.170, 0.0),
    "left_foot": (0.0, 0.0, 0.070),
    "right_foot": (0.0, 0.0, 0.070),
    "left_hand": (0.100, 0.0, 0.0),
    "right_hand": (-0.100, 0.0, 0.0),
}


def write_bvh(motion: Motion, path: str | Path, *, scale: float = 100.0) -> Path:
    """Write a motion as BVH, whole or not at all.

    Y is up; the root's OFFSET is zero and its position channels are absolute; every joint has the rotation
    channels ``Zrotation Xrotation Yrotation`` (degrees, unwrapped over time so that interpolation does not
    spin). Six decimals.

    Args:
        motion: what to write.
        path: the file; its folder must exist.
        scale: file units per metre: 100 writes centimetres, which BVH importers expect most often, 1 metres.

    Returns:
        ``path``.

    Raises:
        InvalidInputError: ``scale`` is not positive, or the file cannot be written.
    """
    if not (np.isfinite(scale) and scale > 0):
        raise InvalidInputError(f"scale must be a positive number, not {scale}")
    order = list(_depth_first(motion.skeleton, 0))
    lines = ["HIERARCHY", *_hierarchy(motion.skeleton, 0, scale, ""), "MOTION", f"Frames: {motion.frames}"]
    lines += [f"Frame Time: {1 / motion.fps:.10f}", *_rows(motion, order, scale), ""]
    content = "\n".join(lines).encode("utf-8")
    return write_atomically(path, lambda file: _put(file, content))


def _put(file: BinaryIO, content: bytes) -> None:
    file.write(content)


def _children(skeleton: Skeleton, joint: int) -> list[int]:
    return [child for child, parent in enumerate(skeleton.parents) if parent == joint]


def _depth_first(skeleton: Skeleton, joint: int) -> Iterator[int]:
    yield joint
    for child in _children(skeleton, joint):
        yield from _depth_first(skeleton, child)


def _hierarchy(skeleton: Skeleton, joint: int, scale: float, indent: str) -> Iterator[str]:
    name, inner = skeleton.names[joint], indent + "\t"
    root = skeleton.parents[joint] < 0
    yield f"{indent}{'ROOT' if root else 'JOINT'} {name}"
    yield f"{indent}{{"
    yield f"{inner}OFFSET {_vector(np.zeros(3) if root else skeleton.offsets[joint] * scale)}"
    yield f"{inner}CHANNELS {f'6 {_POSITIONS}' if root else '3'} {_ROTATIONS}"
    for child in _children(skeleton, joint):
        yield from _hierarchy(skeleton, child, scale, inner)
    if not _children(skeleton, joint):
        tip = np.array(_TIPS[name]) if name in _TIPS else skeleton.offsets[joint] / 2
        yield from (f"{inner}End Site", f"{inner}{{", f"{inner}\tOFFSET {_vector(tip * scale)}", f"{inner}}}")
    yield f"{indent}}}"


def _rows(motion: Motion, order: list[int], scale: float) -> list[str]:
    rotations = motion.rotations[:, order].astype(np.float64)
    angles = np.rad2deg(np.unwrap(matrix_to_euler(rotations, _ORDER), axis=0))
    table = np.concatenate([motion.root * scale, angles.reshape(motion.frames, -1)], axis=1)
    row = " ".join(["%.6f"] * table.shape[1])
    return [row % tuple(values) for values in (np.round(table, 6) + 0.0).tolist()]


def _vector(values: npt.NDArray[np.floating]) -> str:
    return " ".join(f"{value:.6f}" for value in np.round(values.astype(np.float64), 6) + 0.0)
