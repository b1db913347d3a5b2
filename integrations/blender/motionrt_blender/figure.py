"""An armature of motionrt's own skeleton with a body, for whoever has none selected."""

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
    _dress(armature)
    return armature


def _dress(armature: bpy.types.Object) -> None:
    """A body of a mesh on the armature, so that there is somebody to see."""
    from motionrt import SMPL24
    from motionrt.studio.figure import figure_of

    body = figure_of(SMPL24)
    mesh = bpy.data.meshes.new(armature.name)
    mesh.from_pydata(points(body.vertices.astype(np.float64)).tolist(), [], body.faces.tolist())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    seen = bpy.data.objects.new(f"{armature.name} body", mesh)
    bpy.context.collection.objects.link(seen)
    seen.parent = armature
    seen.hide_select = True
    for joint in range(body.weights.shape[1]):
        group = seen.vertex_groups.new(name=SMPL24.names[joint])
        for weight in np.unique(body.weights[:, joint].round(2)):
            moved = np.flatnonzero(body.weights[:, joint].round(2) == weight)
            if weight > 0:
                group.add(moved.tolist(), float(weight), "REPLACE")
    modifier = seen.modifiers.new("motionrt", "ARMATURE")
    modifier.object = armature


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
