"""An armature of motionrt's own skeleton, for whoever has none selected."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from .axes import points

_SHORT = 0.08  # metres of a bone that ends nowhere


def is_own(armature: bpy.types.Object) -> bool:
    """Whether an armature has the joints of ``smpl24`` and bones that rest as ours do."""
    from motionrt import SMPL24

    bones = armature.data.bones
    if any(name not in bones for name in SMPL24.names) or len(bones) != len(SMPL24):
        return False
    heads = np.array([bones[name].head_local for name in SMPL24.names])
    return bool(np.abs(heads - heads[0] - points(SMPL24.rest_positions)).max() < 1e-4)


def build(name: str = "motionrt") -> bpy.types.Object:
    """A new armature in the current collection, active and selected, its pelvis at the origin."""
    from motionrt import SMPL24

    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.collection.objects.link(armature)
    _select(armature)
    bpy.ops.object.mode_set(mode="EDIT")
    heads = points(SMPL24.rest_positions.astype(np.float64))
    for joint, label in enumerate(SMPL24.names):
        bone = armature.data.edit_bones.new(label)
        bone.head = heads[joint]
        bone.tail = _tail(heads, joint)
        if joint:
            bone.parent = armature.data.edit_bones[SMPL24.names[SMPL24.parents[joint]]]
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.show_in_front = True
    return armature


def _select(armature: bpy.types.Object) -> None:
    if bpy.context.object and bpy.context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for other in bpy.context.selected_objects:
        other.select_set(False)
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature


def _tail(heads: np.ndarray, joint: int) -> Vector:
    from motionrt import SMPL24

    children = [child for child, parent in enumerate(SMPL24.parents) if parent == joint]
    if children:  # the one in the middle: spine and neck go on, not hips and collars
        return Vector(heads[min(children, key=lambda child: abs(heads[child][0] - heads[joint][0]))])
    along = Vector(heads[joint] - heads[SMPL24.parents[joint]])
    return Vector(heads[joint]) + along.normalized() * _SHORT
