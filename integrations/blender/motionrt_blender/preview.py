"""A figure that shows what was found, before it is put onto a character."""

from __future__ import annotations

import bpy

from . import figure as figures

NAME = "motionrt preview"


def figure(context: bpy.types.Context) -> bpy.types.Object:
    """The preview figure: there is one at most, at the 3D cursor."""
    ghost = next((thing for thing in context.scene.objects if thing.name == NAME and thing.type == "ARMATURE"), None)
    if ghost is None:
        ghost = figures.build(NAME)
    ghost.location = context.scene.cursor.location
    return ghost


def remove(context: bpy.types.Context) -> None:
    """Take it away, with its body and its action."""
    ghost = next((thing for thing in context.scene.objects if thing.name == NAME and thing.type == "ARMATURE"), None)
    if ghost is None:
        return
    action = ghost.animation_data.action if ghost.animation_data else None
    for thing in (*ghost.children, ghost):
        bpy.data.objects.remove(thing, do_unlink=True)
    if action is not None:
        bpy.data.actions.remove(action)


def select(context: bpy.types.Context, thing: bpy.types.Object | None) -> None:
    """Make what was active before active again."""
    for other in context.selected_objects:
        other.select_set(False)
    context.view_layer.objects.active = thing
    if thing is not None:
        thing.select_set(True)
