"""``Take``: what one part of a picture shows: a motion, and what belongs to it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.formats import Character, Dressed, load_character, load_motion
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.rendering.body import SOLE
from motionrt.untrusted.arguments import check_kind, listed

_OUTLINE = 400  # vertices that stand for all of a mesh
_LEAD_S = 2.0  # a keypoint is shown that long before it is met


@dataclass(frozen=True)
class Mark:
    """A point in the scene that is shown for a while.

    Attributes:
        point: (x, y, z) metres.
        start_s, end_s: seconds of the motion.
    """

    point: tuple[float, float, float]
    start_s: float = 0.0
    end_s: float = float("inf")


@dataclass(frozen=True, eq=False)
class Take:
    """A motion, and what belongs to it.

    Attributes:
        motion: the motion.
        caption: a line above it.
        paths: polylines ``(N, 2)`` on the ground, x and z in metres.
        marks: points that joints should meet.
        areas: polygons ``(N, 2)`` on the ground, x and z: where one may walk. Without any the floor fits the motion.
        things: points ``(N, 3)`` of furniture and the like.
        floor: height of the floor, metres; None is 0, or the lowest foot where that is far from 0.
        moments: seconds and words of the poses that a picture shows, instead of many with their times.
        character: who is seen instead of the figure.
    """

    motion: Motion
    caption: str = ""
    paths: Sequence[FloatArray] = ()
    marks: Sequence[Mark] = ()
    areas: Sequence[FloatArray] = ()
    things: FloatArray = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    floor: float | None = None
    moments: Sequence[tuple[float, str]] = ()
    character: Character | None = None

    @cached_property
    def dressed(self) -> Dressed | None:
        """The character in the motion; RigError where it is no humanoid."""
        return None if self.character is None else self.character.dressed(self.motion)

    def vertices(self, frame: int) -> FloatArray:
        """``(V, 3)`` metres of the character's mesh in a frame; it stands on the floor that is drawn.

        Raises:
            InvalidInputError: the take has no character.
        """
        if self.dressed is None:
            raise InvalidInputError("the take has no character; give it one: Take(motion, character=...)")
        return np.asarray(self.dressed.vertices(frame) - np.array([0, SOLE, 0], np.float32), np.float32)

    def outline(self, frame: int) -> FloatArray:
        """``(N, 3)`` points that are all in the picture in a frame, metres: joints, and some of the mesh."""
        joints = np.asarray(self.motion.positions()[frame], np.float32)
        if self.dressed is None:
            return joints
        mesh = self.vertices(frame)
        return np.concatenate([joints, mesh[:: max(1, len(mesh) // _OUTLINE)]])

    @property
    def ground(self) -> float:
        """Height of the floor, metres."""
        if self.floor is not None:
            return self.floor
        names = [name for name in self.motion.skeleton.names if name.endswith("_foot")]
        joints = [self.motion.skeleton.index(name) for name in names] or slice(None)
        lowest = float(self.motion.positions()[:, joints, 1].min())
        return 0.0 if -0.15 < lowest < 0.4 else lowest


@runtime_checkable
class _Performed(Protocol):
    """A :class:`motionrt.Performance`."""

    @property
    def motion(self) -> Motion: ...
    @property
    def segments(self) -> Sequence[Any]: ...
    @property
    def paths(self) -> Sequence[Any]: ...


@runtime_checkable
class _Walked(Protocol):
    """A :class:`motionrt.Walk`."""

    @property
    def motion(self) -> Motion: ...
    @property
    def path(self) -> Any: ...


TakeLike = Take | Motion | str | Path | _Performed | _Walked
"""What can be drawn: a motion, its file, a ``Performance``, a ``Walk``, or a ``Take``."""


def take_of(given: TakeLike, caption: str | None = None) -> Take:
    """What to draw of something, with another caption if one is given.

    Raises:
        InvalidInputError: it is nothing that can be drawn.
        MotionFileNotFoundError, FormatError, RigError: a file that cannot be read.
    """
    take = _taken(given)
    return take if caption is None else replace(take, caption=caption)


def _taken(given: TakeLike) -> Take:
    if isinstance(given, Take):
        return given
    if isinstance(given, Motion):
        return Take(given)
    if isinstance(given, str | Path):
        return Take(load_motion(given), Path(given).name)
    if isinstance(given, _Performed):
        paths = [np.asarray(path.points, np.float32) for path in given.paths]
        return Take(given.motion, paths=paths, marks=_marks(given.segments, given.motion.fps))
    if isinstance(given, _Walked):
        return Take(given.motion, paths=[np.asarray(given.path.points, np.float32)])
    raise InvalidInputError(f"cannot draw {given!r}: give a Motion, a motion file, a Performance, a Walk or a Take")


def _marks(segments: Sequence[Any], fps: float) -> list[Mark]:
    """The keypoints of held poses, from a little before they are met."""
    found = []
    for segment in segments:
        keypoints: Mapping[str, Sequence[float]] = segment.keypoints
        for x, y, z in keypoints.values():
            found.append(Mark((float(x), float(y), float(z)), segment.start / fps - _LEAD_S, segment.end / fps))
    return found


def takes_of(
    given: TakeLike | Sequence[TakeLike],
    captions: str | Sequence[str] | None,
    character: Character | str | Path | None = None,
) -> list[Take]:
    """What to draw, side by side, all of it on a character if one is given.

    Raises:
        InvalidInputError: nothing is given, or not one caption for each; otherwise as :func:`take_of`.
    """
    several = isinstance(given, Sequence) and not isinstance(given, str)
    many: list[Any] = list(given) if several else [given]  # type: ignore[arg-type]
    given_names = [captions] if isinstance(captions, str) else captions
    names = None if given_names is None else listed(given_names, "captions", "texts")
    for name in names or ():
        check_kind(name, str | None, "each of captions", "a text")
    if not many or (names is not None and len(names) != len(many)):
        raise InvalidInputError(
            f"give at least one motion, and one caption for each: {len(names or ())} for {len(many)}"
        )
    takes = [take_of(one, None if names is None else names[i]) for i, one in enumerate(many)]
    if character is None:
        return takes
    somebody = character if isinstance(character, Character) else load_character(character)
    dressed = [replace(take, character=somebody) for take in takes]
    for take in dressed:
        _ = take.dressed  # a rig that cannot be played is told before anything is drawn
    return dressed
