"""What a motion file holds and how it was understood: joints, axes, unit, rate, mapping, and how well they agree."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import RigError
from motionrt.formats.leading_pose import drop_leading_tpose
from motionrt.formats.load import load_rig
from motionrt.formats.units import metres_per_unit
from motionrt.motion.batches import BATCH
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.clip import RigClip
from motionrt.rigs.kinds import rig_kind
from motionrt.rigs.placement import leg_scale
from motionrt.rigs.plain_kinematics import angles_between, joint_transforms
from motionrt.rigs.retarget_in import to_smpl24
from motionrt.rigs.stance import Stance, read_stance
from motionrt.untrusted.arguments import checked_mapping
from motionrt.untrusted.files import as_path

_LIMBS = (("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"))
_LOOKED_AT = 20_000
"""Frames of a file that are compared with its motion."""

_FAR_OFF = 3.0
"""Mean angle in degrees between limbs of file and motion from which on it is worth a warning."""


@dataclass(frozen=True)
class MotionFileInfo:
    """What is known of a motion file.

    Attributes:
        path: the file.
        kind: naming convention of the rig, such as ``Mixamo``; ``unknown names`` where it was found by structure.
        joints: number of joints, end sites not counted.
        up: vertical axis of the file: ``x``, ``y``, ``z``, with ``-`` where it points down.
        metres_per_unit: size of the file's unit, as the format says or as the legs suggest.
        fps: frames per second.
        frames: of the motion, without a leading calibration pose.
        leading_pose: number of frames of the calibration pose that led the file.
        seconds: duration.
        height: of the figure from soles to head joint at its straightest, metres.
        mapping: ``smpl24`` joint name -> joint name.
        limb_error_degrees: mean angle between the limbs of the file, by plain forward kinematics, and of the motion.
        warnings: what is odd.
        reason: why it is not read as the motion of a person; ``None`` where it is.
    """

    path: Path
    kind: str
    joints: int
    up: str
    metres_per_unit: float | None
    fps: float
    frames: int
    leading_pose: int
    seconds: float
    height: float | None
    mapping: Mapping[str, str]
    limb_error_degrees: float | None
    warnings: tuple[str, ...]
    reason: str | None = None


def motion_file_info(path: str | Path, *, mapping: Mapping[str, str] | None = None, **reading: Any) -> MotionFileInfo:
    """Look at a motion file.

    Args:
        path: a file that :func:`motionrt.load_rig` reads.
        mapping: ``smpl24`` joint name -> joint name in the file; may be partial.
        reading: ``asf``, ``fps``, ``animation``, ``skin``, ``up`` as for :func:`motionrt.load_rig`.

    Raises:
        MotionFileNotFoundError, FormatError, InvalidInputError: as :func:`motionrt.load_rig`.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        clip = load_rig(path, **reading)
    mapping = checked_mapping(mapping, "mapping")
    part, reference = drop_leading_tpose(clip)
    frames, part = part.frames, _some(part)
    joints = sum(not name.endswith("_end") for name in clip.names)
    facts: dict[str, Any] = {
        "path": as_path(path),
        "kind": rig_kind(clip.names),
        "joints": joints,
        "fps": clip.fps,
        "frames": frames,
        "leading_pose": clip.frames - frames,
        "seconds": frames / clip.fps,
    }
    try:
        given = {**clip.known, **(mapping or {})} or None
        poses = [pose for pose in (reference, clip.rest_rotations()) if pose is not None]
        stance = read_stance(part, given, poses)
        motion = to_smpl24(part, mapping=mapping, reference=reference)
    except RigError as error:
        unknown: dict[str, Any] = {"height": None, "mapping": {}, "limb_error_degrees": None}
        size: dict[str, Any] = {"up": clip.up or "?", "metres_per_unit": clip.metres_per_unit}
        return MotionFileInfo(**facts, **size, **unknown, warnings=clip.notes, reason=str(error))
    error_degrees = limb_error(part, stance, motion)
    unit, height = _size(part, stance)
    return MotionFileInfo(
        **facts,
        up=_axis(stance),
        metres_per_unit=unit,
        height=height,
        mapping={role: clip.names[joint] for role, joint in stance.roles.joints.items()},
        limb_error_degrees=round(error_degrees, 3),
        warnings=(*clip.notes, *_oddities(stance, error_degrees)),
    )


def _some(clip: RigClip) -> RigClip:
    """Every n-th frame of a long clip: what is asked does not depend on all of them."""
    step = -(-clip.frames // _LOOKED_AT)
    parts = clip.rotations[::step], clip.translations[::step]
    return clip if step == 1 else replace(clip, rotations=parts[0], translations=parts[1], fps=clip.fps / step)


def limb_error(clip: RigClip, stance: Stance, motion: Motion) -> float:
    """Mean angle in degrees between the limbs of a clip and those of the motion that was made of it."""
    angles, found = [], motion.positions()
    for start in range(0, clip.frames, BATCH):
        part = slice(start, start + BATCH)
        places = joint_transforms(clip.slice(start, start + BATCH))[..., :3, 3] @ stance.to_world.T
        angles.append(_limb_angles(places, found[part].astype(np.float64), stance))
    return float(np.concatenate(angles).mean())


def _limb_angles(places: Array, found: Array, stance: Stance) -> Array:
    """``(F, 8)`` degrees between the limbs of joints ``(F, J, 3)`` of the file and ``(F, 24, 3)`` of the motion."""
    joints, angles = stance.roles.joints, []
    for side in ("left", "right"):
        for upper, lower in _LIMBS:
            bone = places[:, joints[f"{side}_{lower}"]] - places[:, joints[f"{side}_{upper}"]]
            ours = found[:, SMPL24.index(f"{side}_{lower}")] - found[:, SMPL24.index(f"{side}_{upper}")]
            angles.append(angles_between(bone, ours))
    return np.stack(angles, axis=1)


def _axis(stance: Stance) -> str:
    up = stance.to_world[1]
    largest = int(np.abs(up).argmax())
    return ("-" if up[largest] < 0 else "") + "xyz"[largest]


def _size(clip: RigClip, stance: Stance) -> tuple[float, float]:
    """Metres per unit, and height of the figure in metres."""
    unit = clip.metres_per_unit or metres_per_unit(1 / leg_scale(stance.motion))
    return unit, round(unit * float(_stature(stance)), 3)


def _stature(stance: Stance) -> float:
    joints, places = stance.roles.joints, stance.motion.positions
    head = places[:, stance.roles.neck[-1]]
    feet = [places[:, joints.get(f"{side}_foot", joints[f"{side}_ankle"])] for side in ("left", "right")]
    lengths: Array = np.maximum(*(np.linalg.norm(head - foot, axis=-1) for foot in feet))
    return float(np.percentile(lengths, 95))


def _oddities(stance: Stance, error_degrees: float) -> tuple[str, ...]:
    notes = []
    if stance.local is None:
        notes.append("no pose of the file is a T- or A-pose; how its joints are turned was found from the animation")
    if error_degrees > _FAR_OFF:
        notes.append(
            f"limbs of the motion are {error_degrees:.1f} degrees from those of the file: its rest pose is bent"
        )
    if not stance.roles.sided:
        notes.append("left and right were told by the body, as the names do not say")
    return tuple(notes)
