"""The condition vector that training and runtime share: the same classes from a motion and from a text.

Class 0 of every slot is unknown. Motions near the border of two classes, and texts that leave it open, are unknown.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import POSTURES, Attributes
from motionrt.text.query import ACTIONS, TextAttributes

IntArray = npt.NDArray[np.int64]

CLASSES: Mapping[str, tuple[str, ...]] = {
    "turn": ("none", "left", "right", "around left", "around right", "full left", "full right", "around", "turn"),
    "travel": ("forward", "backward", "left", "right", "none", "sideways"),
    "path": (
        "straight",
        *("curve left", "curve right", "circle left", "circle right", "spin left", "spin right"),
        *("curve", "circle", "spin"),
    ),
    "speed": ("still", "slow", "walk", "jog", "run"),
    "arms_up": ("left", "right", "both", "none", "one"),
    "arm": ("left", "right", "both"),
    "foot_lift": ("left", "right", "both", "none", "one"),
    "leg": ("left", "right", "both"),
    "posture_start": POSTURES,
    "posture_end": POSTURES,
    "posture_lowest": POSTURES,
    "level": ("level", "down", "up", "down and up"),
    "jumps": ("none", "once", "several"),
    "steps": ("none", "in place", "along"),
    "arms_move": ("still", "little", "much", "very much"),
    "legs_move": ("still", "little", "much", "very much"),
    "torso_move": ("still", "little", "much", "very much"),
    "hands_low": ("no", "yes"),
    "hands_together": ("no", "yes"),
    "lean": ("no", "yes"),
    "action": ACTIONS,
}
"""Slot -> names of its classes 1, 2, ...; class 0 is unknown. Classes without a side come from texts only."""

SLOTS: Mapping[str, int] = {name: len(classes) + 1 for name, classes in CLASSES.items()}
"""Slot -> number of its classes, the unknown one included; the order of the condition vector."""

_SIDELESS = {
    "turn": {"left": "turn", "right": "turn", "around left": "around", "around right": "around"},
    "travel": {"left": "sideways", "right": "sideways"},
    "path": {f"{kind} {side}": kind for kind in ("curve", "circle", "spin") for side in ("left", "right")},
    "arms_up": {"left": "one", "right": "one"},
    "foot_lift": {"left": "one", "right": "one"},
}
_MARGIN = 0.12  # share of a border's value on both sides of it in which a motion's class is unknown


def slots_of_motion(attributes: Attributes) -> IntArray:
    """``(S,)`` classes of what a motion does, in the order of :data:`SLOTS`; the action is unknown."""
    a = attributes
    upright = min(a.pelvis_start, a.pelvis_end) > 0.6 and a.upside_down_share == 0
    start, end, lowest = a.posture_names
    named = {
        "turn": _turn(a) if upright else None,
        "travel": _travel(a),
        "path": _path(a),
        "speed": _binned(a.speed_mean, (0.12, 0.6, 1.6, 2.5), CLASSES["speed"]),
        "arms_up": _arms_up(a),
        "arm": _dominant(a.arm_dominance, a.left_hand_speed + a.right_hand_speed),
        "foot_lift": _foot_lift(a) if upright else None,
        "leg": _dominant(a.leg_dominance, a.left_foot_speed + a.right_foot_speed),
        "posture_start": start,
        "posture_end": end,
        "posture_lowest": lowest,
        "level": _level(a),
        "jumps": ("none", "once", "several")[min(int(a.jumps), 2)],
        "steps": "none" if a.steps < 1 else None if a.steps < 3 else "in place" if a.farthest < 0.4 else "along",
        "arms_move": _binned(max(a.left_hand_speed, a.right_hand_speed), (0.15, 0.5, 1.1), CLASSES["arms_move"]),
        "legs_move": _binned(max(a.left_foot_speed, a.right_foot_speed), (0.12, 0.45, 1.4), CLASSES["legs_move"]),
        "torso_move": _binned(a.torso_speed, (0.05, 0.15, 0.35), CLASSES["torso_move"]),
        "hands_low": _yes(-a.lowest_hand, -0.5, 0.08),
        "hands_together": _yes(a.hands_together_share, 0.12, 0.06),
        "lean": _yes(a.lean_max, 35, 7),
    }
    return _vector(named)


def slots_of_text(said: TextAttributes) -> IntArray:
    """``(S,)`` classes of what a text says, in the order of :data:`SLOTS`."""
    s = said
    named = {
        "turn": _turn_said(s),
        "travel": s.travel,
        "path": " ".join(filter(None, (s.path, s.path_side))) if s.path else None,
        "speed": s.speed,
        "arms_up": s.arms_up,
        "arm": s.arm,
        "foot_lift": s.foot_lift,
        "leg": s.leg,
        "posture_start": s.posture_start,
        "posture_end": s.posture_end,
        "posture_lowest": s.posture_lowest,
        "level": s.level,
        "jumps": None if s.jumps is None else "none" if s.jumps == 0 else "once" if s.jumps == 1 else "several",
        "steps": s.steps,
        **{name: _level_name(getattr(s, name)) for name in ("arms_move", "legs_move", "torso_move")},
        **{name: {True: "yes", False: "no"}.get(getattr(s, name)) for name in ("hands_low", "hands_together", "lean")},
        "action": s.action,
    }
    return _vector(named)


def mirror_slots(slots: npt.ArrayLike) -> IntArray:
    """Classes ``(..., S)`` with left and right exchanged."""
    return _mapped(slots, _MIRROR)


def sideless_slots(slots: npt.ArrayLike) -> IntArray:
    """Classes ``(..., S)`` as a text would give them that names no side ("turns around", "waves"): for training."""
    return _mapped(slots, _PLAIN)


def _vector(named: Mapping[str, str | None]) -> IntArray:
    return np.array([0 if (v := named.get(slot)) is None else _NUMBER[slot][v] for slot in SLOTS], dtype=np.int64)


def _swapped(name: str) -> str:
    return " ".join({"left": "right", "right": "left"}.get(word, word) for word in name.split())


_NUMBER = {slot: {name: k for k, name in enumerate(classes, 1)} for slot, classes in CLASSES.items()}
_MIRROR = [[0, *(_NUMBER[slot][_swapped(name)] for name in classes)] for slot, classes in CLASSES.items()]
_PLAIN = [
    [0, *(_NUMBER[slot][_SIDELESS.get(slot, {}).get(name, name)] for name in classes)]
    for slot, classes in CLASSES.items()
]


def _mapped(slots: npt.ArrayLike, tables: list[list[int]]) -> IntArray:
    given = np.asarray(slots, dtype=np.int64)
    return np.stack([np.array(table)[given[..., k]] for k, table in enumerate(tables)], axis=-1)


def _turn(a: Attributes) -> str | None:
    side, size = ("left" if a.turn > 0 else "right"), abs(a.turn)
    if size < 25:
        return "none"
    if 40 < size < 125:
        return side
    if 140 < size < 230:
        return f"around {side}"
    return f"full {side}" if size > 290 else None


def _turn_said(s: TextAttributes) -> str | None:
    if s.turn in (None, "none"):
        return s.turn
    if s.turn == "full":
        return f"full {s.turn_side}" if s.turn_side else None
    if s.turn == "around":
        return f"around {s.turn_side}" if s.turn_side else "around"
    return s.turn_side or "turn"


def _travel(a: Attributes) -> str | None:
    forward, left = a.walk_forward, a.walk_left
    if a.farthest < 0.4:
        return "none"
    if abs(forward) > 1.6 * abs(left) and abs(forward) > 0.45:
        return "forward" if forward > 0 else "backward"
    if abs(left) > 1.3 * abs(forward) and abs(left) > 0.35:
        return "left" if left > 0 else "right"
    return None


def _path(a: Attributes) -> str | None:
    bend, size = a.path_bend, abs(a.path_bend)
    if a.spin_extent > 300 and (a.path_length < 2.0 or a.path_radius < 0.35):
        return f"spin {'left' if a.turn > 0 else 'right'}" if abs(a.turn) > 200 else None
    along = abs(a.walk_forward) > 0.6 * a.path_length and a.path_length > 1.2
    if not along:
        return None
    if size < 25 and abs(a.turn) < 30:
        return "straight"
    if size > 235:
        return "circle left" if bend > 0 else "circle right"
    turned = a.turn * bend > 0 and a.path_radius > 0.5
    return ("curve left" if bend > 0 else "curve right") if 40 < size < 215 and turned else None


def _arms_up(a: Attributes) -> str | None:
    left, right = a.left_hand_over_shoulder, a.right_hand_over_shoulder
    if max(left, right) < -0.08:
        return "none"
    if a.both_hands_over_shoulder > 0.06 and abs(left - right) < 0.15:
        return "both"
    alone = 0.2 if a.both_hands_over_shoulder > 0.0 else 0.12
    return ("left" if left > right else "right") if max(left, right) > 0.03 and abs(left - right) > alone else None


def _foot_lift(a: Attributes) -> str | None:
    left, right = a.left_foot_lift, a.right_foot_lift
    if max(left, right) < 0.24:
        return "none"
    share = min(left, right) / max(left, right)
    if max(left, right) < 0.28 or 0.55 < share < 0.65:
        return None
    return "both" if share > 0.6 else "left" if left > right else "right"


def _level(a: Attributes) -> str | None:
    start, end, low = a.pelvis_start, a.pelvis_end, a.pelvis_lowest
    if start - end > 0.25:
        return "down"
    if end - start > 0.25:
        return "up"
    if min(start, end) - low > 0.2 and abs(start - end) < 0.18:
        return "down and up"
    return "level" if max(start, end) - low < 0.14 else None


def _dominant(share: float, speed: float) -> str | None:
    if speed < 0.2:
        return None
    return "both" if abs(share) < 0.07 else None if abs(share) < 0.14 else "left" if share > 0 else "right"


def _binned(value: float, borders: tuple[float, ...], names: tuple[str, ...]) -> str | None:
    if any(abs(value - border) < _MARGIN * border for border in borders):
        return None
    return names[int(np.searchsorted(borders, value))]


def _yes(value: float, border: float, margin: float) -> str | None:
    return "yes" if value > border + margin else "no" if value < border - margin else None


def _level_name(level: int | None) -> str | None:
    return None if level is None else CLASSES["arms_move"][level - 1]
