"""A character of the user's own as a target: his rig, and a motion of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.arguments import check_flags, check_kind
from motionrt.untrusted.files import as_path


class RigFile(Protocol):
    """The file that a rig came from: it knows how to hold another animation."""

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """Write ``motion`` to ``path``; everything else as the file has it."""


@dataclass(frozen=True, eq=False)
class Rig:
    """A rig to retarget to; :func:`motionrt.formats.load_target` reads one.

    Attributes:
        clip: its joints, in the file's unit and axes, and the frames that the file holds (at least one).
        poses: local rotations ``(J, 3, 3)`` of poses that may be its standing pose, the likeliest first.
        movable: ``(J,)``, which joints the file lets be translated.
        file: writes motions of this rig.
    """

    clip: RigClip
    poses: Sequence[FloatArray]
    movable: Sequence[bool]
    file: RigFile


@dataclass(frozen=True, eq=False)
class RigMotion:
    """A motion of a user's rig.

    Attributes:
        clip: every joint's rotations and translations, the file's unit and axes; its rest pose is the one that the rig
            stands in.
        rig: whose motion it is.
        units_per_metre: the size of the rig: its units per metre of ``smpl24``, by the length of the legs.
        up: ``(3,)``, the vertical in the file's axes.
        sole: height of its toe joints above the floor while it stands on its soles, the rig's units.
        to_world: ``(3, 3)``, from the file's axes to ours, Y up.
    """

    clip: RigClip
    rig: Rig
    units_per_metre: float
    up: FloatArray
    sole: float
    to_world: FloatArray

    def __repr__(self) -> str:
        return f"RigMotion({self.frames} frames at {self.fps:g} fps, {len(self.clip.names)} joints)"

    @property
    def frames(self) -> int:
        """Number of frames ``F``."""
        return self.clip.frames

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self.clip.fps

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.frames / self.fps

    @property
    def names(self) -> tuple[str, ...]:
        """Joint names ``J``."""
        return self.clip.names

    def positions(self) -> FloatArray:
        """Global joint positions ``(F, J, 3)`` in the unit and axes of the rig's file."""
        return self.clip.global_pose()[0]

    def save(self, path: str | Path, *, units: str | None = None, t_pose: bool = False) -> Path:
        """Write the motion as ``.bvh`` or ``.glb``; returns the path.

        In the format of the rig's own file everything but the animation stays as it is there: hierarchy, names, rest
        pose, units, channels; meshes, skins, materials and other animations of a GLB. In the other format the skeleton
        is written anew (a GLB in metres, Y up, with octahedra for bones).

        Args:
            path: the file.
            units: of a BVH made from a GLB: ``"cm"`` (unless said otherwise), ``"m"``, ``"mm"`` or ``"in"``.
            t_pose: begin a BVH with a frame of the pose that the rig stands in.

        Raises:
            InvalidInputError: another suffix, options that do not apply, or the file cannot be written.
        """
        check_flags(t_pose=t_pose)
        check_kind(units, str | None, "units", "the name of a unit")
        return self.rig.file.save(self, as_path(path), units=units, t_pose=t_pose)
