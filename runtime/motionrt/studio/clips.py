"""Clips on the stage: a motion with a name and a colour, ready to be shown at any time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.formats import load_motion
from motionrt.motion import Motion
from motionrt.motion.feet.contacts import stretches, toe_contacts
from motionrt.motion.rotations import matrix_to_quaternion
from motionrt.motion.skeleton import SMPL22_JOINTS, FloatArray
from motionrt.motion.transforms import TOE_JOINTS

Colour = tuple[int, int, int]

PALETTE: tuple[Colour, ...] = (
    (40, 114, 200),
    (213, 94, 0),
    (0, 158, 115),
    (204, 121, 167),
    (230, 159, 0),
    (86, 180, 233),
    (120, 84, 40),
    (110, 110, 110),
)
"""Colours that people tell apart whatever they see of colours, after Okabe and Ito; on light ground."""


@dataclass(frozen=True, eq=False)
class Clip:
    """A motion that can be shown.

    Attributes:
        name: what it is called on the page.
        motion: the motion.
        colour: red, green and blue, 0 to 255.
        note: one line about it, as in a score.
        made: whether it is somebody's work, which a search leaves on the stage, and not a hit.
        dear: whether it took more than a text to make: a performance, a plan.
    """

    name: str
    motion: Motion
    colour: Colour
    note: str = ""
    made: bool = False
    dear: bool = False

    @cached_property
    def quaternions(self) -> FloatArray:
        """``(F, 22, 4)`` global rotations of the bones, wxyz, each in the half space of the frame before."""
        return continuous(matrix_to_quaternion(self.motion.global_rotations()[:, :SMPL22_JOINTS]))

    @property
    def joints(self) -> FloatArray:
        """``(F, 22, 3)`` metres, where the bones are."""
        return self.motion.positions()[:, :SMPL22_JOINTS]

    def at(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Places ``(22, 3)`` and rotations ``(22, 4)`` wxyz of the bones at a time; the ends are held."""
        return between(self.joints, self.quaternions, self.motion.fps, time)

    @cached_property
    def footsteps(self) -> tuple[FloatArray, FloatArray]:
        """Where feet stand: places ``(N, 3)`` of the balls of the feet, and ``(N, 2)`` seconds from when to when."""
        return footsteps(self.motion)

    def trail(self, spacing: float = 0.05) -> FloatArray:
        """``(N, 2)`` x and z of the pelvis over the whole clip, thinned to a point every ``spacing`` metres."""
        return thinned(self.motion.root[:, [0, 2]], spacing)

    @cached_property
    def box(self) -> FloatArray:
        """``(2, 3)`` lowest and highest corner of all that the joints touch, metres."""
        points = self.motion.positions().reshape(-1, 3)
        return np.stack([points.min(axis=0), points.max(axis=0)])


def between(joints: FloatArray, quaternions: FloatArray, fps: float, time: float) -> tuple[FloatArray, FloatArray]:
    """Places ``(J, 3)`` and rotations ``(J, 4)`` at a time, of frames ``(F, J, 3)`` and ``(F, J, 4)``; held at ends."""
    last = len(joints) - 1
    place = min(max(time * fps, 0.0), float(last))
    before = int(place)
    after, share = min(before + 1, last), np.float32(place - before)
    places = joints[before] * (1 - share) + joints[after] * share
    turns = quaternions[before] * (1 - share) + quaternions[after] * share
    return places, np.asarray(turns / np.linalg.norm(turns, axis=1, keepdims=True), dtype=np.float32)


def continuous(quaternions: FloatArray) -> FloatArray:
    """``(F, J, 4)`` with signs such that neighbouring frames can be mixed."""
    flips = (quaternions[1:] * quaternions[:-1]).sum(axis=-1, keepdims=True) < 0
    signs = np.cumprod(np.where(flips, -1, 1), axis=0)
    return np.concatenate([quaternions[:1], quaternions[1:] * signs]).astype(np.float32)


def footsteps(motion: Motion) -> tuple[FloatArray, FloatArray]:
    """The stands of both feet: places ``(N, 3)`` and spans ``(N, 2)`` in seconds, in order of their beginning."""
    contacts, positions = toe_contacts(motion), motion.positions()
    found: list[tuple[float, float, FloatArray]] = []
    for side, joint in enumerate(TOE_JOINTS):
        toes = positions[:, motion.skeleton.index(joint)]
        for start, stop in stretches(contacts[:, side]):
            found.append((start / motion.fps, stop / motion.fps, toes[start:stop].mean(axis=0)))
    found.sort(key=lambda row: row[0])
    places = np.array([place for _, _, place in found], dtype=np.float32).reshape(-1, 3)
    return places, np.array([[start, stop] for start, stop, _ in found], dtype=np.float32).reshape(-1, 2)


def thinned(points: npt.NDArray[np.float32], spacing: float) -> FloatArray:
    """A polyline ``(N, 2)`` without points nearer than ``spacing`` to the one kept before; both ends stay."""
    kept = [0]
    for index in range(1, len(points)):
        if np.hypot(*(points[index] - points[kept[-1]])) >= spacing:
            kept.append(index)
    if kept[-1] != len(points) - 1 and (points[-1] != points[kept[-1]]).any():
        kept.append(len(points) - 1)
    return np.asarray(points[kept], dtype=np.float32)


def load_clips(paths: Sequence[Path]) -> tuple[list[Clip], list[str]]:
    """The clips of files, and one line about every file that cannot be read.

    Raises:
        InvalidInputError: none can; the message has all those lines.
    """
    clips: list[Clip] = []
    problems: list[str] = []
    for path in paths:
        try:
            clips.append(Clip(unique(path.stem, clips), load_motion(path), colour(len(clips))))
        except MotionRTError as error:
            problems.append(str(error))
    if paths and not clips:
        raise InvalidInputError("; ".join(problems))
    return clips, problems


def colour(index: int) -> Colour:
    """The colour of the ``index``-th clip."""
    return PALETTE[index % len(PALETTE)]


def unique(name: str, clips: Sequence[Clip]) -> str:
    """``name``, with a number if a clip has it already."""
    taken = {clip.name for clip in clips}
    number = next(n for n in range(1, len(clips) + 2) if (f"{name} {n}" if n > 1 else name) not in taken)
    return name if number == 1 else f"{name} {number}"
