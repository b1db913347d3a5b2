"""motionrt in Blender: search mocap by text, generate motion, walk to the 3D cursor; on any humanoid armature.

Everything is an operator, too, and works without a window: ``bpy.ops.motionrt.generate(prompt="a person waves")``.
"""

from __future__ import annotations

from . import installing, operators, panel, settings

bl_info = {
    "name": "motionrt",
    "author": "the motionrt developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar (N) > motionrt",
    "description": "Search, generate and walk: 3D human motion, offline, on the CPU",
    "category": "Animation",
}

_PARTS = (settings, operators, panel)


def register() -> None:
    """Called by Blender when the add-on is switched on."""
    installing.add_to_path()
    for part in _PARTS:
        part.register()


def unregister() -> None:
    """Called by Blender when the add-on is switched off."""
    for part in reversed(_PARTS):
        part.unregister()
