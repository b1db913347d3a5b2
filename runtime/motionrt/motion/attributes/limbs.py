"""Hands, feet and trunk: how high, how far, how much, and which side does most of it."""

from __future__ import annotations

import numpy as np

from motionrt.motion.attributes.body import FPS, SIDES, Array, Body, cycles, held, running_low, speed

_TOGETHER = 0.22  # metres between the hands
_CLAP = 0.08  # metres that they part between two claps
_STEP = 0.035  # metres that a foot is lifted in a step
_QUIET = 0.2  # m/s: slower than that nothing moves
_LIMBS = (
    ("left_wrist", "left_shoulder"),
    ("right_wrist", "right_shoulder"),
    ("left_ankle", "left_hip"),
    ("right_ankle", "right_hip"),
    ("neck", "pelvis"),
)
_SPEEDS = ("left_hand_speed", "right_hand_speed", "left_foot_speed", "right_foot_speed", "torso_speed")


def hands(body: Body) -> dict[str, float]:
    """Heights of the hands, metres; how close they come, and how often they meet."""
    over = {s: body[f"{s}_wrist"][:, 1] - body[f"{s}_shoulder"][:, 1] for s in SIDES}
    head = {s: body[f"{s}_wrist"][:, 1] - body["head"][:, 1] for s in SIDES}
    apart = np.linalg.norm(body["left_hand"] - body["right_hand"], axis=1)
    lowest = np.minimum(body["left_wrist"][:, 1], body["right_wrist"][:, 1])
    near = float(-held(-apart))
    return {
        **{f"{s}_hand_over_shoulder": held(over[s]) for s in SIDES},
        **{f"{s}_hand_over_head": held(head[s]) for s in SIDES},
        **{f"{s}_hand_up_share": float((over[s] > 0).mean()) for s in SIDES},
        "both_hands_over_shoulder": held(np.minimum(over["left"], over["right"])),
        "lowest_hand": float(-held(-lowest)),
        "hands_apart": near,
        "hands_together_share": float((apart < _TOGETHER).mean()),
        "claps": float(cycles(-apart, _CLAP)) if near < _TOGETHER else 0.0,
    }


def feet(body: Body) -> dict[str, float]:
    """How high each ankle is lifted above the ground near it, metres, and the number of steps."""
    ankle = {s: body[f"{s}_ankle"][:, 1] for s in SIDES}
    floor = running_low(np.minimum(ankle["left"], ankle["right"]), 1.5)
    upright = body.low > 0.45
    steps = sum(cycles(np.where(upright, ankle[s] - floor, 0.0), _STEP) for s in SIDES)
    return {**{f"{s}_foot_lift": held(ankle[s] - floor) for s in SIDES}, "steps": float(steps)}


def moving(body: Body) -> dict[str, float]:
    """How much each limb moves about its root, m/s, and which side moves more, -1 (right) to 1 (left)."""
    each = body.moving(_LIMBS)
    mean = each.mean(axis=0).tolist()
    quiet = np.maximum(each.max(axis=1), speed(body.ground)) < _QUIET
    return {
        **dict(zip(_SPEEDS, mean, strict=True)),
        **{name.replace("speed", "peak"): held(each[:, k]) for k, name in enumerate(_SPEEDS[:4])},
        "arm_dominance": _more(mean[0], mean[1]),
        "leg_dominance": _more(mean[2], mean[3]),
        "stillness": float(quiet.mean()),
    }


def repetition(body: Body) -> dict[str, float]:
    """How often a movement of hands, feet and head repeats; 0 where no period shows."""
    ends = [body.own[:, j] for j in (15, 20, 21, 7, 8)]
    away = np.concatenate(ends, axis=1)
    away -= away.mean(axis=0)
    spread = away.T @ away / len(away)
    if len(away) < FPS or np.trace(spread) < 1e-3:
        return {"repetitions": 0.0}
    line = away @ np.linalg.eigh(spread)[1][:, -1]
    period = _period(line)
    return {"repetitions": round(len(line) / period, 2) if period else 0.0}


def _period(line: Array) -> int:
    """Frames after which a line looks like itself again, or 0."""
    n = len(line)
    power = np.abs(np.fft.rfft(line, 2 * n)) ** 2
    alike = np.fft.irfft(power)[: n * 2 // 3]
    alike = alike / (alike[0] + 1e-12) * (n / np.arange(n, n - len(alike), -1))
    below = np.flatnonzero(alike < 0)
    if not len(below):
        return 0
    later = alike[below[0] :]
    best = int(np.argmax(later))
    near = np.flatnonzero((later[1:-1] > 0.85 * later[best]) & (later[1:-1] >= later[2:]) & (later[1:-1] > later[:-2]))
    first = int(near[0]) + 1 if len(near) else best
    return below[0] + first if later[first] > 0.5 else 0


def _more(left: float, right: float) -> float:
    return (left - right) / max(left + right, 1e-6)
