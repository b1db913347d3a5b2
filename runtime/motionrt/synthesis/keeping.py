"""What constraints ask of features: clips and poses kept as they are; ways, heights and limbs changed for places."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.canvas import Held

GLOBAL = PARTS.index("global")
_REACH = 7  # frames before and after a target over which a limb goes to it and returns
_ALONG = {"wrist": {"wrist": 1.0, "hand": 1.0, "elbow": 0.5}, "ankle": {"ankle": 1.0, "foot": 1.0, "knee": 0.5}}

Array = npt.NDArray[np.float64]
Pin = tuple[int, tuple[float, float] | None, float | None]
"""A frame, the place wanted there, and the heading in degrees; None leaves one open."""


def of_clip(clip: Motion, wanted: frozenset[str], spans: Sequence[tuple[int, int]], frames: int) -> Held:
    """Parts of a clip over spans of frames at 20 fps, both ends included."""
    features = ego77.encode(clip.resample(ego77.FPS).positions())[:frames]
    motion = np.zeros((frames, ego77.WIDTH), np.float32)
    motion[: len(features)] = features
    parts = np.zeros((frames, len(PARTS)), bool)
    for start, end in spans:
        parts[start : min(end + 1, len(features))] = [part in wanted for part in PARTS]
    return Held(motion, parts)


def of_pose(pose: Motion, frame: int, frames: int) -> Held:
    """The first frame of a motion, without its way, at a frame."""
    held = Held.nothing(frames)
    if frame < frames:
        held.motion[frame] = ego77.encode(pose.resample(ego77.FPS).positions()[:1])[0]
        held.parts[frame] = [part != "global" for part in PARTS]
    return held


def on_way(features: FloatArray, pins: Sequence[Pin]) -> Held:
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


def as_high(features: FloatArray, frame: int, height: float) -> Held:
    """The pelvis so high at a frame, metres, rising or sinking to it over some frames."""
    rows = np.asarray(features, np.float32).copy()
    held = Held.nothing(len(rows))
    if frame >= len(rows):
        return held
    about, near = _near(frame, len(rows))
    missing = height - rows[frame, 3]
    rows[about, 3] += (missing * near).astype(np.float32)
    held.parts[about, GLOBAL] = True
    return Held(rows, held.parts)


def reaching(features: FloatArray, frame: int, joint: str, place: tuple[float, float, float]) -> Held:
    """A limb whose end is at a place at a frame: its joints are moved there and back over some frames."""
    rows = np.asarray(features, np.float64).copy()
    side, _, end = joint.partition("_")
    if frame >= len(rows):
        return Held.nothing(len(rows))
    missing = np.array(place) - ego77.decode(rows)[frame, SMPL24.index(joint)]
    about, near = _near(frame, len(rows))
    left, forward = ego77.to_body(missing[0], missing[2], ego77.headings(rows)[about])
    own = np.stack([left, np.full(len(left), missing[1]), forward], axis=1)
    for part, share in _ALONG[end].items():
        column = ego77.column(SMPL24.index(f"{side}_{part}"))
        rows[about, column : column + 3] += share * near[:, None] * own
    parts = np.zeros((len(rows), len(PARTS)), bool)
    parts[about, PARTS.index(f"{side} {'arm' if end == 'wrist' else 'leg'}")] = True
    return Held(rows.astype(np.float32), parts)


def _near(frame: int, frames: int) -> tuple[slice, Array]:
    """The frames about one over which something is gone to and left again, and how far it is gone to, 1 at the one."""
    first, last = max(0, frame - _REACH), min(frames, frame + _REACH + 1)
    return slice(first, last), np.cos(0.5 * np.pi * (np.arange(first, last) - frame) / (_REACH + 1)) ** 2
