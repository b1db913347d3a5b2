"""Run by Blender: install the add-on from its zip file, and with it a package; write where that went."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy

archive, wheel, out = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.preferences.addon_install(filepath=archive)
bpy.ops.preferences.addon_enable(module="motionrt_blender")
bpy.ops.motionrt.install(source=wheel)
import motionrt  # noqa: E402

Path(out).write_text(json.dumps({"file": motionrt.__file__, "poll": bpy.ops.motionrt.search.poll()}), encoding="utf-8")
