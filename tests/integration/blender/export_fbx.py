"""Run by Blender: a GLB as FBX files, of two units and two vertical axes."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy
import numpy as np

path, out = sys.argv[sys.argv.index("--") + 1 :]
np.bool = bool  # what Blender 3.4's importer calls it; Debian's NumPy 1.24 no longer does
UNITS = {"centimetres": "FBX_SCALE_NONE", "metres": "FBX_SCALE_UNITS"}  # the file's unit is 1 or 100 centimetres
AXES = {"y": ("Y", "-Z"), "z": ("Z", "Y")}

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 30
bpy.ops.import_scene.gltf(filepath=path)
action = next(thing for thing in bpy.context.scene.objects if thing.type == "ARMATURE").animation_data.action
bpy.context.scene.frame_start, bpy.context.scene.frame_end = map(round, action.frame_range)
written = {}
for unit, scaling in UNITS.items():
    for up, (axis_up, axis_forward) in AXES.items():
        file = Path(out).with_name(f"{unit}_{up}.fbx")
        bpy.ops.export_scene.fbx(
            filepath=str(file),
            apply_scale_options=scaling,
            axis_up=axis_up,
            axis_forward=axis_forward,
            add_leaf_bones=False,
            bake_anim_use_all_actions=False,
            bake_anim_use_nla_strips=False,
            bake_anim_simplify_factor=0.0,
        )
        written[f"{unit}_{up}"] = str(file)
Path(out).write_text(json.dumps(written), encoding="utf-8")
