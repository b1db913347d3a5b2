"""What a generated motion must keep to: poses at times, a path with headings, hands and feet at places, a clip.

Times are in seconds and are met to 0.1 s, the grid that 20 and 30 frames per second share. Places are metres in the
frame of the first pose: it stands above the origin and faces +Z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models.text import FloatArray
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS, checked_parts
from motionrt.motion.features import ego77
from motionrt.synthesis import keeping
from motionrt.synthesis.canvas import OWNERS, Held
from motionrt.untrusted.arguments import check_kind, checked_number, listed
from motionrt.untrusted.words import shown

GRID_S = 0.1
LONGEST_S = 600.0
FARTHEST = 1e5  # metres of a place, degrees of a heading
JOINTS = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A pose at a time.

    Attributes:
        time: seconds.
        pose: a motion, whose first frame counts.
        place: where the pelvis is over the ground then (x, z), metres; None leaves it open.
        heading: which way it faces, degrees, left positive; None leaves it open.
    """

    time: float
    pose: Motion
    place: tuple[float, float] | None = None
    heading: float | None = None

    def __post_init__(self) -> None:
        check_kind(self.pose, Motion, "the pose of a keyframe", "a Motion")
        _check_way(self.time, self.place, self.heading)


@dataclass(frozen=True)
class Waypoint:
    """A place at a time.

    Attributes:
        time: seconds.
        place: of the pelvis over the ground (x, z), metres.
        heading: which way it faces, degrees, left positive; None leaves it open.
    """

    time: float
    place: tuple[float, float]
    heading: float | None = None

    def __post_init__(self) -> None:
        _check_place(self.place, 2)
        _check_way(self.time, self.place, self.heading)


@dataclass(frozen=True)
class Target:
    """A hand or foot at a place.

    Attributes:
        time: seconds.
        joint: ``left_wrist``, ``right_wrist``, ``left_ankle`` or ``right_ankle``.
        place: (x, y, z), metres.
    """

    time: float
    joint: str
    place: tuple[float, float, float]

    def __post_init__(self) -> None:
        checked_number(self.time, "time", 0.0, LONGEST_S)
        if not isinstance(self.joint, str) or self.joint not in JOINTS:
            raise InvalidInputError(f"no target for joint {shown(self.joint)}; there are: {', '.join(JOINTS)}")
        _check_place(self.place, 3)


@dataclass(frozen=True, eq=False)
class Kept:
    """A motion of which some is kept.

    Attributes:
        motion: on any frame rate.
        parts: names of :data:`motionrt.PARTS` to keep; None keeps all.
        spans: ``(from, to)`` seconds to keep; None keeps the whole.
    """

    motion: Motion
    parts: frozenset[str] | None = None
    spans: tuple[tuple[float, float], ...] | None = None

    def __post_init__(self) -> None:
        check_kind(self.motion, Motion, "what is kept", "a Motion")
        if self.parts is not None:
            checked_parts(self.parts)
        for span in [] if self.spans is None else listed(self.spans, "spans", "(from, to) seconds"):
            times = listed(span, "a span", "(from, to) seconds")
            if len(times) != 2:
                raise InvalidInputError(f"a span must be (from, to) seconds, not {shown(span)}")
            for time in times:
                checked_number(time, "a span", 0.0, LONGEST_S)


@dataclass(frozen=True, eq=False)
class Constraints:
    """What a generated motion must keep to.

    Raises:
        InvalidInputError: a time, place or joint that cannot be.
    """

    keyframes: Sequence[Keyframe] = ()
    path: Sequence[Waypoint] = ()
    targets: Sequence[Target] = ()
    kept: Sequence[Kept] = field(default=())

    def __post_init__(self) -> None:
        for each, kind in zip(fields(self), (Keyframe, Waypoint, Target, Kept), strict=True):
            for one in listed(getattr(self, each.name), each.name, f"{kind.__name__} values"):
                check_kind(one, kind, f"each of {each.name}", f"a {kind.__name__}")

    @property
    def _times(self) -> list[float]:
        keyframes, path = [k.time for k in self.keyframes], [p.time for p in self.path]
        return [*keyframes, *path, *(target.time for target in self.targets)]

    @property
    def last(self) -> float:
        """The last time that something is said of, seconds."""
        return max([*self._times, *((kept.motion.frames - 1) / kept.motion.fps for kept in self.kept)], default=0.0)

    def held(self, frames: int) -> Held:
        """What is kept from the first step on: clips and poses, of a motion of so many frames at 20 fps."""
        found = Held.nothing(frames)
        for kept in self.kept:
            wanted = frozenset(PARTS) if kept.parts is None else checked_parts(kept.parts)
            spans = ((0.0, LONGEST_S),) if kept.spans is None else kept.spans
            among = [(frame_of(start), frame_of(end)) for start, end in spans]
            found = keeping.of_clip(kept.motion, wanted, among, frames).over(found)
        for keyframe in self.keyframes:
            found = keeping.of_pose(keyframe.pose, frame_of(keyframe.time), frames).over(found)
        return found

    def corrected(self, features: FloatArray) -> Held:
        """What must be otherwise about a motion ``(F, 77)`` so that places and targets are met."""
        found = Held.nothing(len(features))
        pins = self._pins(len(features))
        if pins:
            found = keeping.on_way(features, pins)
        walked = np.where(found.parts[:, OWNERS], found.motion, features)
        for keyframe in self.keyframes:
            height = float(keyframe.pose.positions()[0, 0, 1])
            found = keeping.as_high(walked, frame_of(keyframe.time), height).over(found)
            walked = np.where(found.parts[:, OWNERS], found.motion, walked)
        for target in self.targets:
            found = keeping.reaching(walked, frame_of(target.time), target.joint, target.place).over(found)
            walked = np.where(found.parts[:, OWNERS], found.motion, walked)
        return found

    @property
    def corrects(self) -> bool:
        """Whether anything is met by correction."""
        return bool(self.path or self.targets or self.keyframes)

    def _pins(self, frames: int) -> list[keeping.Pin]:
        """Frames in order with the place and heading wanted there."""
        ways = [(way.time, way.place, way.heading) for way in self.path]
        poses = [(pose.time, pose.place, pose.heading) for pose in self.keyframes if _placed(pose)]
        found = [*ways, *poses]
        pins = {frame_of(time): (place, heading) for time, place, heading in found if frame_of(time) < frames}
        return [(frame, *pins[frame]) for frame in sorted(pins)]


def frame_of(time: float) -> int:
    """The frame at 20 fps of a time, on the grid of 0.1 s."""
    return round(time / GRID_S) * round(GRID_S * ego77.FPS)


def _placed(keyframe: Keyframe) -> bool:
    return keyframe.place is not None or keyframe.heading is not None


def _check_way(time: object, place: object, heading: object) -> None:
    """InvalidInputError unless time, place and heading, where they are given, can be."""
    checked_number(time, "time", 0.0, LONGEST_S)
    if place is not None:
        _check_place(place, 2)
    if heading is not None:
        checked_number(heading, "heading", -FARTHEST, FARTHEST)


def _check_place(place: object, count: int) -> None:
    given = listed(place, "place", f"{count} numbers")
    if len(given) != count:
        raise InvalidInputError(f"place must be {count} numbers, not {shown(place)}")
    for number in given:
        checked_number(number, "place", -FARTHEST, FARTHEST)
