"""What the figure is made of: round cones between joints, as thick as an average adult."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.motion.skeleton import SMPL24, FloatArray, Skeleton

Offset = tuple[float, float, float]
End = tuple[str, Offset]

_O: Offset = (0.0, 0.0, 0.0)

# bone that moves it, from joint + offset, to joint + offset (metres, of the left half), radii. The ball of a foot is
# at the height of its sole.
_MIDDLE: tuple[tuple[str, End, End, float, float], ...] = (
    ("neck", ("spine3", (0, 0.16, -0.012)), ("head", (0, 0.02, -0.01)), 0.056, 0.050),
    ("head", ("head", (0, 0.055, 0.012)), ("head", (0, 0.115, -0.002)), 0.074, 0.090),
    ("head", ("head", (0, 0.012, 0.040)), ("head", (0, 0.06, 0.03)), 0.040, 0.060),
    ("head", ("head", (0, 0.075, 0.094)), ("head", (0, 0.052, 0.106)), 0.010, 0.013),
)
_LEFT: tuple[tuple[str, End, End, float, float], ...] = (
    ("pelvis", ("left_hip", (-0.005, 0.02, -0.012)), ("pelvis", (0.045, 0.05, 0)), 0.088, 0.092),
    ("pelvis", ("left_hip", (-0.02, -0.01, -0.045)), ("left_hip", (-0.02, 0.03, -0.035)), 0.066, 0.066),
    ("spine1", ("spine1", (0.042, -0.03, 0.008)), ("spine2", (0.045, -0.02, 0.005)), 0.086, 0.088),
    ("spine2", ("spine2", (0.050, -0.02, 0.006)), ("spine3", (0.058, 0.0, 0.0)), 0.090, 0.098),
    ("spine3", ("spine3", (0.062, 0.0, 0.004)), ("spine3", (0.070, 0.09, -0.004)), 0.098, 0.086),
    ("spine3", ("spine3", (0.03, 0.13, -0.012)), ("left_collar", (0.03, 0.015, -0.01)), 0.062, 0.055),
    ("left_collar", ("left_collar", (0.03, 0.005, 0)), ("left_shoulder", (-0.01, 0, 0)), 0.060, 0.062),
    ("left_shoulder", ("left_shoulder", (0.005, 0, 0)), ("left_elbow", _O), 0.059, 0.041),
    ("left_elbow", ("left_elbow", _O), ("left_wrist", (-0.02, 0, 0)), 0.042, 0.028),
    ("left_elbow", ("left_elbow", (0.05, 0, 0)), ("left_elbow", (0.10, 0, 0)), 0.044, 0.040),
    ("left_wrist", ("left_wrist", (0, 0, 0.012)), ("left_hand", (0.0, 0, 0.018)), 0.022, 0.022),
    ("left_wrist", ("left_wrist", (0, 0, -0.008)), ("left_hand", (0.0, 0, -0.018)), 0.022, 0.020),
    ("left_wrist", ("left_hand", (0.01, 0, 0.016)), ("left_hand", (0.085, -0.004, 0.012)), 0.018, 0.012),
    ("left_wrist", ("left_hand", (0.01, 0, -0.016)), ("left_hand", (0.070, -0.004, -0.014)), 0.018, 0.012),
    ("left_wrist", ("left_wrist", (0.02, -0.004, 0.025)), ("left_wrist", (0.082, -0.010, 0.062)), 0.016, 0.011),
    ("left_hip", ("left_hip", (0.004, -0.02, 0)), ("left_knee", _O), 0.088, 0.056),
    ("left_knee", ("left_knee", (0, 0.0, 0.0)), ("left_ankle", (0, 0.02, 0)), 0.054, 0.036),
    ("left_knee", ("left_knee", (0.004, -0.09, -0.018)), ("left_knee", (0.002, -0.19, -0.016)), 0.052, 0.046),
    ("left_ankle", ("left_ankle", (0, -0.010, -0.004)), ("left_foot", (0.002, 0.044, -0.01)), 0.040, 0.034),
    ("left_ankle", ("left_ankle", (0, -0.021, -0.046)), ("left_foot", (0, 0.044, -0.04)), 0.033, 0.033),
    ("left_foot", ("left_foot", (0.010, 0.040, 0.0)), ("left_foot", (0.006, 0.033, 0.062)), 0.030, 0.024),
    ("left_foot", ("left_foot", (-0.016, 0.040, 0.0)), ("left_foot", (-0.012, 0.033, 0.066)), 0.030, 0.024),
)


@dataclass(frozen=True, eq=False)
class Cones:
    """``N`` cones with round ends.

    Attributes:
        bones: the joint that moves each.
        starts, ends: ``(N, 3)`` metres.
        radii: ``(N, 2)`` metres, at the start and at the end.
    """

    bones: tuple[int, ...]
    starts: FloatArray
    ends: FloatArray
    radii: FloatArray

    def distances(self, points: FloatArray) -> FloatArray:
        """``(P, N)`` metres from points ``(P, 3)`` to the surfaces, negative inside."""
        along = self.ends - self.starts
        squares = np.maximum((along**2).sum(axis=1), 1e-9)
        products = points @ along.T - (self.starts * along).sum(axis=1)
        t = np.clip(products / squares, 0, 1)
        offsets = (points**2).sum(axis=1)[:, None] - 2 * points @ self.starts.T + (self.starts**2).sum(axis=1)
        apart = np.sqrt(np.maximum(offsets - 2 * t * products + t * t * squares, 0))
        return np.asarray(apart - self.radii[:, 0] - t * (self.radii[:, 1] - self.radii[:, 0]), dtype=np.float32)

    def bounds(self, margin: float) -> tuple[FloatArray, FloatArray]:
        """The lowest and the highest corner around all, ``margin`` metres away."""
        points, radii = np.concatenate([self.starts, self.ends]), self.radii.T.reshape(-1, 1)
        return (points - radii).min(axis=0) - margin, (points + radii).max(axis=0) + margin


def cones_of(skeleton: Skeleton) -> Cones:
    """The cones of a skeleton; offsets and radii grow with its height."""
    size = _height(skeleton) / _height(SMPL24)
    rows = [*_MIDDLE, *_LEFT, *map(_mirrored, _LEFT)]
    starts = np.array([_place(skeleton, row[1], size) for row in rows], dtype=np.float32)
    ends = np.array([_place(skeleton, row[2], size) for row in rows], dtype=np.float32)
    radii = size * np.array([row[3:] for row in rows], dtype=np.float32)
    return Cones(tuple(skeleton.index(row[0]) for row in rows), starts, ends, radii)


def _height(skeleton: Skeleton) -> float:
    return float(np.ptp(skeleton.rest_positions[:, 1]))


def _place(skeleton: Skeleton, end: End, size: float) -> FloatArray:
    joint, offset = end
    return np.asarray(skeleton.rest_positions[skeleton.index(joint)] + size * np.array(offset), dtype=np.float32)


def _mirrored(row: tuple[str, End, End, float, float]) -> tuple[str, End, End, float, float]:
    bone, (start, (ax, ay, az)), (end, (bx, by, bz)), thick, thin = row
    names = (name.replace("left_", "right_") for name in (bone, start, end))
    return next(names), (next(names), (-ax, ay, az)), (next(names), (-bx, by, bz)), thick, thin
