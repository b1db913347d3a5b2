"""How far a motion is from what it had to keep to, constraint by constraint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.canvas import OWNERS
from motionrt.synthesis.constraints import GRID_S, Constraints, frame_of

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Miss:
    """How far one constraint was missed.

    Attributes:
        what: as in ``path`` or ``right_wrist``.
        time: seconds; of a kept clip that of its worst frame.
        cm: distance in centimetres: of the place, of the joint, or the mean over the joints of a pose.
        degrees: of the heading; None where none was wanted.
    """

    what: str
    time: float
    cm: float
    degrees: float | None = None


def misses(motion: Motion, constraints: Constraints) -> list[Miss]:
    """A row for every waypoint, target, keyframe and kept clip within the motion."""
    joints = np.asarray(motion.positions(), np.float64)
    features = ego77.encode(joints)  # the rates are of another frame rate; headings and poses are not
    yaw = ego77.facing(joints)
    found = [*_of_path(joints, yaw, motion.fps, constraints), *_of_targets(joints, yaw, motion.fps, constraints)]
    found += _of_poses(features, motion.fps, constraints)
    return found


def _frame(time: float, fps: float, count: int) -> int | None:
    frame = round(round(time / GRID_S) * GRID_S * fps)
    return frame if frame < count else None


def _seen(point: Array, joints: Array, yaw: Array) -> Array:
    """A point ``(3,)`` of the world in the frame of the first pose."""
    away = point - joints[0, 0] * [1.0, 0.0, 1.0]
    left, forward = ego77.to_body(away[0], away[2], yaw[0])
    return np.array([left, away[1], forward])


def _of_path(joints: Array, yaw: Array, fps: float, constraints: Constraints) -> Iterator[Miss]:
    ways = [("path", way.time, way.place, way.heading) for way in constraints.path]
    ways += [("keyframe", k.time, k.place, k.heading) for k in constraints.keyframes if k.place is not None]
    for what, time, place, heading in ways:
        frame = _frame(time, fps, len(joints))
        if frame is None or place is None:
            continue
        off = _seen(joints[frame, 0], joints, yaw)[[0, 2]] - place
        turned = None
        if heading is not None:
            turned = abs(float((np.degrees(yaw[frame] - yaw[0]) - heading + 180) % 360 - 180))
        yield Miss(what, time, 100 * float(np.linalg.norm(off)), turned)


def _of_targets(joints: Array, yaw: Array, fps: float, constraints: Constraints) -> Iterator[Miss]:
    for target in constraints.targets:
        frame = _frame(target.time, fps, len(joints))
        if frame is not None:
            there = _seen(joints[frame, SMPL24.index(target.joint)], joints, yaw)
            yield Miss(target.joint, target.time, 100 * float(np.linalg.norm(there - target.place)))


def _of_poses(features: npt.NDArray[np.float32], fps: float, constraints: Constraints) -> Iterator[Miss]:
    held = constraints.held(frame_of(constraints.last) + 1)
    columns = held.parts[:, OWNERS[ego77.JOINTS][::3]]  # one a joint
    poses = {frame_of(k.time): k.time for k in constraints.keyframes}
    worst: Miss | None = None
    for frame in np.flatnonzero(held.parts[:, [part != "global" for part in PARTS]].any(axis=1)).tolist():
        time = frame / ego77.FPS
        at = round(time * fps)
        if abs(time * fps - at) > 1e-6 or at >= len(features):
            continue
        off = _turned_alike(features[at], held.motion[frame])
        miss = Miss("pose", time, 100 * float(np.linalg.norm(off, axis=1)[columns[frame]].mean()))
        if frame in poses:
            yield miss
        elif worst is None or miss.cm > worst.cm:
            worst = Miss("kept", time, miss.cm)
    if worst is not None:
        yield worst


def _turned_alike(found: npt.NDArray[np.float32], wanted: npt.NDArray[np.float32]) -> Array:
    """``(23, 3)`` differences of the joints of two frames, turned about the vertical as alike as can be."""
    one, other = (np.asarray(row[ego77.JOINTS], np.float64).reshape(-1, 3) for row in (found, wanted))
    flat, like = one[:, 0] + 1j * one[:, 2], other[:, 0] + 1j * other[:, 2]
    turn = np.exp(1j * np.angle((np.conj(flat) * like).sum()))
    turned = flat * turn
    return np.stack([turned.real, one[:, 1], turned.imag], axis=1) - other
