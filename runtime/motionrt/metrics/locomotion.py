"""Measures of walking and acting: foot skate, path, drift, jerk, end poses, keypoints  [Continual 4.3].

Arrays in, numbers out. Positions are global joints ``(F, 24, 3)`` of ``smpl24``, metres, Y up; ground positions are
``(F, 2)`` = (x, z). The floor is where the toe joint of a flat standing foot is: y = 0 after ``Motion.grounded()``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import SMPL24
from motionrt.motion.transforms import TOE_JOINTS

Floats = npt.NDArray[np.float64]

SKATE_HEIGHT_CM = 2.5
_TOES = [SMPL24.index(name) for name in TOE_JOINTS]
_CHUNK = 50_000  # pairs of a position and a piece of the path that are looked at together


def foot_skate(positions: npt.ArrayLike, floor: float = 0.0) -> float:
    """Foot skate in cm per frame: ``sum v_p (2 - 2 h_p / H) / frames`` where ``h_p <= H = 2.5 cm``  [Continual 4.3].

    Points p are the two toe joints and the sum runs over both, so the figure is of the whole body: one foot that slides
    along the floor at v gives 2 v. ``v_p`` is the step in the ground plane to the frame, in cm, and ``h_p`` the joint's
    height above ``floor`` there, not counted below zero. Frames are those that have a frame before them.

    It grows with the length of a frame: compare figures at one rate (30 fps).
    """
    return float(foot_skates(positions, floor).mean())


def foot_skates(positions: npt.ArrayLike, floor: float = 0.0) -> Floats:
    """``(F - 1,)``: what every frame adds to :func:`foot_skate`, cm."""
    return np.asarray(point_skates(_frames(positions, 2, _TOES) * 100, 100 * floor).sum(axis=1))


def point_skates(points: Floats, floor: float = 0.0) -> Floats:
    """``(F - 1, N)``: what points ``(F, N, 3)`` in cm add to :func:`foot_skate` in every frame; the floor in cm."""
    step = np.linalg.norm(np.diff(points[..., [0, 2]], axis=0), axis=-1)
    height = np.maximum(points[1:, :, 1] - floor, 0)
    return np.asarray(step * np.where(height <= SKATE_HEIGHT_CM, 2 - 2 * height / SKATE_HEIGHT_CM, 0))


def jerk(positions: npt.ArrayLike, fps: float) -> float:
    """Mean over joints and frames of the third derivative of position, m/s^3: third differences times ``fps^3``."""
    third = np.diff(_frames(positions, 4), n=3, axis=0) * fps**3
    return float(np.linalg.norm(third, axis=-1).mean())


def motion_energy(positions: npt.ArrayLike, fps: float) -> float:
    """Mean speed of the joints seen from the root, m/s; the root is joint 0 and its turn is not taken out."""
    joints = _frames(positions, 2)
    moved = np.diff(joints - joints[:, :1], axis=0) * fps
    return float(np.linalg.norm(moved[:, 1:], axis=-1).mean())


def path_distances(root_xz: npt.ArrayLike, path_xz: npt.ArrayLike) -> Floats:
    """``(F,)`` metres from each ground position ``(F, 2)`` to the polyline through ``(N >= 1, 2)``."""
    points, corners = _ground(root_xz, "root_xz"), _ground(path_xz, "path_xz")
    start, along = (corners[:-1], np.diff(corners, axis=0)) if len(corners) > 1 else (corners, np.zeros_like(corners))
    few = max(1, _CHUNK // len(start))
    return np.concatenate([_nearest(points[i : i + few], start, along) for i in range(0, len(points), few)])


def _nearest(points: Floats, start: Floats, along: Floats) -> Floats:
    """``(F,)`` distances of ``(F, 2)`` to the nearest of the pieces ``(N, 2)``."""
    (x, z), (u, w) = (points[:, None] - start).transpose(2, 0, 1), along.T
    share = (x * u + z * w) / np.maximum(u * u + w * w, 1e-18)
    share = np.minimum(np.maximum(share, 0), 1)
    squared = (x - share * u) ** 2 + (z - share * w) ** 2
    return np.asarray(np.sqrt(squared.min(axis=1)))


@dataclass(frozen=True)
class PathDeviation:
    """Distance of the root from its path, metres."""

    mean: float
    max: float


def path_deviation(root_xz: npt.ArrayLike, path_xz: npt.ArrayLike) -> PathDeviation:
    """Mean and largest of :func:`path_distances`."""
    distances = path_distances(root_xz, path_xz)
    return PathDeviation(float(distances.mean()), float(distances.max()))


def waypoint_distances(root_xz: npt.ArrayLike, waypoints_xz: npt.ArrayLike) -> Floats:
    """``(N,)``: how close the root ``(F, 2)`` ever comes to each waypoint ``(N, 2)``, metres."""
    root, waypoints = _ground(root_xz, "root_xz"), _ground(waypoints_xz, "waypoints_xz")
    return np.array([np.linalg.norm(root - waypoint, axis=1).min() for waypoint in waypoints])


def waypoints_reached(root_xz: npt.ArrayLike, waypoints_xz: npt.ArrayLike, radius: float) -> float:
    """Share, 0 to 1, of the waypoints that the root passes within ``radius`` metres."""
    return float((waypoint_distances(root_xz, waypoints_xz) <= radius).mean())


def drift(values: npt.ArrayLike, fps: float, seconds: float = 30.0) -> float:
    """Mean of the last ``seconds`` minus mean of the first, of any measure per frame ``(F,)``, in its unit.

    A motion shorter than twice that is cut into halves.
    """
    series = np.asarray(values, dtype=np.float64)
    if series.ndim != 1 or len(series) < 2:
        raise InvalidInputError(f"drift needs one number per frame and at least two frames, not {series.shape}")
    frames = max(1, min(round(seconds * fps), len(series) // 2))
    return float(series[-frames:].mean() - series[:frames].mean())


def standing_height(positions: npt.ArrayLike) -> float:
    """Median height of the pelvis, metres."""
    return float(np.median(_frames(positions, 1)[:, 0, 1]))


def keypoint_error(found: npt.ArrayLike, wanted: npt.ArrayLike) -> float:
    """Mean distance in cm between points ``(..., 3)`` in metres and where they should be."""
    a, b = np.asarray(found, dtype=np.float64), np.asarray(wanted, dtype=np.float64)
    if a.shape != b.shape or not a.size or a.shape[-1] != 3:
        raise InvalidInputError(f"points must be two arrays (..., 3) of one shape, not {a.shape} and {b.shape}")
    return float(100 * np.linalg.norm(a - b, axis=-1).mean())


@dataclass(frozen=True)
class EndError:
    """How far the last frame of a transition is from the pose it should end in.

    Attributes:
        joints_cm: mean distance of the joints.
        root_cm: distance of the pelvis.
        heading_deg: size of the turn about the vertical that fits one pose to the other best, pelvis on pelvis.
    """

    joints_cm: float
    root_cm: float
    heading_deg: float


def end_error(positions: npt.ArrayLike, target: npt.ArrayLike) -> EndError:
    """Compare a pose ``(J, 3)``, global joint positions in metres with the pelvis first, with its target ``(J, 3)``."""
    pose, aim = np.asarray(positions, dtype=np.float64), np.asarray(target, dtype=np.float64)
    joints, root = keypoint_error(pose, aim), keypoint_error(pose[0], aim[0])
    (x, z), (u, w) = ((body - body[0])[:, [0, 2]].T for body in (pose, aim))
    turn = np.arctan2((x * w - z * u).sum(), (x * u + z * w).sum())
    return EndError(joints, root, float(np.degrees(abs(turn))))


def _frames(positions: npt.ArrayLike, least: int, joints: Sequence[int] | None = None) -> Floats:
    """Positions ``(F, 24, 3)`` in float64, or those of ``joints``."""
    out = np.asarray(positions)
    if out.ndim != 3 or out.shape[1:] != (len(SMPL24), 3) or len(out) < least:
        raise InvalidInputError(f"positions must have the shape (frames >= {least}, {len(SMPL24)}, 3), not {out.shape}")
    return np.asarray(out if joints is None else out[:, joints], dtype=np.float64)


def _ground(points: npt.ArrayLike, name: str) -> Floats:
    out = np.asarray(points, dtype=np.float64)
    if out.ndim != 2 or out.shape[1] != 2 or not len(out):
        raise InvalidInputError(f"{name} must be ground positions (N >= 1, 2) = (x, z), not {out.shape}")
    return out
