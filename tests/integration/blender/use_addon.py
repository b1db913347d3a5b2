"""Run by Blender: use the add-on as an artist would, headless, and write down what came of it."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy

addon_folder, out = sys.argv[sys.argv.index("--") + 1 :]
sys.path.insert(0, addon_folder)
import motionrt_blender  # noqa: E402

motionrt_blender.register()
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
seen = {}


def joints(frame: int) -> dict[str, list[float]]:
    """Where the active armature's bones begin in the world."""
    scene.frame_set(frame)
    armature = bpy.context.active_object
    return {bone.name: list(armature.matrix_world @ bone.head) for bone in armature.pose.bones}


bpy.ops.motionrt.search(query="a person walks in a circle", count=5)
seen["hits"] = [[hit.clip, hit.score] for hit in scene.motionrt.hits]

scene.render.fps = 30
bpy.ops.motionrt.generate(prompt="a person waves with the right hand", seconds=2.0, seed=1)
seen["generated"] = [joints(1 + frame) for frame in range(60)]

scene.frame_set(60)
scene.cursor.location = (1.5, -4.0, 0.0)
bpy.ops.motionrt.walk_to_cursor()
action = bpy.context.active_object.animation_data.action
last = round(action.frame_range[1])
seen["walk"] = [joints(frame) for frame in range(60, last + 1)]

scene.frame_set(1)
bpy.ops.motionrt.apply(index=0)
seen["applied"] = bpy.context.active_object.animation_data.action.name

try:
    bpy.ops.motionrt.generate(prompt="  ", seconds=2.0)
except RuntimeError as error:
    seen["refused"] = str(error)
motionrt_blender.unregister()
Path(out).write_text(json.dumps(seen), encoding="utf-8")
