"""BVH out: a ``Motion``, or any rig's clip, as a hierarchy with Euler angles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.formats.atomic import write_atomically
from motionrt.formats.bvh.euler import channel_order, euler_degrees
from motionrt.formats.tips import bone_tips
from motionrt.motion.batches import by_batches
from motionrt.motion.kinematics import fk
from motionrt.motion.motion import Motion
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.arguments import check_flags, check_kind, real
from motionrt.untrusted.words import shown

_POSITIONS = "Xposition Yposition Zposition"
_BLOCK = 4096  # frames that are written at once
_MOVES = 1e-5  # share of the rig's largest offset


def write_bvh(motion: Motion, path: str | Path, *, scale: float = 100.0, t_pose: bool = False) -> Path:
    """Write a motion as BVH, whole or not at all.

    Y is up; the root's OFFSET is zero and its position channels are absolute; every joint has three rotation channels
    in degrees, ``Zrotation Xrotation Yrotation`` where they come nowhere near gimbal lock and the joint's hinge first
    at hips, knees and elbows. Angles run on from frame to frame, so that interpolation does not spin. Six decimals.

    Args:
        motion: what to write.
        path: the file; its folder must exist.
        scale: file units per metre: 100 writes centimetres, which BVH importers expect most often, 1 metres.
        t_pose: put one frame of the T-pose first, facing +Z, feet on the floor, where the motion starts: what
            MotionBuilder, Maya and others characterise a rig by. Readers of motionrt drop it again.

    Returns:
        ``path``.

    Raises:
        InvalidInputError: ``scale`` is not positive, or the file cannot be written.
    """
    check_kind(motion, Motion, "motion", "a Motion")
    check_flags(t_pose=t_pose)
    if not 0 < real(scale) < np.inf:
        raise InvalidInputError(f"scale must be a positive number, not {shown(scale)}")
    motion = _with_t_pose(motion) if t_pose else motion
    skeleton = motion.skeleton
    translations = np.repeat(skeleton.offsets[None], motion.frames, axis=0)
    translations[:, 0] = motion.root
    clip = RigClip(skeleton.names, skeleton.parents, skeleton.offsets, motion.rotations, translations, motion.fps)
    return write_rig_bvh(clip, path, scale=scale)


def write_rig_bvh(clip: RigClip, path: str | Path, *, scale: float = 1.0) -> Path:
    """Write any clip as :func:`write_bvh` does, its rest pose as the pose without rotations.

    Joints other than the root get position channels where they move. Leaves called ``<parent>_end`` become End Sites,
    other last joints an End Site of a fitting length.

    Args:
        clip: one joint tree, metres.
        path: the file.
        scale: file units per metre.
    """
    clip = _without_rest(clip)
    writer = _Hierarchy(clip, scale, bone_tips(clip.names, clip.parents, clip.offsets))
    head = ["HIERARCHY", *writer.lines(0, ""), "MOTION", f"Frames: {clip.frames}", f"Frame Time: {1 / clip.fps:.10f}"]
    rows = value_rows(_columns(writer))
    return write_atomically(path, lambda file: file.writelines(written_lines(chain(head, rows))))


def written_lines(lines: Iterable[str]) -> Iterator[bytes]:
    """Lines as a file holds them."""
    return (f"{line}\n".encode() for line in lines)


class _Hierarchy:
    """Writes the joint tree; ``order`` is that of the joints with channels."""

    def __init__(self, clip: RigClip, scale: float, tips: dict[int, npt.NDArray[np.floating]]) -> None:
        self.clip, self.scale, self.tips = clip, scale, tips
        self.order: list[int] = []
        self.channels: dict[int, str] = {}
        self.moved = _moved(clip)
        self._inner = set(clip.parents)

    def lines(self, joint: int, indent: str) -> Iterator[str]:
        clip, inner = self.clip, indent + "\t"
        root = clip.parents[joint] < 0
        if self._is_end(joint):
            yield from _end_site(clip.offsets[joint] * self.scale, indent)
            return
        self.order.append(joint)
        yield f"{indent}{'ROOT' if root else 'JOINT'} {clip.names[joint]}"
        yield f"{indent}{{"
        yield f"{inner}OFFSET {_vector(np.zeros(3) if root else clip.offsets[joint] * self.scale)}"
        self.channels[joint] = channel_order(clip.names[joint], clip.rotations[:, joint])
        turns = " ".join(f"{axis}rotation" for axis in self.channels[joint])
        yield f"{inner}CHANNELS {f'6 {_POSITIONS}' if self.moved[joint] else '3'} {turns}"
        for child, parent in enumerate(clip.parents):
            if parent == joint:
                yield from self.lines(child, inner)
        if joint in self.tips:
            yield from _end_site(self.tips[joint] * self.scale, inner)
        yield f"{indent}}}"

    def _is_end(self, joint: int) -> bool:
        return joint not in self._inner and self.clip.names[joint].endswith("_end") and self.clip.parents[joint] >= 0


def _end_site(offset: npt.NDArray[np.floating], indent: str) -> list[str]:
    return [f"{indent}End Site", f"{indent}{{", f"{indent}\tOFFSET {_vector(offset)}", f"{indent}}}"]


def _moved(clip: RigClip) -> list[bool]:
    size = float(np.abs(clip.offsets).max(initial=1e-9))
    away = (
        by_batches(lambda rows: np.abs(rows - clip.offsets).max(axis=2), clip.translations).max(axis=0) > _MOVES * size
    )
    return [bool(moves) or parent < 0 for moves, parent in zip(away, clip.parents, strict=True)]


def _without_rest(clip: RigClip) -> RigClip:
    """The same movement described from a rest pose without rotations."""
    if clip.rest is None:
        return clip
    _, rest = fk(clip.rest.astype(np.float64), clip.offsets[0], clip.offsets, clip.parents)
    above = [rest[parent] if parent >= 0 else np.eye(3) for parent in clip.parents]
    rotations = np.einsum("jab,fjbc,jdc->fjad", np.stack(above), clip.rotations, rest)
    offsets = np.einsum("jab,jb->ja", np.stack(above), clip.offsets)
    translations = np.einsum("jab,fjb->fja", np.stack(above), clip.translations)
    return replace(clip, rotations=rotations, offsets=offsets, translations=translations, rest=None)


def _with_t_pose(motion: Motion) -> Motion:
    skeleton = motion.skeleton
    stand = np.array([motion.root[0, 0], -skeleton.rest_positions[:, 1].min(), motion.root[0, 2]])
    rest = np.tile(np.eye(3), (1, len(skeleton), 1, 1))
    return replace(
        motion,
        rotations=np.concatenate([rest, motion.rotations]).astype(np.float32),
        root=np.concatenate([stand[None], motion.root]).astype(np.float32),
    )


def _columns(writer: _Hierarchy) -> list[npt.NDArray[np.floating]]:
    columns: list[npt.NDArray[np.floating]] = []
    clip = writer.clip
    for joint in writer.order:
        if writer.moved[joint]:
            columns.append(clip.translations[:, joint].astype(np.float64) * writer.scale)
        columns.append(euler_degrees(clip.rotations[:, joint], writer.channels[joint]))
    return columns


def value_rows(columns: Sequence[npt.NDArray[np.floating]]) -> Iterator[str]:
    """Lines of the MOTION part, with six decimals: columns ``(F, c)`` side by side, a block of frames at a time."""
    row = " ".join(["%.6f"] * sum(column.shape[1] for column in columns))
    for start in range(0, len(columns[0]), _BLOCK):
        table = np.concatenate([column[start : start + _BLOCK] for column in columns], axis=1)
        for values in (np.round(table, 6) + 0.0).tolist():
            yield row % tuple(values)


def _vector(values: npt.NDArray[np.floating]) -> str:
    return " ".join(f"{value:.6f}" for value in np.round(values.astype(np.float64), 6) + 0.0)
