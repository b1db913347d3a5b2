"""Gestures whose course is plain are made as it is: hands are led by their wrists, trunks bow, knees come up.

The wrist of a hand goes where its gesture says in the axes of the body, the elbow follows; between the gestures, and in
all that they leave open, the motion is the network's.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.text import TextAttributes, gestures_of_text
from motionrt.text.lexicon.gestures import Gesture

BEGINS, BEGINS_S, RAMP_S = 0.15, 0.5, 0.5  # when a gesture begins: part of the motion, seconds at most; its fading
FULL = 0.985  # of the length of a limb that it is stretched to at most
BOW, BOW_AT, BOW_S = 0.95, 0.45, 1.0  # radians that a trunk bows, when it is lowest, and how long it goes down and up
STEP_HZ, STEP_UP, STEP_AHEAD = 0.9, 0.3, 0.12  # pairs of marching steps a second, and metres that feet are lifted
HELD_UP, HELD_AHEAD = 0.35, -0.1  # metres that a foot is held up
KNEELS, LOW_KNEE, FRONT = (0.62, 0.5), 0.12, 0.33  # pelvis heights between which knees go down; knee; foot in front
LIES, FLAT, ON_FLOOR = (
    (0.34, 0.18),
    1.5,
    0.05,
)  # pelvis heights between which a trunk lies down; its lean; its joints, at least
UPRIGHT = 0.22  # radians that the trunk of somebody who stands and gestures leans, at most
UP, BENT = (0.6, 0.8), 0.4  # pelvis heights between which a trunk that will lie is kept up; its lean then, at most
STANDS = 0.09  # metres that the ankle of a standing foot is above the floor
_ELBOW: tuple[float, float, float] = (0.4, -0.9, -0.3)  # out, up, ahead: where elbows point where nothing else is seen
_KNEE: tuple[float, float, float] = (0.1, 0.0, 1.0)
_TRUNK = ("spine1", "spine2", "spine3", "neck", "head", *(
    f"{side}_{joint}" for side in ("left", "right") for joint in ("collar", "shoulder", "elbow", "wrist", "hand")
))  # fmt: skip

Array = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


def gestured(features: FloatArray, said: TextAttributes) -> tuple[FloatArray, BoolArray]:
    """Features ``(F, 77)`` with the gestures of a text, and ``(F, 6)`` which parts of which frames they are."""
    rows, parts = np.array(features, np.float64), np.zeros((len(features), len(PARTS)), bool)
    found = gestures_of_text(said)
    times = np.arange(len(rows)) / ego77.FPS
    if found.bows:
        parts[:, [PARTS.index(part) for part in ("torso", "left arm", "right arm")]] |= _bow(rows, times)[:, None]
    if found.lies or found.stands:
        led = _lying(rows) if found.lies else _standing(rows)
        parts[:, [PARTS.index(part) for part in ("torso", "left arm", "right arm")]] |= led[:, None]
    for side, gesture in found.hands:
        parts[:, PARTS.index(f"{side} arm")] |= _hand(rows, times, side, gesture, said)
    if found.marches or found.lifted:
        for side in ("left", "right"):
            if found.lifted in (None, side):
                parts[:, PARTS.index(f"{side} leg")] |= _foot(rows, times, side, found.marches)
    if found.kneels:
        for side in ("left", "right"):
            parts[:, PARTS.index(f"{side} leg")] |= _kneeling(rows, side, found.kneels in (side, "both"))
    return rows.astype(np.float32), parts


def _hand(rows: Array, times: Array, side: str, gesture: Gesture, said: TextAttributes) -> BoolArray:
    """Lead a hand; in place. The frames in which it is led."""
    share, weight = _course(times, gesture, said)
    outward = np.array([1.0 if side == "left" else -1.0, 1.0, 1.0])
    places = np.array(gesture.places)
    way = _eased(np.stack([np.interp(share, places[:, 0], places[:, 1 + axis]) for axis in range(3)], axis=1))
    turn = 2 * np.pi * gesture.hz * times + (np.pi if gesture.alternate and side == "left" else 0.0)
    way += np.sin(turn)[:, None] * gesture.swing + np.cos(turn)[:, None] * gesture.swirl
    shoulder, elbow, wrist, hand = (_place(rows, f"{side}_{name}") for name in ("shoulder", "elbow", "wrist", "hand"))
    base = _place(rows, "head") if gesture.about == "head" else shoulder
    aim = wrist + weight[:, None] * (base + way * outward - wrist)
    bent, end = _limb(shoulder, elbow, aim, (f"{side}_elbow", f"{side}_wrist"), outward * _ELBOW)
    led = weight > 0
    _set(rows, f"{side}_elbow", bent, led)
    _set(rows, f"{side}_wrist", end, led)
    along = (end - bent) / np.linalg.norm(end - bent, axis=1, keepdims=True)
    reach = np.linalg.norm(hand - wrist, axis=1, keepdims=True)
    kept = hand - wrist + weight[:, None] * (along * reach - (hand - wrist))
    _set(rows, f"{side}_hand", end + kept, led)
    return led


def _course(times: Array, gesture: Gesture, said: TextAttributes) -> tuple[Array, Array]:
    """``(F,)`` the share of a gesture that is done, and how much the hand follows it, 0 to 1."""
    last = float(times[-1]) if len(times) else 0.0
    if gesture.once_s:
        lasts = min(gesture.once_s, 0.9 * last)
        first = (last - lasts) / 2
        share = (times - first) / max(lasts, 1e-6)
        ramp = min(RAMP_S / 2, lasts / 4)
    else:
        first = min(BEGINS * last, BEGINS_S)
        count = max(said.claps or 0, said.repeats or 0) if gesture.hz else 0
        lasts = count / gesture.hz + RAMP_S if count > 0 else np.inf
        share = (times - first) / max(last - first, 1e-6)
        ramp = min(RAMP_S, last / 4)
    rises, falls = (times - first) / max(ramp, 1e-6), (first + lasts - times) / max(ramp, 1e-6)
    return np.clip(share, 0, 1), np.asarray(_smooth(np.minimum(rises, falls)))


def _bow(rows: Array, times: Array) -> BoolArray:
    """Bow the trunk about the pelvis, further than it is by as much as is missing; in place."""
    lowest = BOW_AT * (times[-1] if len(times) else 0.0)
    weight = _smooth(1.6 - np.abs(times - lowest) / BOW_S)
    pelvis = np.stack([np.zeros(len(rows)), rows[:, 3], np.zeros(len(rows))], axis=1)
    trunk = _place(rows, "neck") - pelvis
    off = weight * BOW - np.arctan2(trunk[:, 2], trunk[:, 1])
    c, s = np.cos(off), np.sin(off)
    every = np.ones(len(rows), bool)
    for name in _TRUNK:
        x, y, z = (_place(rows, name) - pelvis).T
        _set(rows, name, pelvis + np.stack([x, c * y - s * z, s * y + c * z], axis=1), every)
    return every


def _standing(rows: Array) -> BoolArray:
    """Bring a trunk upright that leans too far; in place. The frames of it."""
    pelvis = np.stack([np.zeros(len(rows)), rows[:, 3], np.zeros(len(rows))], axis=1)
    trunk = _place(rows, "neck") - pelvis
    lean = np.arctan2(trunk[:, 2], trunk[:, 1])
    off = np.clip(lean, -UPRIGHT, UPRIGHT) - lean
    led: BoolArray = np.abs(off) > 1e-3
    c, s = np.cos(off), np.sin(off)
    for name in _TRUNK:
        x, y, z = (_place(rows, name) - pelvis).T
        _set(rows, name, pelvis + np.stack([x, c * y - s * z, s * y + c * z], axis=1), led)
    return led


def _lying(rows: Array) -> BoolArray:
    """Lay the trunk on the floor while the pelvis is there, to the side it leans to, and keep it up before; in place.

    The frames of it.
    """
    high, low = LIES
    weight, upright = _smooth((high - rows[:, 3]) / (high - low)), _smooth((rows[:, 3] - UP[0]) / (UP[1] - UP[0]))
    led = weight + upright > 0
    pelvis = np.stack([np.zeros(len(rows)), rows[:, 3], np.zeros(len(rows))], axis=1)
    trunk = _place(rows, "neck") - pelvis
    ahead = 1.0 if float((weight * trunk[:, 2]).sum()) > 0 else -1.0
    lean = np.arctan2(trunk[:, 2], trunk[:, 1])
    off = weight * np.where(ahead * lean < FLAT, ahead * FLAT - lean, 0.0)
    off += upright * (np.clip(lean, -BENT, BENT) - lean)
    c, s = np.cos(off), np.sin(off)
    for name in _TRUNK:
        x, y, z = (_place(rows, name) - pelvis).T
        up = pelvis[:, 1] + c * y - s * z
        up += weight * (np.maximum(up, ON_FLOOR) - up)
        _set(rows, name, np.stack([x, up, s * y + c * z], axis=1), led)
    return led


def _foot(rows: Array, times: Array, side: str, marches: bool) -> BoolArray:
    """Lift a foot, again and again or to keep it up; in place. The frames in which its leg is led."""
    last = float(times[-1]) if len(times) else 0.0
    weight = _smooth((times - min(BEGINS * last, BEGINS_S)) / RAMP_S)
    if marches:
        turn = 2 * np.pi * STEP_HZ * times + (np.pi if side == "left" else 0.0)
        up, ahead = (far * np.maximum(np.sin(turn), 0) ** 1.5 for far in (STEP_UP, STEP_AHEAD))
    else:
        up, ahead = np.full(len(rows), HELD_UP), np.full(len(rows), HELD_AHEAD)
    hip, knee, ankle, toe = (_place(rows, f"{side}_{name}") for name in ("hip", "knee", "ankle", "foot"))
    aim = np.stack([hip[:, 0], STANDS + up, hip[:, 2] + ahead if not marches else ahead], axis=1)
    aim = ankle + weight[:, None] * (aim - ankle)
    bent, end = _limb(hip, knee, aim, (f"{side}_knee", f"{side}_ankle"), np.array(_KNEE))
    led = weight > 0
    _set(rows, f"{side}_knee", bent, led)
    _set(rows, f"{side}_ankle", end, led)
    _set(rows, f"{side}_foot", end + (toe - ankle), led)
    air = (up > STANDS / 2) & led
    for column in range(ego77.CONTACTS.start + (side == "right"), ego77.CONTACTS.stop, 2):
        rows[led, column] = np.where(air, 0.0, rows[:, column])[led]
    return led


def _kneeling(rows: Array, side: str, down: bool) -> BoolArray:
    """Bring a knee to the floor, or the foot in front of it, while the pelvis is low; in place. The frames of it."""
    high, low = KNEELS
    weight = _smooth((high - rows[:, 3]) / (high - low))[:, None]
    hip, knee, ankle, toe = (_place(rows, f"{side}_{name}") for name in ("hip", "knee", "ankle", "foot"))
    thigh, shin = (float(np.linalg.norm(SMPL24.offsets[SMPL24.index(f"{side}_{name}")])) for name in ("knee", "ankle"))
    if down:
        drop = np.clip(hip[:, 1] - LOW_KNEE, 0, FULL * thigh)
        ahead = np.sqrt(thigh**2 - drop**2)
        wanted = hip + np.stack([np.zeros_like(drop), -drop, ahead], axis=1)
        heel = wanted + np.stack([np.zeros_like(drop), STANDS - wanted[:, 1], np.full_like(drop, -0.99 * shin)], axis=1)
        tip = heel + np.array([0.0, -0.05, -0.14])
    else:
        aim = np.stack([hip[:, 0], np.full(len(rows), STANDS), hip[:, 2] + FRONT], axis=1)
        wanted, heel = _limb(hip, knee, aim, (f"{side}_knee", f"{side}_ankle"), np.array(_KNEE))
        tip = heel + SMPL24.offsets[SMPL24.index(f"{side}_foot")]
    led = weight[:, 0] > 0
    for name, now, then in (("knee", knee, wanted), ("ankle", ankle, heel), ("foot", toe, tip)):
        _set(rows, f"{side}_{name}", now + weight * (then - now), led)
    return led


def _limb(start: Array, middle: Array, aim: Array, bones: tuple[str, str], pole: Array) -> tuple[Array, Array]:
    """Middle and end joints ``(F, 3)`` of a limb that reaches for `aim`, bent to where it is bent, or to the pole."""
    a, b = (float(np.linalg.norm(SMPL24.offsets[SMPL24.index(name)])) for name in bones)
    way = aim - start
    far = np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-6)
    along = way / far
    reach = np.clip(far, abs(a - b) + 0.02, FULL * (a + b))
    share = (a * a - b * b + reach * reach) / (2 * reach)
    side = middle - start + 0.3 * pole
    side = side - (side * along).sum(axis=1, keepdims=True) * along
    side = side / np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-6)
    bent = start + along * share + side * np.sqrt(np.maximum(a * a - share * share, 0))
    return bent, start + along * reach


def _smooth(share: npt.ArrayLike) -> Array:
    s = np.clip(share, 0.0, 1.0)
    return np.asarray(s * s * (3 - 2 * s))


def _eased(way: Array) -> Array:
    """A way ``(F, 3)`` without corners: a running mean over five frames."""
    padded = np.pad(way, ((2, 2), (0, 0)), mode="edge")
    return np.asarray(sum(padded[k : k + len(way)] for k in range(5)) / 5)


def _place(rows: Array, joint: str) -> Array:
    first = ego77.column(SMPL24.index(joint))
    return rows[:, first : first + 3].copy()


def _set(rows: Array, joint: str, values: Array, frames: BoolArray) -> None:
    first = ego77.column(SMPL24.index(joint))
    rows[frames, first : first + 3] = values[frames]
