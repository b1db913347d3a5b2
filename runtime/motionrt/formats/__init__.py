"""Motion files in and out: BVH, glTF, VRM, FBX, ASF/AMC, SMPL and HumanML3D arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.formats.acclaim import read_amc, read_asf
    from motionrt.formats.bvh import read_bvh, write_bvh
    from motionrt.formats.character import Character, Dressed, load_character
    from motionrt.formats.fbx import read_fbx
    from motionrt.formats.folder import animations_of, find_motions
    from motionrt.formats.gltf import read_glb, write_glb
    from motionrt.formats.info import MotionFileInfo, motion_file_info
    from motionrt.formats.leading_pose import drop_leading_tpose
    from motionrt.formats.load import MOTION_SUFFIXES, WRITABLE_SUFFIXES, load_motion, load_rig, save_motion
    from motionrt.formats.numbers import read_npy
    from motionrt.formats.rig_files import RIG_SUFFIXES
    from motionrt.formats.smpl import read_npz, write_npz
    from motionrt.formats.target import load_target, retarget_to
    from motionrt.rigs.target import Rig, RigMotion

_HOMES = {
    "acclaim": ("read_amc", "read_asf"),
    "bvh": ("read_bvh", "write_bvh"),
    "character": ("Character", "Dressed", "load_character"),
    "fbx": ("read_fbx",),
    "folder": ("animations_of", "find_motions"),
    "gltf": ("read_glb", "write_glb"),
    "info": ("MotionFileInfo", "motion_file_info"),
    "numbers": ("read_npy",),
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
    "Character",
    "Dressed",
    "MotionFileInfo",
    "Rig",
    "RigMotion",
    "animations_of",
    "drop_leading_tpose",
    "find_motions",
    "load_character",
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
    "retarget_to",
    "save_motion",
    "write_bvh",
    "write_glb",
    "write_npz",
]

__getattr__ = lazily(__name__, _HOMES)
