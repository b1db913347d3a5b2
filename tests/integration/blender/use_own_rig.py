"""Run by Blender: the add-on on an artist's rig: Mixamo's names, centimetres, Y up, rolled bones, turned and scaled."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import bpy
from mathutils import Vector

addon_folder, out = sys.argv[sys.argv.index("--") + 1 :]
sys.path.insert(0, addon_folder)
import motionrt_blender  # noqa: E402

TRUNK = {
    "Hips": (None, (0, 100, 0)),
    "Spine": ("Hips", (0, 112, 0)),
    "Spine1": ("Spine", (0, 124, 0)),
    "Spine2": ("Spine1", (0, 136, 0)),
    "Neck": ("Spine2", (0, 152, 0)),
    "Head": ("Neck", (0, 162, 2)),
}
SIDE = {
    "Shoulder": ("Spine2", (6, 148, 0)),
    "Arm": ("Shoulder", (18, 147, 0)),
    "ForeArm": ("Arm", (46, 147, 0)),
    "Hand": ("ForeArm", (72, 147, 0)),
    "HandIndex1": ("Hand", (80, 147, 0)),
    "UpLeg": ("Hips", (9, 94, 0)),
    "Leg": ("UpLeg", (9, 52, 0)),
    "Foot": ("Leg", (9, 9, -2)),
    "ToeBase": ("Foot", (9, 2, 12)),
}


def joints() -> dict[str, tuple[str | None, tuple[float, float, float]]]:
    """Name -> parent and place in centimetres."""
    table = dict(TRUNK)
    for side, sign in (("Left", 1), ("Right", -1)):
        for name, (parent, (x, y, z)) in SIDE.items():
            table[side + name] = (parent if parent in TRUNK else side + parent, (sign * x, y, z))
    return {f"mixamorig:{name}": (parent and f"mixamorig:{parent}", place) for name, (parent, place) in table.items()}


def build() -> bpy.types.Object:
    """The armature, active."""
    table = joints()
    armature = bpy.data.objects.new("artist's", bpy.data.armatures.new("artist's"))
    bpy.context.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for number, (name, (parent, place)) in enumerate(table.items()):
        bone = armature.data.edit_bones.new(name)
        bone.head = place
        children = [child for _, (of, child) in table.items() if of == name]
        bone.tail = Vector(children[0]) if children else Vector(place) + Vector((0, 6, 0))
        bone.roll = 0.3 * number
        bone.parent = armature.data.edit_bones[parent] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.scale, armature.rotation_euler = (0.01, 0.01, 0.01), (math.radians(90), 0, 0)
    bpy.context.view_layer.update()
    return armature


def places(frame: int) -> dict[str, list[float]]:
    """Heads of the bones in the world, metres."""
    scene.frame_set(frame)
    return {bone.name[10:]: list(armature.matrix_world @ bone.head) for bone in armature.pose.bones}


motionrt_blender.register()
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 30
armature = build()
seen = {"rest": places(1)}
bpy.ops.motionrt.generate(prompt="a person walks forward", seconds=3.0, seed=1)
seen["generated"] = [places(1 + frame) for frame in range(90)]
scene.frame_set(90)
scene.cursor.location = (1.0, -6.0, 0.0)
bpy.ops.motionrt.walk_to_cursor()
last = round(armature.animation_data.action.frame_range[1])
seen["walk"] = [places(frame) for frame in range(90, last + 1)]
seen["keyed"] = sorted({curve.data_path.split('"')[1][10:] for curve in armature.animation_data.action.fcurves})
Path(out).write_text(json.dumps(seen), encoding="utf-8")
