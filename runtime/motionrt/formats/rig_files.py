"""The file that a rig came from, as what writes motions of that rig: in its own format, or anew in the other one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.formats.atomic import write_atomically, write_bytes
from motionrt.formats.bvh.target import BvhTarget
from motionrt.formats.bvh.write import write_rig_bvh
from motionrt.formats.fbx.write import fbx_of_glb
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.gltf.target import GlbTarget
from motionrt.formats.gltf.write import write_rig_glb
from motionrt.formats.units import to_metres, units_per_metre
from motionrt.rigs.clip import RigClip
from motionrt.rigs.target import RigMotion
from motionrt.untrusted.outputs import checked_output

RIG_SUFFIXES = (".bvh", ".fbx", *GLTF_SUFFIXES)
"""Files that can be targets of retargeting."""

_WRITTEN = (".bvh", ".glb", ".fbx")
"""What motions of them are written as."""


@dataclass(frozen=True, eq=False)
class BvhRigFile:
    """Writes motions of a rig that came from a BVH."""

    target: BvhTarget

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """See :meth:`motionrt.rigs.target.RigMotion.save`."""
        suffix, name = _rig_suffix(path), self.target.path.name
        if units is not None:
            raise InvalidInputError(f"units do not apply: a .bvh keeps those of {name}, a .glb is in metres")
        if suffix == ".bvh":
            lines = self.target.with_animation(_clip(motion, t_pose))
            return write_atomically(path, lambda file: file.writelines(lines))
        if t_pose:
            raise InvalidInputError("t_pose is for .bvh; a .glb knows its rest pose")
        return _in_glb(path, motion.fps, lambda glb, fps: write_rig_glb(_at(to_metres(motion), fps), glb))


@dataclass(frozen=True, eq=False)
class GlbRigFile:
    """Writes motions of a rig that came from a GLB."""

    target: GlbTarget

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """See :meth:`motionrt.rigs.target.RigMotion.save`."""
        if _rig_suffix(path) == ".bvh":
            scale = units_per_metre(units or "cm")
            return write_rig_bvh(_clip(motion, t_pose), path, scale=scale)
        if units not in {None, "m"} or t_pose:
            raise InvalidInputError("units= and t_pose= are for a .bvh; a .glb is in metres and knows its rest pose")

        def write(glb: Path, fps: float) -> Path:
            return write_bytes(glb, self.target.with_animation(_at(motion.clip, fps), path.stem))

        return _in_glb(path, motion.fps, write)


@dataclass(frozen=True, eq=False)
class FbxRigFile:
    """Writes motions of a rig that came from an FBX: skeleton and animation, anew."""

    path: Path

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """See :meth:`motionrt.rigs.target.RigMotion.save`."""
        suffix, clip = _rig_suffix(path), to_metres(motion)
        if suffix == ".bvh":
            written = with_rest_frame(clip) if t_pose else clip
            return write_rig_bvh(written, path, scale=units_per_metre(units or "cm"))
        if units not in {None, "m"} or t_pose:
            raise InvalidInputError("units= and t_pose= are for a .bvh; a .glb is in metres and knows its rest pose")
        return _in_glb(path, motion.fps, lambda glb, fps: write_rig_glb(_at(clip, fps), glb))


def _rig_suffix(path: Path) -> str:
    return checked_output(path, _WRITTEN, "written with a motion of a rig").suffix.lower()


def _in_glb(path: Path, fps: float, write: Callable[[Path, float], Path]) -> Path:
    """Write a ``.glb``, or by way of one an ``.fbx``."""
    return write(path, fps) if path.suffix.lower() == ".glb" else fbx_of_glb(path, fps, write)


def _at(clip: RigClip, fps: float) -> RigClip:
    return replace(clip, fps=fps)


def _clip(motion: RigMotion, t_pose: bool) -> RigClip:
    return with_rest_frame(motion.clip) if t_pose else motion.clip


def with_rest_frame(clip: RigClip) -> RigClip:
    """``clip`` with its rest pose as a first frame, standing where the motion starts."""
    translations = np.concatenate([clip.offsets[None], clip.translations])
    away = np.abs(clip.translations[0] - clip.offsets).max(axis=-1) > 1e-6
    translations[0, away] = clip.translations[0, away]
    rotations = np.concatenate([clip.rest_rotations()[None], clip.rotations])
    return replace(clip, rotations=rotations, translations=translations)
