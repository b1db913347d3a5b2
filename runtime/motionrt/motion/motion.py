"""``Motion``: an animation of the canonical skeleton as an immutable value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.motion import transforms
from motionrt.motion.frames import Frames

if TYPE_CHECKING:
    from motionrt.formats import Rig, RigMotion


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Frames):
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

    def _repr_html_(self) -> str:
        """A strip of poses, for notebooks."""
        from motionrt.motion.notebook import page, strip

        return page(repr(self), strip(self))

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

    def in_place(self) -> Motion:
        """Without its way over the ground, as for games that move the character themselves; sway and turns stay."""
        return transforms.in_place(self)

    def save(self, path: str | Path, *, units: str | None = None, t_pose: bool = False) -> Path:
        """Write the motion to ``path`` in the format that its suffix names (.bvh, .glb, .npz); returns the path.

        Args:
            path: the file.
            units: of a ``.bvh``: ``"cm"`` (unless said otherwise), ``"m"``, ``"mm"`` or ``"in"``.
            t_pose: begin a ``.bvh`` with a frame of the T-pose.
        """
        from motionrt.formats import save_motion  # the one way up: who holds a motion need not know where writers live

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
        from motionrt.formats import retarget_to

        return retarget_to(self, rig, mapping=mapping, root_motion=root_motion)
