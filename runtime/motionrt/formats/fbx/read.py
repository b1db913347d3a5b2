"""FBX in, binary and ASCII: a skeleton and one of its animations."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.fbx.joints import Joints, find_joints, pose_of, rest_of, standing, turned
from motionrt.formats.fbx.scene import Scene, open_scene
from motionrt.formats.fbx.takes import Take, moves, takes_of
from motionrt.formats.gltf.choice import called, chosen
from motionrt.limits import how_to_raise, limits
from motionrt.motion.rotations import Array
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.files import as_path

_DEAR = 12
"""How many times as long as in glTF it takes to evaluate a joint at a time."""


def read_fbx(
    path: str | Path, *, fps: float | None = None, animation: int | str | None = None, still: bool = False
) -> RigClip:
    """Read an FBX file: metres, Y up, whatever unit and axes it is in.

    Joints are the bones and all nodes above them; where there are hardly any bones, all nodes without mesh, camera or
    light. The rest pose is the bind pose of the skin, or the pose in which the nodes stand. Scales of nodes are carried
    into the translations.

    Args:
        path: the file.
        fps: rate at which the animation is sampled; by default that of the file.
        animation: name or index of the take; needed where several move the skeleton.
        still: only the pose in which the nodes stand, as one frame.

    Raises:
        MissingDependencyError: ``ufbx`` is not installed.
        MotionFileNotFoundError: there is no such file.
        FormatError: no FBX file, no skeleton, or several to choose from.
    """
    path = as_path(path)
    with open_scene(path) as scene:
        joints = find_joints(scene, path)
        if still:
            return _standing(scene, joints)
        stack = _take(scene, joints.nodes, animation, path)
        rate = float(fps) if fps is not None else _rate(scene)
        frames = max(1, round((stack.time_end - stack.time_begin) * rate) + 1)
        _check_length(frames, len(joints.nodes), path)
        rotations, translations = _sampled(joints, stack, stack.time_begin + np.arange(frames) / rate)
        offsets, rest = rest_of(scene, joints)
    rest = rest.astype(np.float32)
    return RigClip(joints.names, tuple(joints.parents), offsets, rotations, translations, rate, "y", 1.0, rest)


def _check_length(frames: int, joints: int, path: Path) -> None:
    """FormatError for an animation that is too long, or so long that its file must have few keys."""
    most = max(limits().stretched_values // _DEAR, path.stat().st_size)
    limit = "values" if frames * joints > limits().values else "stretched_values"
    if frames * joints > min(limits().values, most):
        many = f"its animation has {frames:,} frames of {joints} joints"
        many += f", each counted {_DEAR} times" if limit == "stretched_values" else ""
        raise FormatError(path, f"{many}; cut it, give a lower fps=, or: {how_to_raise(limit)}")


def _standing(scene: Scene, joints: Joints) -> RigClip:
    places, turns = (values[None].astype(np.float32) for values in standing(joints))
    offsets, rest = rest_of(scene, joints)
    parents, rest = tuple(joints.parents), rest.astype(np.float32)
    return RigClip(joints.names, parents, offsets, turns, places, _rate(scene), "y", 1.0, rest)


def fbx_animations(path: Path) -> list[str]:
    """What the takes that move the skeleton are called."""
    with open_scene(path) as scene:
        nodes, takes = find_joints(scene, path).nodes, takes_of(scene)
        names = [take.name for take in takes]
        return [called(names, i) for i, take in enumerate(takes) if moves(take, nodes)]


def _take(scene: Scene, nodes: Sequence[Any], animation: int | str | None, path: Path) -> Take:
    stacks = takes_of(scene)
    names = [stack.name for stack in stacks]
    if animation is not None:
        return stacks[chosen("animation", animation, names, path)]
    moving = [stack for stack in stacks if moves(stack, nodes)] or stacks[:1]
    if not moving:
        raise FormatError(path, "holds a skeleton but no animation of it")
    if len(moving) > 1:
        known = ", ".join(called(names, stacks.index(stack)) for stack in moving)
        raise FormatError(path, f"holds {len(moving)} animations; choose with animation=, one of: {known}")
    return moving[0]


def _rate(scene: Scene) -> float:
    rate = float(scene.settings.frames_per_second)
    return rate if 1 <= rate <= 1000 else 30.0


def _sampled(joints: Joints, stack: Take, times: Array) -> tuple[Array, Array]:
    """Local rotations ``(F, J, 3, 3)`` and translations ``(F, J, 3)`` in metres."""
    rotations = np.empty((len(times), len(joints.nodes), 3, 3), dtype=np.float32)
    translations = np.empty((len(times), len(joints.nodes), 3), dtype=np.float32)
    seconds, anim = times.tolist(), stack.anim
    for joint, node in enumerate(joints.nodes):
        poses = np.array([pose_of(node.evaluate_transform(anim, time)) for time in seconds])
        rotations[:, joint] = turned(poses[:, 3:])
        translations[:, joint] = poses[:, :3] * joints.units[joint]
    return rotations, translations
