"""Numbers of what a motion does, scaled to about -1 to 1: what auxiliary regression heads learn."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import Attributes
from motionrt.motion.skeleton import FloatArray
from motionrt.text.query import TextAttributes

_SCALED = {  # name -> (attributes, scale): tanh(attribute / scale)
    "turn": ("turn", 120.0),
    "path_bend": ("path_bend", 180.0),
    "walk_forward": ("walk_forward", 2.0),
    "walk_left": ("walk_left", 1.0),
    "speed_mean": ("speed_mean", 2.0),
    "spin_extent": ("spin_extent", 240.0),
    "arm_dominance": ("arm_dominance", 0.4),
    "leg_dominance": ("leg_dominance", 0.3),
    "left_hand_up": ("left_hand_over_shoulder", 0.3),
    "right_hand_up": ("right_hand_over_shoulder", 0.3),
    "left_foot_lift": ("left_foot_lift", 0.4),
    "right_foot_lift": ("right_foot_lift", 0.4),
    "pelvis_start": ("pelvis_start", 1.0),
    "pelvis_end": ("pelvis_end", 1.0),
    "pelvis_lowest": ("pelvis_lowest", 1.0),
    "jump_height": ("jump_height", 0.2),
    "hands_speed": ("left_hand_speed", 1.0),
    "feet_speed": ("left_foot_speed", 1.0),
}
TARGETS = tuple(_SCALED)
"""Names of the numbers of :func:`attribute_targets`, in order."""


def attribute_targets(attributes: Attributes) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """``(A,)`` float32 numbers named :data:`TARGETS`, and ``(A,)`` which of them mean something in this clip.

    A turn or a path says nothing when somebody lies or stands on his head, a bend nothing without a path, and a side
    that moves most nothing when no limb moves.
    """
    a = attributes
    values = {name: getattr(a, source) for name, (source, _) in _SCALED.items()}
    values["hands_speed"] = max(a.left_hand_speed, a.right_hand_speed)
    values["feet_speed"] = max(a.left_foot_speed, a.right_foot_speed)
    upright = min(a.pelvis_start, a.pelvis_end) > 0.5 and a.upside_down_share < 0.1
    known = dict.fromkeys(TARGETS, True)
    known |= dict.fromkeys(("turn", "spin_extent", "left_foot_lift", "right_foot_lift"), upright)
    known["path_bend"] = a.path_length > 1.0
    known["arm_dominance"] = a.left_hand_speed + a.right_hand_speed > 0.2
    known["leg_dominance"] = a.left_foot_speed + a.right_foot_speed > 0.2
    scaled = np.tanh([values[name] / scale for name, (_, scale) in _SCALED.items()])
    return scaled.astype(np.float32), np.array([known[name] for name in TARGETS])


_TURNS = {"turn": 80.0, "around": 178.0, "full": 360.0}  # degrees; here and below medians of recordings that do it
_BENDS = {"curve": 108.0, "circle": 290.0}
_SPEEDS = {"still": 0.05, "slow": 0.45, "walk": 1.0, "jog": 2.0, "run": 3.0}  # m/s; a walk is a little brisker
_SIDEWAYS = 0.42  # m/s
_BACKWARD = 0.55
_DOMINANCE = {"arm": 0.24, "leg": 0.22}
_HAND_UP, _FOOT_UP, _JUMP = 0.3, 0.6, 0.2  # m
_HEIGHTS = {
    "standing": 0.97, "bent": 0.92, "crouching": 0.72, "kneeling": 0.49, "sitting": 0.55, "crawling": 0.45,
    "lying": 0.18,
}  # fmt: skip
_LEFT = {"left": 1.0, "right": -1.0}


def targets_of_text(said: TextAttributes, seconds: float) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """The numbers ``(A,)`` that a text stands for in a motion of so many seconds, and ``(A,)`` which it says at all.

    A text has no numbers; these are what recordings of its classes usually have.
    """
    found = {**_turning(said), **_travelling(said, seconds), **_limbs(said), **_heights(said)}
    values = np.array([np.tanh(found.get(name, 0.0) / _SCALED[name][1]) for name in TARGETS], np.float32)
    return values, np.array([name in found for name in TARGETS])


def _turning(s: TextAttributes) -> dict[str, float]:
    found: dict[str, float] = {}
    if s.turn == "none" or s.path == "straight":
        found |= {"turn": 0.0}
    elif s.turn is not None:
        size = _TURNS[s.turn]
        found |= {"spin_extent": size}
        found |= {"turn": _LEFT[s.turn_side] * size} if s.turn_side in _LEFT else {}
    if s.path == "straight":
        found |= {"path_bend": 0.0}
    elif s.path in _BENDS and s.path_side in _LEFT:
        found |= {"path_bend": _LEFT[s.path_side] * _BENDS[s.path]}
    elif s.path == "spin":
        found |= {"spin_extent": 380.0}
    return found


def _travelling(s: TextAttributes, seconds: float) -> dict[str, float]:
    pace = _SPEEDS.get(s.speed or "")
    found = {} if pace is None else {"speed_mean": pace}
    if s.travel == "forward" and s.path is None and s.turn in (None, "none"):
        found |= {"walk_forward": (pace or 0.6) * seconds}
    elif s.travel == "backward":
        found |= {"walk_forward": -_BACKWARD * seconds}
    elif s.travel in _LEFT:
        found |= {"walk_forward": 0.0, "walk_left": _LEFT[s.travel] * _SIDEWAYS * seconds}
    elif s.travel == "none":
        found |= {"walk_forward": 0.0, "walk_left": 0.0}
    return found


def _limbs(s: TextAttributes) -> dict[str, float]:
    found: dict[str, float] = {}
    if s.arm in _LEFT:
        found |= {"arm_dominance": _LEFT[s.arm] * _DOMINANCE["arm"]}
    if s.leg in _LEFT:
        found |= {"leg_dominance": _LEFT[s.leg] * _DOMINANCE["leg"]}
    for side in ("left", "right"):
        if s.arms_up in (side, "both"):
            found |= {f"{side}_hand_up": _HAND_UP}
        if s.foot_lift in (side, "both"):
            found |= {f"{side}_foot_lift": _FOOT_UP}
    return found


def _heights(s: TextAttributes) -> dict[str, float]:
    told = {"pelvis_start": s.posture_start, "pelvis_end": s.posture_end, "pelvis_lowest": s.posture_lowest}
    found = {name: _HEIGHTS[posture] for name, posture in told.items() if posture in _HEIGHTS}
    return found | ({"jump_height": _JUMP} if s.jumps else {})


def mirror_targets(targets: npt.ArrayLike) -> FloatArray:
    """Numbers ``(..., A)`` of the mirror image; what is known of it is the same, sides exchanged."""
    return np.asarray(np.asarray(targets, np.float32)[..., _TWIN] * _SIGNS)


def mirror_known(known: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Which numbers ``(..., A)`` mean something in the mirror image."""
    return np.asarray(np.asarray(known, bool)[..., _TWIN])


def _twin(name: str) -> str:
    side, _, rest = name.partition("_")
    return {"left": "right_", "right": "left_"}.get(side, side + "_") + rest if rest else name


_TWIN = [TARGETS.index(_twin(name)) for name in TARGETS]
_SIGNED = ("turn", "path_bend", "walk_left", "arm_dominance", "leg_dominance")
_SIGNS = np.array([-1.0 if name in _SIGNED else 1.0 for name in TARGETS], np.float32)
