"""Run by Blender: import a motion file and write where every joint is, in metres, Y up, frame by frame."""

from __future__ import annotations

import builtins
import json
import sys
from pathlib import Path

import bpy
import numpy as np

path, scale, out = sys.argv[sys.argv.index("--") + 1 :]
plain_open = builtins.open


def open_without_u(file, mode="r", *arguments, **options):
    """Blender 3.4 opens BVH files with the mode "rU", which Python 3.11 (Debian's choice for it) no longer knows."""
    return plain_open(file, mode.replace("U", ""), *arguments, **options)


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 30
if path.endswith(".bvh"):
    builtins.open = open_without_u
    bpy.ops.import_anim.bvh(filepath=path, global_scale=float(scale), update_scene_fps=True)
    builtins.open = plain_open
else:
    np.bool = bool  # what Blender 3.4's importer calls it; Debian's NumPy 1.24 no longer does
    bpy.ops.import_scene.gltf(filepath=path)
armature = next(thing for thing in scene.objects if thing.type == "ARMATURE")
first, last = map(round, armature.animation_data.action.frame_range)


def places() -> dict[str, list[float]]:
    """Heads of all bones; Blender's Z is up."""
    heads = {bone.name: armature.matrix_world @ bone.head for bone in armature.pose.bones}
    return {name: [head.x, head.z, -head.y] for name, head in heads.items()}


frames = []
for frame in range(first, last + 1):
    scene.frame_set(frame)
    frames.append(places())
Path(out).write_text(json.dumps({"fps": scene.render.fps / scene.render.fps_base, "frames": frames}), encoding="utf-8")
