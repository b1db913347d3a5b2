"""What a generated motion must keep to: poses at times, a path with headings, hands and feet at places, a clip.

Times are in seconds and are met to 0.1 s, the grid that 20 and 30 frames per second share. Places are metres in the
frame of the first pose: it stands above the origin and faces +Z.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.text import FloatArray
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS, checked_parts
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.canvas import OWNERS, Held
from motionrt.untrusted.arguments import checked_number

GRID_S = 0.1
LONGEST_S = 600.0
JOINTS = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
GLOBAL = PARTS.index("global")
_REACH = 7  # frames before and after a target over which a limb goes to it and returns
_ALONG = {"wrist": {"wrist": 1.0, "hand": 1.0, "elbow": 0.5}, "ankle": {"ankle": 1.0, "foot": 1.0, "knee": 0.5}}

Array = npt.NDArray[np.float64]


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
        for time in self._times:
            checked_number(time, "time", 0.0, LONGEST_S)
        for target in self.targets:
            if target.joint not in JOINTS:
                raise InvalidInputError(f"no target for joint {target.joint!r}; there are: {', '.join(JOINTS)}")
        for pose in self.keyframes:
            if not isinstance(pose.pose, Motion):
                raise InvalidInputError(f"the pose of a keyframe is a Motion, not {type(pose.pose).__name__}")
        for kept in self.kept:
            if kept.parts is not None:
                checked_parts(kept.parts)
        numbers = [*(p.place for p in self.path), *(t.place for t in self.targets)]
        numbers += [k.place for k in self.keyframes if k.place is not None]
        if not np.isfinite([x for place in numbers for x in place]).all():
            raise InvalidInputError("a place holds a number that is not finite")

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
            found = _of_clip(kept, frames).over(found)
        for keyframe in self.keyframes:
            found = _of_pose(keyframe, frames).over(found)
        return found

    def corrected(self, features: FloatArray) -> Held:
        """What must be otherwise about a motion ``(F, 77)`` so that places and targets are met."""
        found = Held.nothing(len(features))
        pins = self._pins(len(features))
        if pins:
            found = _on_way(features, pins)
        walked = np.where(found.parts[:, OWNERS], found.motion, features)
        for keyframe in self.keyframes:
            found = _as_high(walked, keyframe).over(found)
            walked = np.where(found.parts[:, OWNERS], found.motion, walked)
        for target in self.targets:
            found = _reaching(walked, target).over(found)
            walked = np.where(found.parts[:, OWNERS], found.motion, walked)
        return found

    @property
    def corrects(self) -> bool:
        """Whether anything is met by correction."""
        return bool(self.path or self.targets or self.keyframes)

    def _pins(self, frames: int) -> list[tuple[int, tuple[float, float] | None, float | None]]:
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


def _of_clip(kept: Kept, frames: int) -> Held:
    features = ego77.encode(kept.motion.resample(ego77.FPS).positions())[:frames]
    motion = np.zeros((frames, ego77.WIDTH), np.float32)
    motion[: len(features)] = features
    wanted = frozenset(PARTS) if kept.parts is None else checked_parts(kept.parts)
    parts = np.zeros((frames, len(PARTS)), bool)
    spans: Iterable[tuple[float, float]] = kept.spans if kept.spans is not None else ((0.0, LONGEST_S),)
    for start, end in spans:
        parts[frame_of(start) : min(frame_of(end) + 1, len(features))] = [part in wanted for part in PARTS]
    return Held(motion, parts)


def _of_pose(keyframe: Keyframe, frames: int) -> Held:
    held = Held.nothing(frames)
    frame = frame_of(keyframe.time)
    if frame < frames:
        held.motion[frame] = ego77.encode(keyframe.pose.resample(ego77.FPS).positions()[:1])[0]
        held.parts[frame] = [part != "global" for part in PARTS]
    return held


def _on_way(features: FloatArray, pins: Sequence[tuple[int, tuple[float, float] | None, float | None]]) -> Held:
    """The root's ways, changed as little and as smoothly as can be so that it is at its pins in time."""
    rows = np.asarray(features, np.float64).copy()
    before = 0
    for frame, place, heading in pins:
        if frame <= before:
            continue
        share = np.sin(np.pi * (np.arange(frame - before) + 0.5) / (frame - before)) ** 2
        share /= share.sum()
        if heading is not None:
            off = (np.radians(heading) - ego77.headings(rows)[frame] + np.pi) % (2 * np.pi) - np.pi
            rows[before:frame, 0] += off * share
        if place is not None:
            x, z = np.array(place) - ego77.decode(rows)[frame, 0, [0, 2]]
            left, forward = ego77.to_body(x * share, z * share, ego77.headings(rows)[before:frame])
            rows[before:frame, 1] += left
            rows[before:frame, 2] += forward
        before = frame
    parts = np.zeros((len(rows), len(PARTS)), bool)
    parts[: before + 1, GLOBAL] = True
    return Held(rows.astype(np.float32), parts)


def _as_high(features: FloatArray, keyframe: Keyframe) -> Held:
    """The pelvis as high as the pose has it at its time, rising or sinking to it over some frames."""
    rows, frame = np.asarray(features, np.float32).copy(), frame_of(keyframe.time)
    held = Held.nothing(len(rows))
    if frame >= len(rows):
        return held
    about, near = _near(frame, len(rows))
    missing = float(keyframe.pose.positions()[0, 0, 1]) - rows[frame, 3]
    rows[about, 3] += (missing * near).astype(np.float32)
    held.parts[about, GLOBAL] = True
    return Held(rows, held.parts)


def _reaching(features: FloatArray, target: Target) -> Held:
    """A limb that reaches its target: its joints are moved there and back over some frames."""
    rows = np.asarray(features, np.float64).copy()
    frame, (side, _, end) = frame_of(target.time), target.joint.partition("_")
    if frame >= len(rows):
        return Held.nothing(len(rows))
    missing = np.array(target.place) - ego77.decode(rows)[frame, SMPL24.index(target.joint)]
    about, near = _near(frame, len(rows))
    left, forward = ego77.to_body(missing[0], missing[2], ego77.headings(rows)[about])
    own = np.stack([left, np.full(len(left), missing[1]), forward], axis=1)
    for joint, share in _ALONG[end].items():
        column = ego77.JOINTS.start + 3 * (SMPL24.index(f"{side}_{joint}") - 1)
        rows[about, column : column + 3] += share * near[:, None] * own
    parts = np.zeros((len(rows), len(PARTS)), bool)
    parts[about, PARTS.index(f"{side} {'arm' if end == 'wrist' else 'leg'}")] = True
    return Held(rows.astype(np.float32), parts)


def _near(frame: int, frames: int) -> tuple[slice, Array]:
    """The frames about one over which something is gone to and left again, and how far it is gone to, 1 at the one."""
    first, last = max(0, frame - _REACH), min(frames, frame + _REACH + 1)
    return slice(first, last), np.cos(0.5 * np.pi * (np.arange(first, last) - frame) / (_REACH + 1)) ** 2
