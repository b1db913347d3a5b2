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

first = bpy.context.active_object
bpy.ops.motionrt.preview(index=1)
seen["still_active"] = bpy.context.active_object is first
ghost = bpy.data.objects["motionrt preview"]
seen["previewed"] = [len(ghost.children), len(ghost.children[0].data.vertices), ghost.animation_data.action.name]
bpy.ops.motionrt.apply(index=0)
seen["preview_gone"] = "motionrt preview" not in bpy.data.objects

scene.frame_set(30)
kept = bpy.context.active_object.animation_data.action
kept_range = list(kept.frame_range)
scene.cursor.location = (0.5, -3.0, 0.0)
bpy.ops.motionrt.walk_to_cursor()
walked = bpy.context.active_object.animation_data.action
seen["kept"] = [walked is not kept, list(kept.frame_range) == kept_range, kept.use_fake_user]

curve = bpy.data.curves.new("way", "CURVE")
curve.dimensions = "3D"
line = curve.splines.new("POLY")
line.points.add(2)
for point, place in zip(line.points, ((0, 0), (0, -3), (2, -4)), strict=True):
    point.co = (*place, 0, 1)
way = bpy.data.objects.new("way", curve)
way.location = (1, 0, 0)
bpy.context.collection.objects.link(way)
scene.motionrt.path = way
scene.frame_set(1)
bpy.ops.motionrt.walk_along()
last = round(bpy.context.active_object.animation_data.action.frame_range[1])
seen["along"] = [joints(frame)["pelvis"] for frame in range(1, last + 1)]

for frame, name in ((11, "walk forward"), (71, "a person walks forward"), (131, "end")):
    scene.timeline_markers.new(name, frame=frame)
bpy.ops.motionrt.generate_timeline(seed=1)
action = bpy.context.active_object.animation_data.action
seen["timeline"] = [action.name, list(action.frame_range), [joints(frame)["pelvis"] for frame in (11, 71, 130)]]

try:
    bpy.ops.motionrt.generate(prompt="  ", seconds=2.0)
except RuntimeError as error:
    seen["refused"] = str(error)
motionrt_blender.unregister()
Path(out).write_text(json.dumps(seen), encoding="utf-8")
