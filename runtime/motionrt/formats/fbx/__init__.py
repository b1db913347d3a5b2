"""FBX files: read through ``ufbx`` (extra ``fbx``), written through Blender."""

from motionrt.formats.fbx.read import fbx_animations, read_fbx
from motionrt.formats.fbx.write import write_fbx

__all__ = ["fbx_animations", "read_fbx", "write_fbx"]
