"""Motion onto an armature, and an armature's motion back: motionrt's own figure, or any humanoid rig."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from . import axes, curves, figure, rigs
from .installing import InstallError

if TYPE_CHECKING:
    from motionrt import Motion

FPS = 30.0  # at which walks go on
SEEN = 60  # frames that a walk looks back on


def target(context: bpy.types.Context) -> bpy.types.Object:
    """The active armature, or a new one."""
    active = context.active_object
    return active if active and active.type == "ARMATURE" else figure.build()


def put(context: bpy.types.Context, armature: bpy.types.Object, motion: Motion, name: str, *, fresh: bool) -> str:
    """Key a motion at the scene's frame rate: from the current frame on in a fresh action, or behind it in the old one.

    Returns:
        What was done, for the user.
    """
    scene = context.scene
    shown = motion.resample(rate(scene))
    first = scene.frame_current + (0 if fresh else 1)
    action = curves.action_of(armature, name[:60], fresh=fresh, first=first)
    for bone, channel, values in _keys(armature, shown):
        armature.pose.bones[bone].rotation_mode = "QUATERNION"
        curves.write(armature, action, bone, channel, values, first)
    scene.frame_end = max(scene.frame_end, first + shown.frames - 1)
    return f"{shown.frames} frames of '{name}' on {armature.name}"


def way(context: bpy.types.Context, armature: bpy.types.Object, curve: bpy.types.Object) -> list[tuple[float, float]]:
    """The points (x, z) of a curve of the scene on the ground of the motion that the armature shows, in order.

    Raises:
        InstallError: it is no curve, or one without length.
    """
    if curve is None or curve.type != "CURVE":
        raise InstallError("choose a curve as the path first")
    seen = curve.evaluated_get(context.evaluated_depsgraph_get())
    mesh = seen.to_mesh()
    try:
        points = [ground(armature, seen.matrix_world @ vertex.co) for vertex in mesh.vertices]
    finally:
        seen.to_mesh_clear()
    points = [point for k, point in enumerate(points) if k == 0 or np.hypot(*np.subtract(point, points[k - 1])) > 1e-3]
    if len(points) < 2:
        raise InstallError(f"the curve {curve.name} has no length on the ground; give it two points, and no bevel")
    return points


def rate(scene: bpy.types.Scene) -> float:
    """Frames per second that the scene plays."""
    return float(scene.render.fps / scene.render.fps_base)


def _keys(armature: bpy.types.Object, motion: Motion) -> list[tuple[str, str, np.ndarray]]:
    """(bone, channel, values (F, N)) of a motion."""
    if figure.is_own(armature):
        return _own_keys(armature, motion)
    return rigs.keys(armature, motion)


def _own_keys(armature: bpy.types.Object, motion: Motion) -> list[tuple[str, str, np.ndarray]]:
    turns = axes.turns(motion.rotations.astype(np.float64))
    keys = []
    for joint, name in enumerate(motion.skeleton.names):
        rest = rest_rotation(armature, name)
        keys.append((name, "rotation_quaternion", axes.quaternions(rest.T @ turns[:, joint] @ rest)))
    pelvis = motion.skeleton.names[0]
    away = axes.points(motion.root.astype(np.float64)) - np.array(armature.data.bones[pelvis].head_local)
    keys.append((pelvis, "location", away @ rest_rotation(armature, pelvis)))
    return keys


def rest_rotation(armature: bpy.types.Object, bone: str) -> np.ndarray:
    """``(3, 3)`` of a bone at rest, in the armature."""
    return np.array(armature.data.bones[bone].matrix_local.to_3x3())


def seen(context: bpy.types.Context, armature: bpy.types.Object) -> Motion:
    """What the armature did up to the current frame: at most two seconds at 30 fps."""
    scene, now = context.scene, context.scene.frame_current
    times = _times(armature, now, rate(scene) / FPS)
    try:
        poses = [_pose(scene, armature, time) for time in times]
    finally:
        scene.frame_set(now)
    return _motion(armature, np.stack(poses))


def _times(armature: bpy.types.Object, now: int, step: float) -> list[float]:
    action = armature.animation_data.action if armature.animation_data else None
    begin = min(action.frame_range[0], now) if action else now
    count = min(SEEN, int((now - begin) / step) + 1)
    return [now - step * back for back in reversed(range(count))]


def _pose(scene: bpy.types.Scene, armature: bpy.types.Object, time: float) -> np.ndarray:
    """``(J, 4, 4)`` of all bones in the armature."""
    whole = int(np.floor(time))
    scene.frame_set(whole, subframe=time - whole)
    return np.array([bone.matrix for bone in armature.pose.bones])


def _motion(armature: bpy.types.Object, poses: np.ndarray) -> Motion:
    if not figure.is_own(armature):
        return rigs.motion(armature, poses, FPS)
    from motionrt import SMPL24, Motion
    from motionrt.motion.kinematics import global_to_local

    order = [armature.pose.bones.find(name) for name in SMPL24.names]
    rests = np.stack([rest_rotation(armature, name) for name in SMPL24.names])
    turned = axes.turns_back(poses[:, order, :3, :3] @ np.swapaxes(rests, -1, -2))
    root = axes.points_back(poses[:, order[0], :3, 3])
    return Motion(global_to_local(turned, SMPL24.parents), root, FPS)


def ground(armature: bpy.types.Object, place: np.ndarray) -> tuple[float, float]:
    """A point of the world as (x, z) of the motion that the armature shows."""
    local = np.array(armature.matrix_world.inverted() @ place)
    if not figure.is_own(armature):
        local = rigs.metres(armature, local)
        return float(local[0]), float(local[2])
    x, _, z = axes.points_back(local)
    return float(x), float(z)
