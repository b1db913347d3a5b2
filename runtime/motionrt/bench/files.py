"""What is measured of files: BVH, GLB and FBX read, a BVH written, and a folder of them indexed."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from motionrt.bench.timing import Call
from motionrt.formats import load_motion
from motionrt.formats.fbx.write import can_write_fbx
from motionrt.locomotion.starting_poses import plain_stride
from motionrt.runtime import Runtime

SECONDS, CLIPS = 10.0, 8
LOAD, SAVE = f"load a BVH of {SECONDS:.0f} s", f"save a BVH of {SECONDS:.0f} s"
LOAD_GLB, LOAD_FBX = f"load a GLB of {SECONDS:.0f} s", f"load an FBX of {SECONDS:.0f} s"
GALLERY = f"gallery building, per clip of {SECONDS:.0f} s"


def file_calls(folder: Path) -> dict[str, Call]:
    """A walk at 30 fps saved to ``folder``, and loaded from it; FBX only where ``ufbx`` and Blender are there."""
    walk = plain_stride(SECONDS)
    bvh, glb = walk.save(folder / "walk.bvh"), walk.save(folder / "walk.glb")
    calls: dict[str, Call] = {LOAD: lambda: load_motion(bvh), LOAD_GLB: lambda: load_motion(glb)}
    if can_write_fbx() and find_spec("ufbx") is not None:
        fbx = walk.save(folder / "walk.fbx")
        calls[LOAD_FBX] = lambda: load_motion(fbx)
    return {**calls, SAVE: lambda: walk.save(folder / "again.bvh")}


def gallery_call(runtime: Runtime, folder: Path) -> Call:
    """A folder of 8 walks indexed from scratch by one process."""
    library, out = folder / "library", folder / "gallery"
    library.mkdir(exist_ok=True)
    walk = plain_stride(SECONDS)
    for number in range(CLIPS):
        walk[number:].save(library / f"walk-{number}.bvh")
    return lambda: runtime.build_gallery(library, out)
