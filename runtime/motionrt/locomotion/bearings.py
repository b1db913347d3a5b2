"""Where a character is and which way it faces, in the ground plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.locomotion.path import Path
from motionrt.motion import Motion
from motionrt.motion.transforms import TOE_JOINTS
from motionrt.motion.transforms import heading as headings

Place = tuple[float, float]
_STANDING_PELVIS = 0.06  # metres that the pelvis of somebody who stands is behind the balls of the feet


def place_of(motion: Motion) -> Place:
    """(x, z) of the pelvis in the last frame."""
    return float(motion.root[-1, 0]), float(motion.root[-1, 2])


def facing_of(motion: Motion) -> float:
    """Heading in the last frame, radians from +Z towards +X."""
    return float(headings(motion[-1:])[0])


def over_feet(motion: Motion) -> Place:
    """(x, z) where the pelvis would be if the character stood up where its feet are in the last frame."""
    toes = motion.positions()[-1, [motion.skeleton.index(name) for name in TOE_JOINTS]].mean(axis=0)
    ahead, facing = _STANDING_PELVIS, facing_of(motion)
    return float(toes[0] - ahead * np.sin(facing)), float(toes[2] - ahead * np.cos(facing))


def ahead_of(place: Place, facing: float, metres: float) -> Place:
    """The place so many metres ahead."""
    return place[0] + metres * float(np.sin(facing)), place[1] + metres * float(np.cos(facing))


def apart(a: Sequence[float], b: Sequence[float]) -> float:
    """Metres between two places."""
    return float(np.hypot(a[0] - b[0], a[1] - b[1]))


def heading_along(path: Path, s: float) -> float:
    """Heading of a path at an arc length, radians from +Z towards +X."""
    x, z = path.tangent(s)
    return float(np.arctan2(x, z))


def joined(parts: Sequence[Motion]) -> Motion:
    """Motions of one skeleton and frame rate, one behind the other."""
    rotations = np.concatenate([part.rotations for part in parts])
    return Motion(rotations, np.concatenate([part.root for part in parts]), parts[0].fps)
