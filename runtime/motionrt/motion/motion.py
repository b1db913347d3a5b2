"""``Motion``: an animation of the canonical skeleton as an immutable value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion import checks, transforms
from motionrt.motion.kinematics import fk
from motionrt.motion.skeleton import SMPL24, FloatArray, Skeleton
from motionrt.untrusted.words import shown

if TYPE_CHECKING:
    from motionrt.rigs.target import Rig, RigMotion


@dataclass(frozen=True, eq=False)
class Motion:
    """``F`` frames of a character: Y up, metres, facing +Z in the rest pose, its left is +X.

    Every method returns a new Motion; the arrays are read-only.

    Attributes:
        rotations: ``(F, J, 3, 3)`` float32, each joint's rotation local to its parent.
        root: ``(F, 3)`` float32, position of the pelvis, metres.
        fps: frames per second.
        skeleton: the joint tree, ``smpl24`` unless said otherwise.

    Raises:
        InvalidInputError: wrong shapes, no frames, numbers that are not finite, matrices that are no rotations, a place
            or a frame rate out of range (:mod:`motionrt.limits`).
    """

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
        checks.check_rotations(rotations, self.skeleton.names)
        checks.check_root(root)
        object.__setattr__(self, "rotations", rotations)
        object.__setattr__(self, "root", root)
        object.__setattr__(self, "fps", checks.checked_fps(self.fps))

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
        positions, rotations = fk(self.rotations, self.root, self.skeleton.offsets, self.skeleton.parents)
        for array in (positions, rotations):
            array.setflags(write=False)
        return positions.astype(np.float32, copy=False), rotations.astype(np.float32, copy=False)

    def posed_as(self, other: Motion, offset: FloatArray) -> Motion:
        """The same; takes over the global positions and rotations that ``other``, ``offset`` (3,) away, has found."""
        if "_posed" in vars(other) and "_posed" not in vars(self):
            positions, rotations = other._posed
            positions = positions + offset
            positions.setflags(write=False)
            vars(self)["_posed"] = positions, rotations
        return self

    def positions(self) -> FloatArray:
        """Global joint positions ``(F, J, 3)``, metres, by forward kinematics (computed once)."""
        return self._posed[0]

    def global_rotations(self) -> FloatArray:
        """Global joint rotations ``(F, J, 3, 3)`` (computed once)."""
        return self._posed[1]

    def __getitem__(self, frames: slice) -> Motion:
        """The frames of a slice, as in ``motion[30:90]``."""
        if not isinstance(frames, slice):
            raise InvalidInputError("index a Motion with a slice of frames, as in motion[30:90]")
        return replace(self, rotations=self.rotations[frames], root=self.root[frames])

    def between(self, start_s: float, end_s: float) -> Motion:
        """The frames from ``start_s`` up to ``end_s`` (seconds); at least one frame, clipped to the motion."""
        first = min(max(round(start_s * self.fps), 0), self.frames - 1)
        return self[first : max(round(end_s * self.fps), first + 1)]

    def resample(self, fps: float) -> Motion:
        """The same motion at another frame rate: rotations by slerp, root linearly; the first frame stays the first."""
        return transforms.resample(self, fps)

    def mirror(self) -> Motion:
        """The motion seen in a mirror: left and right exchanged about the plane x = 0."""
        return transforms.mirror(self)

    def canonical(self) -> Motion:
        """Turned and moved in the ground plane so that frame 0 stands above the origin and faces +Z."""
        return transforms.canonical(self)

    def grounded(self) -> Motion:
        """Moved vertically so that the lowest foot of the whole motion touches the floor, y = 0."""
        return transforms.grounded(self)

    def save(self, path: str | Path, *, units: str | None = None, t_pose: bool = False) -> Path:
        """Write the motion to ``path`` in the format that its suffix names (.bvh, .glb, .npz); returns the path.

        Args:
            path: the file.
            units: of a ``.bvh``: ``"cm"`` (unless said otherwise), ``"m"``, ``"mm"`` or ``"in"``.
            t_pose: begin a ``.bvh`` with a frame of the T-pose.
        """
        from motionrt.formats import save_motion  # upwards, so that users need not know the floors

        return save_motion(self, path, units=units, t_pose=t_pose)

    def retarget_to(
        self, rig: Rig | str | Path, *, mapping: Mapping[str, str] | None = None, root_motion: bool | str = False
    ) -> RigMotion:
        """The motion on a character of your own; ``.save("x.glb")`` or ``.save("x.bvh")`` writes it.

        Args:
            rig: his file (.glb, .bvh), or what :func:`motionrt.load_target` made of it.
            mapping: ``smpl24`` joint name -> joint name in the file, for rigs that are not recognised; may be partial.
            root_motion: put travel and heading on the joint above the pelvis, or on the joint of that name.

        Raises:
            MotionFileNotFoundError, FormatError: as :func:`motionrt.load_target`.
            RigError: as :func:`motionrt.rigs.retarget_out.to_rig`.
        """
        from motionrt.formats import load_target
        from motionrt.rigs.retarget_out import to_rig

        target = load_target(rig) if isinstance(rig, str | Path) else rig
        return to_rig(self, target, mapping=mapping, root_motion=root_motion)
