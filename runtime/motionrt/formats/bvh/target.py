"""Another motion in a BVH file that exists: its hierarchy to the letter, its channels, new numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.bvh.euler import euler_degrees
from motionrt.formats.bvh.hierarchy import BvhJoint
from motionrt.formats.bvh.read import BvhText
from motionrt.formats.bvh.rig import joints_with_differences
from motionrt.formats.bvh.write import value_rows, written_lines
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip


@dataclass(frozen=True, eq=False)
class BvhTarget:
    """The BVH file of a rig.

    Attributes:
        path: where it is.
        text: what it says.
        clip: what that means.
    """

    path: Path
    text: BvhText
    clip: RigClip

    def with_animation(self, clip: RigClip) -> Iterator[bytes]:
        """The file with the frames of ``clip`` in the place of its own, line by line."""
        offsets = np.array([joint.offset or (0.0, 0.0, 0.0) for joint in self.text.joints])
        relative = set(joints_with_differences(self.text.joints, offsets, self._declared(offsets)))
        columns = []
        for j, joint in enumerate(self.text.joints):
            if joint.channels:
                places = clip.translations[:, j] - (offsets[j] if j in relative else 0)
                columns.append(_channels(joint, clip.rotations[:, j], places, self.path))
        head = [
            self.text.hierarchy.rstrip("\n"),
            "MOTION",
            f"Frames: {clip.frames}",
            f"Frame Time: {1 / clip.fps:.10f}",
        ]
        return written_lines(chain(head, value_rows(columns)))

    def _declared(self, offsets: np.ndarray) -> np.ndarray:
        """Translations ``(F, J, 3)`` as the file's own numbers give them."""
        out, column = np.tile(offsets, (len(self.text.values), 1, 1)), 0
        for j, joint in enumerate(self.text.joints):
            for i, axis in joint.positions:
                out[:, j, axis] = self.text.values[:, column + i]
            column += len(joint.channels)
        return out


def _channels(joint: BvhJoint, rotations: FloatArray, places: np.ndarray, path: Path) -> np.ndarray:
    """Values ``(F, C)`` of the channels of one joint, in its own order."""
    order = joint.rotation_order
    if len(set(order)) < len(order):
        raise FormatError(path, f"joint '{joint.name}' turns twice about one axis ({order}); that cannot be written")
    angles = euler_degrees(rotations, order + "".join(axis for axis in "ZXY" if axis not in order))
    out = np.empty((len(rotations), len(joint.channels)))
    for place, channel in enumerate(joint.rotations):
        out[:, channel] = angles[:, place]
    for channel, axis in joint.positions:
        out[:, channel] = places[:, axis]
    return out
