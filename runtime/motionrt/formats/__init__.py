"""Motion files in and out: BVH, ASF/AMC and AMASS npz."""

from __future__ import annotations

from motionrt.formats.amass import read_npz, write_npz
from motionrt.formats.amc import read_amc
from motionrt.formats.asf import read_asf
from motionrt.formats.bvh import read_bvh
from motionrt.formats.bvh_write import write_bvh
from motionrt.formats.leading_pose import drop_leading_tpose
from motionrt.formats.load import MOTION_SUFFIXES, WRITABLE_SUFFIXES, load_motion, load_rig, save_motion

__all__ = [
    "MOTION_SUFFIXES",
    "WRITABLE_SUFFIXES",
    "drop_leading_tpose",
    "load_motion",
    "load_rig",
    "read_amc",
    "read_asf",
    "read_bvh",
    "read_npz",
    "save_motion",
    "write_bvh",
    "write_npz",
]
