"""The keys of a GLB animation, and their values at any time  [glTF 2.0, 3.11 and appendix C]."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.gltf.accessors import GlbArrays
from motionrt.formats.gltf.container import Json
from motionrt.motion.rotations import Array, normalise, slerp

_NO_LENGTH = 1e-6
_SAME_TIME = 1e-5  # seconds
_WIDTHS = {"translation": 3, "rotation": 4}


@dataclass(frozen=True, eq=False)
class Track:
    """Keys of one property of one joint.

    Attributes:
        times: ``(K,)`` seconds, rising.
        values: ``(K, 3)`` or ``(K, 4)`` (xyzw); with tangents ``(K, 3, 3 or 4)``: in, value, out.
        kind: ``LINEAR``, ``STEP`` or ``CUBICSPLINE``.
    """

    times: Array
    values: Array
    kind: str

    def at(self, times: Array) -> Array:
        """Values ``(T, 3 or 4)``: constant before the first and after the last key; quaternions have unit length."""
        if len(self.times) == 1:
            values = np.repeat(self.points, len(times), axis=0)
        else:
            values = self._between(np.clip(times, self.times[0], self.times[-1]))
        return normalise(values) if values.shape[-1] == 4 else values

    @property
    def points(self) -> Array:
        """The values at the keys, without tangents."""
        return self.values[:, 1] if self.kind == "CUBICSPLINE" else self.values

    def _between(self, times: Array) -> Array:
        before = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, len(self.times) - 2)
        span = self.times[before + 1] - self.times[before]
        share = (times - self.times[before]) / np.where(span > 0, span, 1)
        points = self.points
        start, end = points[before], points[before + 1]
        if self.kind == "STEP":
            return np.asarray(np.where(span[:, None] * (1 - share[:, None]) <= _SAME_TIME, end, start))
        if self.kind == "CUBICSPLINE":
            return _hermite(
                start, end, self.values[before, 2], self.values[before + 1, 0], span[:, None], share[:, None]
            )
        if start.shape[-1] == 4:
            return slerp(normalise(start), normalise(end), share)
        return np.asarray(start + share[:, None] * (end - start))


def _hermite(start: Array, end: Array, leaving: Array, arriving: Array, span: Array, s: Array) -> Array:
    return np.asarray(
        (2 * s**3 - 3 * s**2 + 1) * start
        + span * (s**3 - 2 * s**2 + s) * leaving
        + (3 * s**2 - 2 * s**3) * end
        + span * (s**3 - s**2) * arriving
    )


def read_tracks(animation: Json, arrays: GlbArrays, joints: dict[int, int], path: Path) -> dict[tuple[int, str], Track]:
    """Rotation and translation tracks of an animation by ``(joint, property)``; ``joints`` maps nodes to joints."""
    return {
        (joint, what): _read_track(sampler, arrays, what, path) for joint, what, sampler in _samplers(animation, joints)
    }


def count_keys(animation: Json, arrays: GlbArrays, joints: dict[int, int]) -> int:
    """Keys of the longest such track; 0 if the animation moves no joint, 1 if it only holds a pose."""
    samplers = _samplers(animation, joints)
    return max((arrays.count(sampler["input"], "an animation") for _, _, sampler in samplers), default=0)


def _samplers(animation: Json, joints: dict[int, int]) -> Iterator[tuple[int, str, Json]]:
    for channel in animation.get("channels", []):
        target = channel.get("target", {})
        joint, what = joints.get(target.get("node", -1)), target.get("path")
        if joint is not None and what in _WIDTHS:
            yield joint, what, animation["samplers"][channel["sampler"]]


def _read_track(sampler: Json, arrays: GlbArrays, what: str, path: Path) -> Track:
    name, kind = f"a {what} track of the animation", sampler.get("interpolation", "LINEAR")
    if kind not in {"LINEAR", "STEP", "CUBICSPLINE"}:
        raise FormatError(path, f"{name} has the unknown interpolation '{kind}'")
    times, values = arrays.read(sampler["input"], name), arrays.read(sampler["output"], name)
    each = 3 if kind == "CUBICSPLINE" else 1
    if times.ndim != 1 or values.ndim != 2 or values.shape != (each * len(times), _WIDTHS[what]):
        raise FormatError(path, f"{name} has {values.shape[0]} values for {len(times)} keys: the file is damaged")
    if (np.diff(times) < 0).any():
        raise FormatError(path, f"{name} has times that go back")
    track = Track(times, values.reshape(-1, 3, _WIDTHS[what]) if each == 3 else values, kind)
    if what == "rotation" and (np.linalg.norm(track.points, axis=-1) < _NO_LENGTH).any():
        raise FormatError(path, f"{name} has a quaternion without length")
    return track
