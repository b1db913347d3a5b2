"""Animation curves written in one go, in Blender 3.4 to 5: actions have had slots since 4.4."""

from __future__ import annotations

import bpy
import numpy as np

LINEAR = 1  # of the enumeration of interpolations


def action_of(armature: bpy.types.Object, name: str, *, fresh: bool, first: float) -> bpy.types.Action:
    """The action to write into from frame ``first`` on; no key of another is lost.

    It is a new one where the armature has none or a fresh one is wanted, and a copy where its action has keys from
    ``first`` on. Actions that the armature leaves stay in the file.
    """
    data = armature.animation_data or armature.animation_data_create()
    before = data.action
    if before is not None and (fresh or before.frame_range[1] >= first):
        before.use_fake_user = True
    if before is not None and not fresh and before.frame_range[1] >= first:
        slot = data.action_slot.handle if hasattr(before, "slots") and data.action_slot else None
        data.action = before.copy()
        if slot is not None:
            data.action_slot = next(other for other in data.action.slots if other.handle == slot)
    elif before is None or fresh:
        data.action = bpy.data.actions.new(name)
        if hasattr(data.action, "slots"):
            data.action_slot = data.action.slots.new(id_type="OBJECT", name=armature.name)
    return data.action


def write(
    armature: bpy.types.Object, action: bpy.types.Action, bone: str, channel: str, values: np.ndarray, first: int
) -> None:
    """Keys of a pose bone's channel: ``values`` (F, N) from frame ``first`` on, in the place of keys from there on."""
    path = f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{channel}'
    for index, column in enumerate(values.T):
        _fill(_curve(armature, action, path, index, bone), first, column)


def _curve(armature: bpy.types.Object, action: bpy.types.Action, path: str, index: int, group: str) -> bpy.types.FCurve:
    if not hasattr(action, "slots"):
        return action.fcurves.find(path, index=index) or action.fcurves.new(path, index=index, action_group=group)
    bag = _bag(armature, action)
    found = bag.fcurves.find(path, index=index) or bag.fcurves.new(path, index=index)
    if found.group is None:
        found.group = bag.groups.get(group) or bag.groups.new(group)
    return found


def _bag(armature: bpy.types.Object, action: bpy.types.Action) -> bpy.types.ActionChannelbag:
    layer = action.layers[0] if action.layers else action.layers.new("motionrt")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(armature.animation_data.action_slot, ensure=True)


def _fill(curve: bpy.types.FCurve, first: int, values: np.ndarray) -> None:
    keys = curve.keyframe_points
    before = np.empty(2 * len(keys))
    keys.foreach_get("co", before)
    kept = before.reshape(-1, 2)
    kept = kept[kept[:, 0] < first]
    for key in reversed(range(len(kept), len(keys))):
        keys.remove(keys[key], fast=True)
    keys.add(len(values))
    table = np.concatenate([kept, np.stack([first + np.arange(len(values)), values], axis=1)])
    keys.foreach_set("co", table.ravel())
    keys.foreach_set("interpolation", np.full(len(table), LINEAR))
    curve.update()
