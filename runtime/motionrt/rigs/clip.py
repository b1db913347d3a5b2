"""What a motion file held, before any retargeting: an arbitrary joint tree and its animation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.kinematics import fk
from motionrt.motion.skeleton import FloatArray


@dataclass(frozen=True, eq=False)
class RigClip:
    """An animated rig in the units and axes of its file.

    Attributes:
        names: ``J`` joint names, parents before children; an end site is a leaf called ``<parent>_end``.
        parents: ``J`` parent indices, ``-1`` for the root.
        offsets: ``(J, 3)`` rest-pose offsets from the parent, file units.
        rotations: ``(F, J, 3, 3)`` float32, local to the parent.
        translations: ``(F, J, 3)`` float32, local translation of each joint, file units (its offset, unless the file
            animates it).
        fps: frames per second.
        up: ``"y"`` or ``"z"`` where the format fixes the vertical axis, else ``None``.
        metres_per_unit: where the format fixes the unit, else ``None``.
        rest: ``(J, 3, 3)`` local rotations of the rest pose where the format has one (the bind pose of glTF); ``None``
            where the rest pose is the one without rotations (BVH).
        known: ``smpl24`` joint name -> joint name, where the file itself says so (the humanoid map of a VRM).
        notes: what in the file was not taken at its word, in words.

    Raises:
        InvalidInputError: shapes that do not belong together, or a frame rate that is not positive.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: FloatArray
    rotations: FloatArray
    translations: FloatArray
    fps: float
    up: str | None = None
    metres_per_unit: float | None = None
    rest: FloatArray | None = None
    known: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        joints = len(self.names)
        if self.offsets.shape != (joints, 3) or self.rotations.shape[1:] != (joints, 3, 3):
            raise InvalidInputError("a RigClip needs offsets (J, 3) and rotations (F, J, 3, 3) for its J names")
        if self.translations.shape != self.rotations.shape[:-1]:
            raise InvalidInputError("a RigClip needs translations (F, J, 3)")
        if self.rest is not None and self.rest.shape != (joints, 3, 3):
            raise InvalidInputError("the rest pose of a RigClip has the shape (J, 3, 3)")
        if not np.isfinite(self.fps) or self.fps <= 0:
            raise InvalidInputError(f"frame rate must be positive, not {self.fps}")

    @property
    def frames(self) -> int:
        """Number of frames ``F``."""
        return int(self.rotations.shape[0])

    def global_pose(self) -> tuple[FloatArray, FloatArray]:
        """Global positions ``(F, J, 3)`` in file units and rotations ``(F, J, 3, 3)``."""
        positions, rotations = fk(self.rotations, self.translations[:, 0], self.translations, self.parents)
        return positions.astype(np.float32), rotations.astype(np.float32)

    def rest_rotations(self) -> FloatArray:
        """``(J, 3, 3)`` local rotations of the rest pose: ``rest``, or none at all."""
        if self.rest is not None:
            return self.rest
        return np.tile(np.eye(3, dtype=np.float32), (len(self.names), 1, 1))

    def rest_pose(self) -> tuple[FloatArray, FloatArray]:
        """Global positions ``(J, 3)`` in file units and rotations ``(J, 3, 3)`` at rest, root at its offset."""
        positions, rotations = fk(self.rest_rotations(), self.offsets[0], self.offsets, self.parents)
        return positions.astype(np.float32), rotations.astype(np.float32)

    def rest_positions(self) -> FloatArray:
        """``(J, 3)`` joint positions of :meth:`rest_pose`."""
        return self.rest_pose()[0]

    def slice(self, start: int, stop: int | None = None) -> RigClip:
        """The frames ``start:stop`` as a clip of their own."""
        part = slice(start, stop)
        return replace(self, rotations=self.rotations[part], translations=self.translations[part])
