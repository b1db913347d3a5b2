"""How well motions fit each thing that a text says: one term for every attribute that it names.

A score rises smoothly from 0 to 1 between two values; a side is judged by a curve through 0.5 at no side at all, so
that a motion and its mirror image add up to 1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import POSTURES
from motionrt.text.query import TextAttributes

Array = npt.NDArray[np.float64]
Columns = Mapping[str, Array]
_HEIGHTS = {"standing": 1.0, "bent": 0.97, "crouching": 0.62, "kneeling": 0.55, "sitting": 0.5, "crawling": 0.45}
_HEIGHTS |= {"lying": 0.12, "upside down": 0.8}
_SPEEDS = {"still": 0.05, "slow": 0.5, "walk": 1.1, "jog": 2.1, "run": 3.3}  # m/s


@dataclass(frozen=True)
class Term:
    """One thing that a text says, judged for ``N`` motions.

    Attributes:
        said: in words, as in "turn left".
        shown: the attribute that is told beside it.
        score: ``(N,)`` 0 (does not fit) to 1.
        weight: how much it counts.
        sided: whether it is about left or right.
    """

    said: str
    shown: str
    score: Array
    weight: float = 1.0
    sided: bool = False


def terms_of(said: TextAttributes, columns: Columns) -> list[Term]:
    """Everything that a text says and the columns of attributes can judge."""
    return [term for judge in _JUDGES for term in judge(said, columns)]


def rise(values: Array, low: float, high: float) -> Array:
    """0 below ``low``, 1 above ``high``, smooth between; ``low`` above ``high`` falls instead."""
    part = np.clip((values - low) / (high - low), 0.0, 1.0)
    return np.asarray(part * part * (3 - 2 * part))


def between(values: Array, low: float, full: float, until: float, high: float) -> Array:
    """1 from ``full`` to ``until``, falling to 0 at ``low`` and ``high``."""
    return rise(values, low, full) * rise(values, high, until)


def toward(side: str, values: Array, scale: float) -> Array:
    """0.5 at 0, near 1 at ``scale`` for the left (or minus that for the right)."""
    sign = 1.0 if side == "left" else -1.0
    return np.asarray(0.5 + 0.5 * np.tanh(sign * values / scale * 1.5))


def _turns(said: TextAttributes, c: Columns) -> list[Term]:
    kind, side = said.turn, said.turn_side
    found = [Term(f"turn {kind}", "turn", _amount(kind, c))] if kind else []
    if side and not said.path:
        found.append(Term(f"turn {side}", "turn", toward(side, _sideways(c, kind), 1.0), 2.0, sided=True))
    return found


def _amount(kind: str, c: Columns) -> Array:
    size = np.abs(c["turn"])
    if kind == "none":
        return rise(size, 60, 20)
    if kind == "turn":
        return between(size, 15, 50, 150, 260)
    if kind == "around":
        return between(np.maximum(size, 0.8 * c["spin_extent"]), 80, 140, 230, 330)
    return rise(c["spin_extent"], 180, 300)


def _sideways(c: Columns, kind: str | None) -> Array:
    """How far to the left it goes: by turning; where no turn is named, by its path and its steps, too."""
    turned = c["turn"] / 45
    return turned if kind else turned + c["path_bend"] / 90 + c["walk_left"] / 0.6


def _paths(said: TextAttributes, c: Columns) -> list[Term]:
    if not said.path:
        return []
    found = [Term(said.path, "path_bend", _shape(said.path, c))]
    if said.path_side:
        lean = c["turn"] / 60 if said.path == "spin" else c["path_bend"] / 60 + c["turn"] / 120
        fits = toward(said.path_side, lean, 1.0)
        found.append(Term(f"{said.path} {said.path_side}", "path_bend", fits, 2.0, sided=True))
    return found


def _shape(path: str, c: Columns) -> Array:
    size = np.abs(c["path_bend"])
    if path == "straight":
        return np.asarray(rise(size, 80, 25) * rise(np.abs(c["turn"]), 80, 30))
    if path == "spin":
        return np.asarray(rise(c["spin_extent"], 150, 320) * rise(c["speed_mean"], 1.5, 0.7))
    return rise(size, 20, 60) if path == "curve" else rise(size, 90, 240)


def _travels(said: TextAttributes, c: Columns) -> list[Term]:
    found = []
    if said.travel in ("left", "right"):
        found.append(Term(f"go {said.travel}", "walk_left", toward(said.travel, c["walk_left"], 0.4), 2.0, sided=True))
    if said.travel:
        shown = {"none": "farthest", "forward": "walk_forward", "backward": "walk_forward"}.get(
            said.travel, "walk_left"
        )
        found.append(Term(f"travel {said.travel}", shown, _along(said.travel, c)))
    if said.steps == "in place":
        found.append(Term("steps in place", "steps", rise(c["steps"], 1, 4) * rise(c["farthest"], 1.3, 0.5)))
    return found


def _along(travel: str, c: Columns) -> Array:
    if travel == "forward":
        return rise(c["walk_forward"], 0.0, 0.6)
    if travel == "backward":
        return rise(-c["walk_forward"], 0.0, 0.5)
    if travel == "none":
        return rise(c["farthest"], 1.3, 0.4)
    return rise(np.abs(c["walk_left"]) / (np.abs(c["walk_forward"]) + 0.2), 0.3, 1.1)


def _speeds(said: TextAttributes, c: Columns) -> list[Term]:
    found, speed = [], c["speed_mean"]
    if said.speed:
        away = np.log((np.maximum(speed, 0) + 0.15) / (_SPEEDS[said.speed] + 0.15))
        found.append(Term(said.speed, "speed_mean", np.exp(-((away / 0.6) ** 2))))
    if said.still:
        found.append(Term("still", "stillness", rise(c["stillness"], 0.2, 0.8)))
    if said.pace and not said.speed:
        limbs = np.maximum.reduce([c["left_hand_speed"], c["right_hand_speed"], c["left_foot_speed"], speed])
        fits = rise(limbs, 0.4, 1.6) if said.pace == "fast" else rise(limbs, 1.8, 0.7)
        found.append(Term(said.pace, "speed_mean", fits, 0.5))
    return found


def _arms(said: TextAttributes, c: Columns) -> list[Term]:
    found = []
    high = {s: c[f"{s}_hand_over_shoulder"] for s in ("left", "right")}
    highest = np.maximum(high["left"], high["right"])
    if said.arms_up in ("left", "right"):
        side = said.arms_up
        fits = toward(side, high["left"] - high["right"], 0.2)
        found.append(Term(f"{side} hand up", f"{side}_hand_over_shoulder", fits, 1.5, sided=True))
        found.append(Term("hand up", f"{side}_hand_over_shoulder", rise(high[side], -0.25, 0.05)))
    elif said.arms_up:
        heights = {"both": rise(c["both_hands_over_shoulder"], -0.25, 0.08), "one": rise(highest, -0.25, 0.05)}
        heights["none"] = rise(highest, 0.0, -0.2)
        shown = "both_hands_over_shoulder" if said.arms_up == "both" else "left_hand_over_shoulder"
        found.append(Term(f"hands up: {said.arms_up}", shown, heights[said.arms_up]))
    if said.arm in ("left", "right") and said.arms_up not in ("left", "right"):
        fits = toward(said.arm, c["arm_dominance"] + _reach(c), 0.3)
        found.append(Term(f"{said.arm} arm", "arm_dominance", fits, 1.5, sided=True))
    elif said.arm in ("left", "right"):
        found.append(
            Term(f"{said.arm} arm", "arm_dominance", toward(said.arm, c["arm_dominance"], 0.3), 1.0, sided=True)
        )
    return found


def _reach(c: Columns) -> Array:
    """Which hand is quicker at its quickest, -1 (right) to 1 (left)."""
    left, right = c["left_hand_peak"], c["right_hand_peak"]
    return np.asarray((left - right) / np.maximum(left + right, 0.3))


def _legs(said: TextAttributes, c: Columns) -> list[Term]:
    found, lift = [], {s: c[f"{s}_foot_lift"] for s in ("left", "right")}
    more = lift["left"] - lift["right"]
    if said.foot_lift in ("left", "right"):
        fits = toward(said.foot_lift, more, 0.15)
        found.append(Term(f"{said.foot_lift} foot", f"{said.foot_lift}_foot_lift", fits, 2.0, sided=True))
        found.append(Term("foot lifted", f"{said.foot_lift}_foot_lift", rise(lift[said.foot_lift], 0.1, 0.3)))
    elif said.foot_lift in ("one", "both"):
        height = np.maximum(lift["left"], lift["right"]) if said.foot_lift == "one" else np.minimum(*lift.values())
        found.append(Term(f"feet lifted: {said.foot_lift}", "left_foot_lift", rise(height, 0.1, 0.32)))
    if said.leg in ("left", "right") and said.foot_lift not in ("left", "right"):
        fits = toward(said.leg, c["leg_dominance"] + more, 0.2)
        found.append(Term(f"{said.leg} leg", "leg_dominance", fits, 1.5, sided=True))
    return found


def _postures(said: TextAttributes, c: Columns) -> list[Term]:
    found = []
    for end, pelvis in (("start", "pelvis_start"), ("end", "pelvis_end"), ("lowest", "pelvis_lowest")):
        name = getattr(said, f"posture_{end}")
        if name is None:
            continue
        same = c[f"posture_{end}"] == POSTURES.index(name)
        near = np.exp(-(((c[pelvis] - _HEIGHTS[name]) / 0.18) ** 2)) * (0.3 if name == "upside down" else 0.7)
        weight = 0.5 if name == "standing" else 1.0
        found.append(Term(f"{name} at the {end}", pelvis, np.where(same, 1.0, near), weight))
    if said.level:
        found.append(
            Term(f"level: {said.level}", "pelvis_end", _levels(said.level, c), 0.5 if said.level == "level" else 1.0)
        )
    if said.lean:
        found.append(Term("lean", "lean_max", rise(c["lean_max"], 15, 42)))
    return found


def _levels(level: str, c: Columns) -> Array:
    change = c["pelvis_end"] - c["pelvis_start"]
    dip = np.minimum(c["pelvis_start"], c["pelvis_end"]) - c["pelvis_lowest"]
    kinds = {"down": rise(-change, 0.05, 0.3), "up": rise(change, 0.05, 0.3), "level": rise(np.abs(change), 0.3, 0.1)}
    kinds["down and up"] = rise(dip, 0.05, 0.3)
    return kinds[level]


def _counts(said: TextAttributes, c: Columns) -> list[Term]:
    found = []
    if said.jumps is not None:
        jumps = c["jumps"]
        if said.jumps > 0:
            fits = rise(jumps, 0, 1) * np.exp(-np.abs(jumps - said.jumps) / (1 + said.jumps / 2))
        else:
            fits = rise(jumps, 0, 2) if said.jumps < 0 else rise(jumps, 3, 0)
        found.append(
            Term(
                f"jumps: {said.jumps if said.jumps >= 0 else 'several'}", "jumps", fits, 0.5 if said.jumps == 0 else 1.0
            )
        )
    if said.claps is not None:
        found.append(Term("claps", "claps", rise(c["claps"], 0, 2)))
    elif said.hands_together:
        found.append(Term("hands together", "hands_apart", rise(c["hands_apart"], 0.35, 0.15)))
    if said.hands_low:
        found.append(Term("hands low", "lowest_hand", rise(c["lowest_hand"], 0.75, 0.4)))
    return found


_JUDGES: tuple[Callable[[TextAttributes, Columns], list[Term]], ...] = (
    _turns,
    _paths,
    _travels,
    _speeds,
    _arms,
    _legs,
    _postures,
    _counts,
)
