"""GLB files (binary glTF 2.0): read, written, and an animation in a character's file (`target`)."""

from motionrt.formats.gltf.read import read_glb
from motionrt.formats.gltf.write import write_glb

__all__ = ["read_glb", "write_glb"]
