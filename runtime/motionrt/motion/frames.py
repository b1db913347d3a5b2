"""Frames of a skeleton as an immutable value: what :class:`motionrt.Motion` holds, before any transform of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion import checks
from motionrt.motion.batches import BATCH, by_batches
from motionrt.motion.kinematics import fk
from motionrt.motion.skeleton import SMPL24, FloatArray, Skeleton
from motionrt.untrusted.words import shown

if TYPE_CHECKING:
    from typing_extensions import Self  # of typing from Python 3.11 on


@dataclass(frozen=True, eq=False)
class Frames:
    """The arrays of a motion, checked, and the global pose that they mean; see :class:`motionrt.Motion`."""

    rotations: FloatArray
    root: FloatArray
    fps: float
    skeleton: Skeleton = SMPL24

    def __post_init__(self) -> None:
        if not isinstance(self.skeleton, Skeleton):
            raise InvalidInputError(f"skeleton must be a Skeleton, not {shown(self.skeleton)}")
        rotations = checks.frozen(self.rotations, "rotations", (len(self.skeleton), 3, 3))
        root = checks.frozen(self.root, "root", (3,))
        if len(rotations) != len(root):
            raise InvalidInputError(f"rotations have {len(rotations)} frames but root has {len(root)}")
        fps = checks.checked_fps(self.fps)
        checks.check_rotations(rotations, self.skeleton.names)
        checks.check_root(root)
        object.__setattr__(self, "rotations", rotations)
        object.__setattr__(self, "root", root)
        object.__setattr__(self, "fps", fps)

    def __repr__(self) -> str:
        return f"Motion({self.frames} frames, {self.duration:.2f} s at {self.fps:g} fps, {len(self.skeleton)} joints)"

    @property
    def frames(self) -> int:
        """Number of frames ``F``."""
        return len(self.root)

    @property
    def duration(self) -> float:
        """Seconds that the motion plays: ``F / fps``."""
        return self.frames / self.fps

    @cached_property
    def _posed(self) -> tuple[FloatArray, FloatArray]:
        positions = np.empty((*self.rotations.shape[:2], 3), np.float32)
        rotations = np.empty(self.rotations.shape, np.float32)
        for start in range(0, self.frames, BATCH):
            part = slice(start, start + BATCH)
            posed = fk(self.rotations[part], self.root[part], self.skeleton.offsets, self.skeleton.parents)
            positions[part], rotations[part] = posed
        for array in (positions, rotations):
            array.setflags(write=False)
        return positions, rotations

    def posed_as(self, other: Frames, offset: FloatArray) -> Self:
        """The same; takes over the global positions and rotations that ``other``, ``offset`` (3,) away, has found."""
        if "_posed" in vars(other) and "_posed" not in vars(self):
            positions, rotations = other._posed
            positions = by_batches(lambda part: part + offset, positions)
            positions.setflags(write=False)
            vars(self)["_posed"] = positions, rotations
        return self

    def positions(self) -> FloatArray:
        """Global joint positions ``(F, J, 3)``, metres, by forward kinematics (computed once)."""
        return self._posed[0]

    def global_rotations(self) -> FloatArray:
        """Global joint rotations ``(F, J, 3, 3)`` (computed once)."""
        return self._posed[1]

    def __getitem__(self, frames: slice) -> Self:
        """The frames of a slice, as in ``motion[30:90]``."""
        if not isinstance(frames, slice):
            raise InvalidInputError("index a Motion with a slice of frames, as in motion[30:90]")
        return replace(self, rotations=self.rotations[frames], root=self.root[frames])

    def between(self, start_s: float, end_s: float) -> Self:
        """The frames from ``start_s`` up to ``end_s`` (seconds); at least one frame, clipped to the motion."""
        first = min(max(round(start_s * self.fps), 0), self.frames - 1)
        return self[first : max(round(end_s * self.fps), first + 1)]
