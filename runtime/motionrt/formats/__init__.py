"""Motion files in and out: BVH, GLB, ASF/AMC and AMASS npz."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.formats.acclaim import read_amc, read_asf
    from motionrt.formats.bvh import read_bvh, write_bvh
    from motionrt.formats.gltf import read_glb, write_glb
    from motionrt.formats.leading_pose import drop_leading_tpose
    from motionrt.formats.load import MOTION_SUFFIXES, WRITABLE_SUFFIXES, load_motion, load_rig, save_motion
    from motionrt.formats.rig_files import RIG_SUFFIXES
    from motionrt.formats.smpl import read_npz, write_npz
    from motionrt.formats.target import load_target, retarget_to
    from motionrt.rigs.target import Rig, RigMotion

_HOMES = {
    "acclaim": ("read_amc", "read_asf"),
    "bvh": ("read_bvh", "write_bvh"),
    "gltf": ("read_glb", "write_glb"),
    "leading_pose": ("drop_leading_tpose",),
    "load": ("MOTION_SUFFIXES", "WRITABLE_SUFFIXES", "load_motion", "load_rig", "save_motion"),
    "smpl": ("read_npz", "write_npz"),
    "rig_files": ("RIG_SUFFIXES",),
    "target": ("Rig", "RigMotion", "load_target", "retarget_to"),
}

__all__ = [
    "MOTION_SUFFIXES",
    "RIG_SUFFIXES",
    "WRITABLE_SUFFIXES",
    "Rig",
    "RigMotion",
    "drop_leading_tpose",
    "load_motion",
    "load_rig",
    "load_target",
    "read_amc",
    "read_asf",
    "read_bvh",
    "read_glb",
    "read_npz",
    "retarget_to",
    "save_motion",
    "write_bvh",
    "write_glb",
    "write_npz",
]

__getattr__ = lazily(__name__, _HOMES)
