"""Lying down and getting up again: sit on the edge, lift the legs, turn along the bed, lie back; and reversed.

The pose prior knows no lying body: this one is the standing pose laid on its back, and the way from the seat to it is
made joint by joint. The knees stretch first, so that shins pass over the edge, and the trunk goes down last.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.crowd import FPS
from motionrt.locomotion.footfalls import eased
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import (
    axis_angle_to_matrix,
    axis_rotation,
    matrix_to_axis_angle,
    wrapped,
)
from motionrt.motion.transforms import heading

FRAMES = 75  # of the way from the seat to lying
PITCH = np.radians(86.0)  # that the body leans back: not quite level, the head a little higher, as on a pillow
PELVIS = 0.13  # metres of the joint above the surface
SEAT_PELVIS, SEAT_DEPTH = 0.15, 0.22  # metres above the surface, and behind the edge, of somebody who sits on it
TOES, FOOT = 0.26, 0.11  # metres that the balls of the feet are before the edge, and beside the middle
STEP_AWAY = 0.45  # metres from the edge to where one stands before sitting down
HANDS_IN = 0.12  # radians that the arms are drawn to the body
# shares of the way in which parts move: first and last
_KNEES, _YAW, _BACK, _HIPS, _REST, _ROOT = (0.0, 0.45), (0.1, 0.75), (0.05, 1.0), (0.4, 1.0), (0.2, 1.0), (0.1, 0.9)
_KNEE_JOINTS = [SMPL24.index(name) for name in ("left_knee", "right_knee", "left_ankle", "right_ankle")]
_HIP_JOINTS = [SMPL24.index(name) for name in ("left_hip", "right_hip")]

Place = tuple[float, float]
Point = tuple[float, float, float]
Values = npt.NDArray[np.float64]


def lying(standing: Motion, at: Point, towards: float) -> Motion:
    """One frame on the back.

    Args:
        standing: one frame, upright, facing +Z.
        at: where the pelvis lies, (x, y, z) metres; y is the height of the surface.
        towards: radians from +Z towards +X that the feet point to, seen from the head; the body's heading.
    """
    rotations = standing.rotations[:1].astype(np.float64)
    own = float(heading(standing)[0])
    laid = axis_rotation("Y", towards) @ axis_rotation("X", -PITCH) @ axis_rotation("Y", -own)
    rotations[:, 0] = laid @ rotations[:, 0]
    for side, name in ((-1.0, "left_shoulder"), (1.0, "right_shoulder")):
        joint = SMPL24.index(name)
        rotations[:, joint] = axis_rotation("Z", side * HANDS_IN) @ rotations[:, joint]
    root = np.array([[at[0], at[1] + PELVIS, at[2]]])
    return Motion(rotations.astype(np.float32), root.astype(np.float32), FPS)


def seat_keypoints(at: Point, edge: Place, floor: float) -> tuple[dict[str, Point], float, Place]:
    """How to sit on the edge first.

    Args:
        at: where the pelvis will lie, (x, y, z) metres on the surface.
        edge: (x, z) the nearest place of the surface's edge.
        floor: height of the ground before it.

    Returns:
        keypoints, heading of somebody who sits there, and where to stand before.
    """
    way = np.array([edge[0] - at[0], edge[1] - at[2]])
    out = way / max(float(np.linalg.norm(way)), 1e-6)
    left, middle = np.array([out[1], -out[0]]), np.array(edge)
    pelvis, toes, stand = middle - SEAT_DEPTH * out, middle + TOES * out, middle + STEP_AWAY * out

    def point(place: Values, height: float) -> Point:
        return float(place[0]), float(height), float(place[1])

    points = {
        "pelvis": point(pelvis, at[1] + SEAT_PELVIS),
        "left_foot": point(toes + FOOT * left, floor),
        "right_foot": point(toes - FOOT * left, floor),
    }
    return points, float(np.arctan2(out[0], out[1])), (float(stand[0]), float(stand[1]))


def lie_back(seat: Motion, aim: Motion) -> Motion:
    """The frames from sitting on the edge to lying; the last one is ``aim``, exactly.

    Args:
        seat: one frame, sitting.
        aim: one frame, from :func:`lying`.
    """
    now = np.arange(1, FRAMES + 1) / FRAMES
    first, last = seat.rotations[0].astype(np.float64), aim.rotations[0].astype(np.float64)
    yaws = float(heading(seat)[0]), float(heading(aim)[0])
    first[0], last[0] = axis_rotation("Y", -yaws[0]) @ first[0], axis_rotation("Y", -yaws[1]) @ last[0]
    share = np.repeat(_part(now, _REST)[:, None], len(first), axis=1)
    share[:, _KNEE_JOINTS], share[:, _HIP_JOINTS] = _part(now, _KNEES)[:, None], _part(now, _HIPS)[:, None]
    share[:, 0] = _part(now, _BACK)
    ways = matrix_to_axis_angle(np.swapaxes(first, -1, -2) @ last)
    rotations = first @ axis_angle_to_matrix(ways * share[..., None])
    yaw = yaws[0] + float(wrapped(yaws[1] - yaws[0])) * _part(now, _YAW)
    rotations[:, 0] = axis_rotation("Y", yaw) @ rotations[:, 0]
    way = (aim.root[0] - seat.root[0]).astype(np.float64)
    root = seat.root[0] + _part(now, _ROOT)[:, None] * way
    rotations[-1], root[-1] = aim.rotations[0], aim.root[0]
    return Motion(rotations.astype(np.float32), root.astype(np.float32), FPS)


def reversed_in_time(motion: Motion, before: Motion) -> Motion:
    """A motion backwards, ending with the frame that came ``before`` it."""
    rotations = np.concatenate([motion.rotations[-2::-1], before.rotations[-1:]])
    root = np.concatenate([motion.root[-2::-1], before.root[-1:]])
    return Motion(rotations, root, motion.fps)


def _part(now: Values, span: tuple[float, float]) -> Values:
    return eased((now - span[0]) / (span[1] - span[0]))
