"""Standing, sitting, lying and the like: which posture at the start, at the end and at the lowest; jumps."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes.body import FPS, SIDES, Array, Body, held, running_low

POSTURES = ("standing", "bent", "crouching", "kneeling", "sitting", "crawling", "lying", "upside down")
"""Postures; their place in the list is their number, the later the farther from standing."""

_ENDS_S = 0.25  # seconds at each end that its posture is read from
_OFF, _SHORTEST_S, _LONGEST_S = 0.05, 0.1, 1.0  # a flight: metres off the floor, seconds
_LEAST = 0.07  # metres that a jump reaches at least
_LEAP = 0.16  # metres: a flight from one foot to the other counts as a jump from here on, below it is running

Numbers = npt.NDArray[np.intp]


def postures(body: Body) -> dict[str, float]:
    """Numbers of :data:`POSTURES`, heights of the pelvis (1 standing) and the lean of the trunk."""
    each, low = _each(body), body.low
    ends = max(1, min(round(_ENDS_S * FPS), len(low) // 2))
    lean = _lean(body)
    lasting = [k for k in range(len(POSTURES)) if (each == k).sum() >= min(round(0.2 * FPS), len(each))]
    return {
        "posture_start": float(_usual(each[:ends])),
        "posture_end": float(_usual(each[-ends:])),
        "posture_lowest": float(max(lasting, default=_usual(each))),
        "posture_most": float(_usual(each)),
        "pelvis_start": float(low[:ends].mean()),
        "pelvis_end": float(low[-ends:].mean()),
        "pelvis_lowest": float(-held(-low)),
        "lean_max": held(lean),
        "lean_mean": float(lean.mean()),
        "upside_down_share": float((each == 7).mean()),
    }


def jumps(body: Body) -> dict[str, float]:
    """How often both feet leave the floor, and how high at most, metres."""
    foot = np.stack([body[f"{s}_foot"][:, 1] for s in SIDES], axis=1)
    lowest = foot.min(axis=1)
    up = lowest - running_low(lowest, 1.5)
    hand = np.minimum(body["left_wrist"][:, 1], body["right_wrist"][:, 1])
    free = (up > _OFF) & (body.low > 0.55) & (hand > 0.2)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], free.astype(np.int8), [0]])))
    heights = [_flight(foot, up, start, stop) for start, stop in zip(edges[::2], edges[1::2], strict=True)]
    found = [height for height in heights if height > 0]
    return {"jumps": float(len(found)), "jump_height": max(found, default=0.0)}


def _flight(foot: Array, up: Array, start: int, stop: int) -> float:
    """Height of a flight that is a jump, else 0."""
    if not _SHORTEST_S * FPS <= stop - start <= _LONGEST_S * FPS:
        return 0.0
    height = float(up[start:stop].max())
    off, on = (foot[max(start - 1, 0)], foot[min(stop, len(foot) - 1)])
    strides = (off[0] - off[1]) * (on[0] - on[1]) < 0 and min(abs(off[0] - off[1]), abs(on[0] - on[1])) > 0.05
    return 0.0 if height < (_LEAP if strides else _LEAST) else height


def _lean(body: Body) -> Array:
    """``(F,)`` forward lean of the trunk, degrees."""
    trunk = body["neck"] - body["pelvis"]
    return np.asarray(np.degrees(np.arctan2((trunk * body.facing).sum(axis=1), np.maximum(trunk[:, 1], 1e-3))))


def _each(body: Body) -> Numbers:
    """``(F,)`` the posture of every frame."""
    trunk = body["neck"] - body["pelvis"]
    up = trunk[:, 1] / np.maximum(np.linalg.norm(trunk, axis=1), 1e-6)
    low, neck = body.low, body["neck"][:, 1] / body.standing
    knee = np.stack([body[f"{s}_knee"][:, 1] for s in SIDES], axis=1) / body.standing
    hand = np.maximum(body["left_wrist"][:, 1], body["right_wrist"][:, 1]) / body.standing
    thigh = np.stack([body[f"{s}_knee"] - body[f"{s}_hip"] for s in SIDES], axis=1)
    level = (thigh[..., 1] / np.maximum(np.linalg.norm(thigh, axis=2), 1e-6)).min(axis=1)
    feet = (body["left_ankle"] + body["right_ankle"]) / 2 - body["pelvis"]
    mass = 0.45 * trunk  # the middle of the trunk, from the pelvis
    before = ((feet - mass) * body.facing).sum(axis=1) / body.standing  # how far the feet stand before the trunk
    kneels = (knee.min(axis=1) < 0.17) & (low < 0.8)
    chair = (low < 0.9) & (level > -0.8) & (before > 0.16) & (knee.min(axis=1) > 0.22)
    floor = (low < 0.3) & (up > 0.4)
    rules = [
        (up < -0.35) & (body["head"][:, 1] < body["pelvis"][:, 1]) & (feet[:, 1] > -0.1 * body.standing),
        (neck < 0.5) & (low < 0.35) & (up < 0.55),
        (up < 0.6) & (hand < 0.3) & (knee.max(axis=1) < 0.35) & (low < 0.75),
        chair | floor,
        kneels & (up > 0.3),
        low < 0.82,
        _lean(body) > 38,
    ]
    return np.select(rules, [7, 6, 5, 4, 3, 2, 1], 0).astype(np.intp)


def _usual(numbers: Numbers) -> int:
    return int(np.bincount(numbers, minlength=len(POSTURES)).argmax())
