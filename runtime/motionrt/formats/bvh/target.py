"""Another motion in a user's BVH file: his hierarchy to the letter, his channels, new numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.atomic import write_bytes
from motionrt.formats.bvh.euler import euler_degrees
from motionrt.formats.bvh.hierarchy import BvhJoint
from motionrt.formats.bvh.read import BvhText
from motionrt.formats.bvh.rig import joints_with_differences
from motionrt.formats.bvh.write import value_rows
from motionrt.formats.gltf.write import write_rig_glb
from motionrt.formats.units import to_metres
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.rigs.target import RigMotion


@dataclass(frozen=True, eq=False)
class BvhFile:
    """The BVH file of a rig.

    Attributes:
        path: where it is.
        text: what it says.
        clip: what that means.
    """

    path: Path
    text: BvhText
    clip: RigClip

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """See :meth:`motionrt.rigs.target.RigMotion.save`."""
        suffix = path.suffix.lower()
        if suffix not in {".bvh", ".glb"}:
            raise InvalidInputError(f"{path}: a motion of a rig is written as .bvh or .glb")
        if units is not None:
            raise InvalidInputError(f"units do not apply: a .bvh keeps those of {self.path.name}, a .glb is in metres")
        if suffix == ".glb":
            if t_pose:
                raise InvalidInputError("t_pose is for .bvh; a .glb knows its rest pose")
            return write_rig_glb(to_metres(motion), path)
        return self._write(with_rest_frame(motion.clip) if t_pose else motion.clip, path)

    def _write(self, clip: RigClip, path: Path) -> Path:
        offsets = np.array([joint.offset or (0.0, 0.0, 0.0) for joint in self.text.joints])
        relative = set(joints_with_differences(self.text.joints, offsets, self._declared(offsets)))
        columns = []
        for j, joint in enumerate(self.text.joints):
            if joint.channels:
                places = clip.translations[:, j] - (offsets[j] if j in relative else 0)
                columns.append(_channels(joint, clip.rotations[:, j], places, self.path))
        rows = value_rows(np.concatenate(columns, axis=1))
        head = [self.text.hierarchy.rstrip("\n"), "MOTION", f"Frames: {clip.frames}"]
        content = "\n".join([*head, f"Frame Time: {1 / clip.fps:.10f}", *rows, ""]).encode("utf-8")
        return write_bytes(path, content)

    def _declared(self, offsets: np.ndarray) -> np.ndarray:
        """Translations ``(F, J, 3)`` as the file's own numbers give them."""
        out, column = np.tile(offsets, (len(self.text.values), 1, 1)), 0
        for j, joint in enumerate(self.text.joints):
            for i, axis in joint.positions:
                out[:, j, axis] = self.text.values[:, column + i]
            column += len(joint.channels)
        return out


def with_rest_frame(clip: RigClip) -> RigClip:
    """``clip`` with its rest pose as a first frame, standing where the motion starts."""
    translations = np.concatenate([clip.offsets[None], clip.translations])
    away = np.abs(clip.translations[0] - clip.offsets).max(axis=-1) > 1e-6
    translations[0, away] = clip.translations[0, away]
    rotations = np.concatenate([clip.rest_rotations()[None], clip.rotations])
    return replace(clip, rotations=rotations, translations=translations)


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
