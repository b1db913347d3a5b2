"""Foreign skeletons: what their joints are called and do, how they stand, and motions from them and onto them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.rigs.clip import RigClip
    from motionrt.rigs.retarget_in import to_smpl24
    from motionrt.rigs.retarget_out import to_rig
    from motionrt.rigs.target import Rig, RigFile, RigMotion

_HOMES = {
    "clip": ("RigClip",),
    "retarget_in": ("to_smpl24",),
    "retarget_out": ("to_rig",),
    "target": ("Rig", "RigFile", "RigMotion"),
}

__all__ = ["Rig", "RigClip", "RigFile", "RigMotion", "to_rig", "to_smpl24"]

__getattr__ = lazily(__name__, _HOMES)
