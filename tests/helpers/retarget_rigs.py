"""Rigs that the retargeting tests make: one person's motion, written under other names, units, axes and rest
poses.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion
from motionrt.rigs import RigClip

Array = npt.NDArray[np.float64]
SIDED = ("hip", "knee", "ankle", "foot", "collar", "shoulder", "elbow", "wrist", "hand")
Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


def person(frames: int = 60, fps: float = 30.0, seed: int = 0) -> Motion:
    """Walks on a curve with hanging, swinging arms and bending knees and elbows; the lower toe is always at y
    = 0.
    """
    rng = np.random.default_rng(seed)
    time = np.arange(frames) / fps
    swing = np.sin(2 * np.pi * 0.9 * time)
    lift = np.maximum(np.cos(2 * np.pi * 0.9 * time), 0), np.maximum(-np.cos(2 * np.pi * 0.9 * time), 0)
    vectors = {
        name: rng.normal(0, 0.05, 3) + np.zeros((frames, 3)) for name in ("spine1", "spine2", "spine3", "neck", "head")
    }
    for side, sign, bend in (("left", 1, lift[0]), ("right", -1, lift[1])):
        vectors[f"{side}_hip"] = np.outer(-sign * 0.5 * swing, [1, 0, 0])
        vectors[f"{side}_knee"] = np.outer(0.15 + 0.8 * bend, [1, 0, 0])
        vectors[f"{side}_elbow"] = np.outer(-sign * (0.4 + 0.3 * swing), [0, 1, 0])
        vectors[f"{side}_collar"] = np.outer(0.05 * swing, [0, 0, 1])
        vectors[f"{side}_wrist"] = np.outer(0.2 * swing, [0, 0, 1])
    turns = {name: Rotation.from_rotvec(vector) for name, vector in vectors.items()}
    for side, sign in (("left", 1), ("right", -1)):
        forward = Rotation.from_rotvec(np.outer(sign * 0.4 * swing, [1, 0, 0]))
        turns[f"{side}_shoulder"] = forward * Rotation.from_rotvec([0, 0, -sign * 1.25])
        level = (turns[f"{side}_hip"] * turns[f"{side}_knee"]).inv()
        turns[f"{side}_ankle"] = level * Rotation.from_rotvec(np.outer(0.3 * lift[sign < 0], [1, 0, 0]))
    turns["pelvis"] = Rotation.from_rotvec(np.outer(0.6 * time, [0, 1, 0]))
    rotations = np.tile(np.eye(3), (frames, 24, 1, 1))
    for name, turn in turns.items():
        rotations[:, SMPL24.index(name)] = turn.as_matrix()
    root = np.stack([np.sin(0.6 * time), np.zeros(frames), 1.2 * time], axis=-1)
    flying = Motion(rotations.astype(np.float32), root.astype(np.float32), fps)
    root[:, 1] -= flying.positions()[:, [10, 11], 1].min(axis=1)
    return Motion(rotations.astype(np.float32), root.astype(np.float32), fps)


def renamed(pattern: dict[str, str], sides: tuple[str, str] = ("Left", "Right"), **middle: str) -> dict[str, str]:
    """smpl24 name -> rig name: ``pattern`` gives the sided parts with ``{}`` for the side, ``middle`` the
    others.
    """
    names = dict(middle)
    for part, form in pattern.items():
        names[f"left_{part}"] = form.format(sides[0])
        names[f"right_{part}"] = form.format(sides[1])
    return names


def named(*forms: str) -> dict[str, str]:
    """Sided parts of :data:`SIDED`, hip to hand, as :func:`renamed` wants them."""
    return dict(zip(SIDED, forms, strict=True))


def rest_turns(kind: str) -> dict[str, Array]:
    """For each joint, how its bones stand in the rest pose against the T-pose: ``(3, 3)``."""
    turns = {name: np.eye(3) for name in SMPL24.names}
    if kind == "a":
        for side, sign in (("left", 1), ("right", -1)):
            arm = Rotation.from_rotvec([0, 0, -sign * np.deg2rad(50)]).as_matrix()
            leg = Rotation.from_rotvec([0, 0, sign * np.deg2rad(8)]).as_matrix()
            turns |= {f"{side}_{part}": arm for part in ("shoulder", "elbow", "wrist", "hand")}
            turns |= {f"{side}_{part}": leg for part in ("hip", "knee")}
    if kind == "spread":
        for side, sign in (("left", 1), ("right", -1)):
            leg = Rotation.from_rotvec([0, 0, sign * np.deg2rad(20)]).as_matrix()
            turns |= {f"{side}_{part}": leg for part in ("hip", "knee", "ankle", "foot")}
    if kind == "bones_up":
        for joint, name in enumerate(SMPL24.names):
            child = next((c for c, p in enumerate(SMPL24.parents) if p == joint), None)
            if child is not None and name not in ("pelvis", "spine3"):
                turns[name] = Rotation.align_vectors([[0, 1, 0]], [SMPL24.offsets[child]])[0].as_matrix()
    return turns


def rig(
    motion: Motion,
    names: dict[str, str] | None = None,
    *,
    scale: float = 1.0,
    rest: str = "t",
    rest_yaw: float = 0.0,
    world: Array | None = None,
    up: str | None = None,
) -> RigClip:
    """``motion`` as another rig would hold it.

    Args:
        motion: the truth.
        names: smpl24 name -> rig name; joints that are not in it are left out with all that hangs on them
            moved up.
        scale: units per metre.
        rest: ``"t"``, ``"a"`` (arms down by 50 degrees), ``"spread"`` (legs and feet turned outward by 20
            degrees) or ``"bones_up"`` (every bone along +Y).
        rest_yaw: which way the rest pose faces, radians.
        world: change of world axes ``(3, 3)`` applied to motion and rest pose.
        up: what the format says about the vertical.
    """
    world = np.eye(3) if world is None else world
    names = {name: name for name in SMPL24.names} if names is None else names
    kept = [joint for joint, name in enumerate(SMPL24.names) if name in names]
    stand = Rotation.from_rotvec([0, rest_yaw, 0]).as_matrix()
    turns = [world @ stand @ turn for turn in rest_turns(rest).values()]
    posed = [world @ motion.global_rotations()[:, j].astype(float) @ turns[j].T for j in range(24)]
    positions = motion.positions().astype(float)
    parents, offsets, local = [], [], []
    for joint in kept:
        parent = SMPL24.parents[joint]
        offset = SMPL24.offsets[joint].astype(float)
        while parent >= 0 and parent not in kept:
            offset, parent = offset + SMPL24.offsets[parent], SMPL24.parents[parent]
        parents.append(kept.index(parent) if parent >= 0 else -1)
        offsets.append(scale * (turns[parent] @ offset if parent >= 0 else np.zeros(3)))
        local.append(posed[joint] if parent < 0 else np.swapaxes(posed[parent], -1, -2) @ posed[joint])
    translations = np.tile(np.array(offsets), (motion.frames, 1, 1))
    translations[:, 0] = scale * positions[:, 0] @ world.T
    return RigClip(
        names=tuple(names[SMPL24.names[joint]] for joint in kept),
        parents=tuple(parents),
        offsets=np.array(offsets, np.float32),
        rotations=np.stack(local, axis=1).astype(np.float32),
        translations=translations.astype(np.float32),
        fps=motion.fps,
        up=up,
    )
