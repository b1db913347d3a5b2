"""What is measured of files: a BVH read and written, and a folder of them indexed."""

from __future__ import annotations

from pathlib import Path

from motionrt.bench.timing import Call
from motionrt.formats import load_motion
from motionrt.locomotion.starting_poses import plain_stride
from motionrt.runtime import Runtime

SECONDS, CLIPS = 10.0, 8
LOAD, SAVE = f"load a BVH of {SECONDS:.0f} s", f"save a BVH of {SECONDS:.0f} s"
GALLERY = f"gallery building, per clip of {SECONDS:.0f} s"


def file_calls(folder: Path) -> dict[str, Call]:
    """A walk at 30 fps saved to ``folder``, and loaded from it."""
    walk = plain_stride(SECONDS)
    path = walk.save(folder / "walk.bvh")
    return {LOAD: lambda: load_motion(path), SAVE: lambda: walk.save(folder / "again.bvh")}


def gallery_call(runtime: Runtime, folder: Path) -> Call:
    """A folder of 8 walks indexed from scratch by one process."""
    library, out = folder / "library", folder / "gallery"
    library.mkdir(exist_ok=True)
    walk = plain_stride(SECONDS)
    for number in range(CLIPS):
        walk[number:].save(library / f"walk-{number}.bvh")
    return lambda: runtime.build_gallery(library, out)
