"""Motion files in and out: BVH, glTF, VRM, FBX, ASF/AMC, SMPL and HumanML3D arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.formats.acclaim.amc import read_amc
    from motionrt.formats.acclaim.asf import read_asf
    from motionrt.formats.bvh.read import read_bvh
    from motionrt.formats.bvh.write import write_bvh
    from motionrt.formats.fbx import read_fbx
    from motionrt.formats.folder import animations_of, find_motions
    from motionrt.formats.gltf.read import read_glb
    from motionrt.formats.gltf.write import write_glb
    from motionrt.formats.info import MotionFileInfo, motion_file_info
    from motionrt.formats.leading_pose import drop_leading_tpose
    from motionrt.formats.load import MOTION_SUFFIXES, WRITABLE_SUFFIXES, load_motion, load_rig, save_motion
    from motionrt.formats.numbers import read_npy
    from motionrt.formats.smpl import read_npz, write_npz
    from motionrt.formats.target import RIG_SUFFIXES, load_target

_HOMES = {
    "smpl": ("read_npz", "write_npz"),
    "acclaim.amc": ("read_amc",),
    "acclaim.asf": ("read_asf",),
    "fbx": ("read_fbx",),
    "folder": ("animations_of", "find_motions"),
    "info": ("MotionFileInfo", "motion_file_info"),
    "numbers": ("read_npy",),
    "bvh.read": ("read_bvh",),
    "bvh.write": ("write_bvh",),
    "gltf.read": ("read_glb",),
    "gltf.write": ("write_glb",),
    "leading_pose": ("drop_leading_tpose",),
    "load": ("MOTION_SUFFIXES", "WRITABLE_SUFFIXES", "load_motion", "load_rig", "save_motion"),
    "target": ("RIG_SUFFIXES", "load_target"),
}

__all__ = [
    "MOTION_SUFFIXES",
    "RIG_SUFFIXES",
    "WRITABLE_SUFFIXES",
    "MotionFileInfo",
    "animations_of",
    "drop_leading_tpose",
    "find_motions",
    "load_motion",
    "load_rig",
    "load_target",
    "motion_file_info",
    "read_amc",
    "read_asf",
    "read_bvh",
    "read_fbx",
    "read_glb",
    "read_npy",
    "read_npz",
    "save_motion",
    "write_bvh",
    "write_glb",
    "write_npz",
]

__getattr__ = lazily(__name__, _HOMES)
