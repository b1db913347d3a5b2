"""BVH files: read, written, and a motion in the hierarchy of a file that exists (`target`)."""

from motionrt.formats.bvh.read import read_bvh
from motionrt.formats.bvh.write import write_bvh

__all__ = ["read_bvh", "write_bvh"]
