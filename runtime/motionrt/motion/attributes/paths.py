"""Turning and travelling: how the body faces and where the pelvis goes over the ground."""

from __future__ import annotations

import numpy as np

from motionrt.motion.attributes.body import FPS, Array, Body, held, smooth, speed

_STEP = 6  # frames between two points of the path whose direction is compared
_MOVES = 0.06  # metres between them that count as moving
_CUSP = 1.4  # radians: a sharper change of direction is a turning back, not a bend


def turning(body: Body) -> dict[str, float]:
    """Net turn and the widest range of headings, degrees."""
    return {"turn": float(np.degrees(body.yaw[-1] - body.yaw[0])), "spin_extent": float(np.degrees(np.ptp(body.yaw)))}


def travelling(body: Body) -> dict[str, float]:
    """Where the body goes, metres, and how fast, m/s."""
    ground = body.ground
    start = float(body.yaw[: max(1, min(6, len(body.yaw)))].mean())
    ahead, left = _in_frame(body["pelvis"][-1, [0, 2]] - body["pelvis"][0, [0, 2]], np.array(start))
    walked = _in_frame(np.diff(ground, axis=0), body.yaw[:-1]) if len(ground) > 1 else (np.zeros(1), np.zeros(1))
    pace = smooth(speed(ground), 0.5)
    length = float(speed(ground)[:-1].sum() / FPS)
    return {
        "travel_forward": float(ahead),
        "travel_left": float(left),
        "walk_forward": float(walked[0].sum()),
        "walk_left": float(walked[1].sum()),
        "path_length": length,
        "farthest": float(np.linalg.norm(ground - ground[0], axis=1).max()),
        "speed_mean": length / body.seconds,
        "speed_max": held(pace),
        **_bend(ground),
    }


def _in_frame(steps: Array, yaw: Array) -> tuple[Array, Array]:
    """Steps over the ground ``(..., 2)`` as (forward, left) of somebody who faces ``yaw``."""
    x, z = steps[..., 0], steps[..., 1]
    return x * np.sin(yaw) + z * np.cos(yaw), x * np.cos(yaw) - z * np.sin(yaw)


def _bend(ground: Array) -> dict[str, float]:
    """How far the path bends, degrees, left positive, and its mean radius, metres (1,000 for a straight one)."""
    steps = np.diff(ground[::_STEP], axis=0)
    length = np.linalg.norm(steps, axis=1)
    moves = length > _MOVES
    if moves.sum() < 3:
        return {"path_bend": 0.0, "path_radius": 1000.0}
    heading = np.arctan2(steps[moves, 0], steps[moves, 1])
    change = (np.diff(heading) + np.pi) % (2 * np.pi) - np.pi
    change = change[np.abs(change) < _CUSP]
    count = len(change)
    bend = float(change.sum()) * (count + 1) / max(count, 1)
    radius = float(length[moves].sum()) / max(abs(bend), 1e-3)
    return {"path_bend": float(np.degrees(bend)), "path_radius": min(radius, 1000.0)}
