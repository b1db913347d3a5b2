"""ASF/AMC in (Acclaim, the format of the CMU database): skeleton in one file, motion in the other."""

from __future__ import annotations

from motionrt.formats.amc import read_amc
from motionrt.formats.asf import AsfSkeleton, Bone, read_asf
from motionrt.formats.asf_search import DEFAULT_FPS, find_asf, find_fps

__all__ = ["DEFAULT_FPS", "AsfSkeleton", "Bone", "find_asf", "find_fps", "read_amc", "read_asf"]
