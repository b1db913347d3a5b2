"""Hand-made clips with known answers: joint positions ``(F, 24, 3)`` of a standing body that is moved about."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion import SMPL24

Array = npt.NDArray[np.float64]
FPS = 30.0
INDEX = {name: k for k, name in enumerate(SMPL24.names)}


def standing(frames: int = 90) -> Array:
    """Upright with hanging arms, facing +Z, toes on the floor."""
    joints = SMPL24.rest_positions.astype(np.float64)
    for side, sign in (("left", 1), ("right", -1)):
        shoulder = joints[INDEX[f"{side}_shoulder"]]
        for name, down in (("elbow", 0.27), ("wrist", 0.52), ("hand", 0.6)):
            joints[INDEX[f"{side}_{name}"]] = shoulder + np.array([0.05 * sign, -down, 0.02])
    joints = joints - [0.0, joints[INDEX["left_foot"], 1], 0.0]
    return np.repeat(joints[None], frames, axis=0)


def led(joints: Array, path: Array, yaw: Array) -> Array:
    """The same, carried along a path ``(F, 2)`` (x, z) with headings ``(F,)``, radians, left positive."""
    c, s = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    x, z = joints[..., 0], joints[..., 2]
    turned = np.stack([x * c + z * s, joints[..., 1], -x * s + z * c], axis=-1)
    return turned + np.stack([path[:, 0], np.zeros(len(path)), path[:, 1]], axis=1)[:, None]


def circle(radius: float, degrees: float, seconds: float, fps: float = FPS) -> Array:
    """Along a circle about a centre at the left (positive degrees) or right, facing along it, from the origin."""
    angle = np.radians(degrees) * np.linspace(0, 1, round(seconds * fps) + 1)
    side = np.sign(degrees)
    path = np.stack([side * radius * (1 - np.cos(angle)), radius * np.sin(np.abs(angle))], axis=1)
    return led(standing(len(angle)), path, angle)


def raised(side: str, frames: int = 90) -> Array:
    """One arm goes up beside the head in the middle of the clip."""
    joints = standing(frames)
    up = np.clip(np.sin(np.linspace(0, np.pi, frames)), 0, 1)[:, None]
    shoulder = joints[0, INDEX[f"{side}_shoulder"]]
    for name, height in (("elbow", 0.27), ("wrist", 0.52), ("hand", 0.6)):
        k = INDEX[f"{side}_{name}"]
        joints[:, k] += up * (shoulder + np.array([0.0, height, 0.02]) - joints[0, k])
    return joints


def jumping(heights: list[float]) -> Array:
    """Straight up so many times, as a thrown body flies, with half a second of standing before and after each."""
    lift = [np.zeros(15)]
    for height in heights:
        flight = 2 * np.sqrt(2 * height / 9.81)
        t = np.arange(0, flight, 1 / FPS)
        lift += [np.sqrt(2 * height * 9.81) * t - 9.81 / 2 * t**2, np.zeros(15)]
    up = np.concatenate(lift)
    return standing(len(up)) + up[:, None, None] * [0.0, 1.0, 0.0]


def sinking(low: float, frames: int = 90, back: bool = False) -> Array:
    """The hips go down between fixed feet until the pelvis is at ``low`` of its height; knees go forward."""
    joints = standing(frames)
    part = np.linspace(0, 1, frames) if not back else np.sin(np.linspace(0, np.pi, frames))
    drop = part * (1 - low) * joints[0, 0, 1]
    fixed = [INDEX[f"{s}_{n}"] for s in ("left", "right") for n in ("ankle", "foot")]
    moved = [k for k in range(24) if k not in fixed]
    joints[:, moved, 1] -= drop[:, None]
    for s in ("left", "right"):
        knee, hip, ankle = (joints[:, INDEX[f"{s}_{n}"]] for n in ("knee", "hip", "ankle"))
        middle = (hip + ankle) / 2
        reach = 0.4075**2 - ((hip - ankle) ** 2).sum(axis=1) / 4
        knee[:] = middle + np.sqrt(np.maximum(reach, 0))[:, None] * [0.0, 0.0, 1.0]
    return joints


def mirrored(joints: Array) -> Array:
    """The clip seen in a mirror."""
    return joints[:, list(SMPL24.mirrored_joints)] * [-1.0, 1.0, 1.0]
