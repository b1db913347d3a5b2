"""What a stretch of motion does, in words made from its measured attributes alone: sides, turns, ways, postures."""

from __future__ import annotations

import numpy as np

from motionrt.motion.attributes import Attributes
from motionrt_training.wording.saying import sentence

Words = list[tuple[str, ...]]  # every entry is one thing that can be said, in several wordings

_POSTURE = {
    "crouching": ("crouch", "squat low", "stay low with bent knees"),
    "kneeling": ("kneel", "kneel on the floor", "be on the knees"),
    "sitting": ("sit", "be seated", "sit still"),
    "crawling": ("crawl", "go on all fours", "crawl on hands and knees"),
    "lying": ("lie on the floor", "lie down", "lie flat"),
    "bent": ("bend over", "lean far forward", "stoop"),
    "upside down": ("go upside down", "turn head over heels"),
}
_LOW = ("crouching", "kneeling", "sitting", "crawling", "lying", "bent")


def say_measured(a: Attributes, rng: np.random.Generator, count: int = 1) -> list[str]:
    """`count` sentences on what `a` says, each on one to three things that stand out; [] where nothing does."""
    things = [words for find in (_going, _turning, _posture, _arms, _legs, _jumping, _stillness) for words in find(a)]
    if not things:
        return []
    return [_one(things, rng) for _ in range(count)]


def _one(things: Words, rng: np.random.Generator) -> str:
    most = min(len(things), int(rng.choice([1, 2, 2, 3])))
    chosen = sorted(rng.choice(len(things), size=most, replace=False).tolist())
    return sentence([str(rng.choice(things[number])) for number in chosen], rng)


def _going(a: Attributes) -> Words:
    if a.speed_mean < 0.2 or a.path_length < 0.4 or a.posture_names[2] in ("crawling", "lying"):
        return []
    ahead, left = a.walk_forward, a.walk_left
    if abs(left) > 1.5 * abs(ahead) and abs(left) > 0.3:
        side = "left" if left > 0 else "right"
        verbs = (f"move sideways to the {side}", f"step sideways {side}", f"shuffle {side}", f"step {side}wards")
        return [verbs]
    if ahead < -0.35 and -ahead > abs(left):
        return [("go backward", "back up", "step backwards", "go back", "move in reverse")]
    return [_ahead(a)] if ahead > 0.35 else []


def _ahead(a: Attributes) -> tuple[str, ...]:
    pace = a.speed_mean
    if pace > 2.8:
        return ("run", "run fast", "sprint ahead", "race ahead")
    if pace > 1.7:
        return ("jog", "run slowly", "jog forward", "trot ahead")
    if pace > 0.75:
        return ("walk", "walk ahead", "go ahead", "walk on", "stride forward")
    return ("walk slowly", "take slow steps forward", "step forward", "move slowly ahead")


def _turning(a: Attributes) -> Words:
    side = "left" if a.turn > 0 else "right"
    sense = "counterclockwise" if a.turn > 0 else "clockwise"
    size, found = abs(a.turn), Words()
    bends = abs(a.path_bend) > 100 and a.path_bend * a.turn > 0 and a.path_length > 1.5
    if size > 300:
        found.append((f"spin to the {side}", f"turn all the way round to the {side}", f"rotate {sense}"))
    elif size > 135:
        found.append((f"turn about to the {side}", f"turn around {sense}", f"make a half turn to the {side}"))
    elif size > 40:
        found.append((f"turn {side}", f"turn to the {side}", f"rotate {sense}", f"make a {side} turn"))
    if bends:
        curve = "circle" if abs(a.path_bend) > 200 else "curve"
        found.append((f"walk in a {curve} to the {side}", f"go {sense} in a {curve}", f"follow a {side} {curve}"))
    if size < 12 and abs(a.path_bend) < 20 and a.walk_forward > 1.5:
        found.append(("go straight ahead", "keep going straight", "move in a straight line"))
    return found


def _posture(a: Attributes) -> Words:
    start, end, lowest = a.posture_names
    if start in _LOW and end == "standing" and a.pelvis_end - a.pelvis_start > 0.15:
        return [("stand up", "get up", "rise", f"get up from {_from(start)}")]
    if start == "standing" and end in ("sitting", "lying", "kneeling", "crouching"):
        ways = {"sitting": "sit down", "lying": "lie down", "kneeling": "kneel down", "crouching": "crouch down"}
        return [(ways[end], *_POSTURE[end][:1])]
    if lowest in _POSTURE:
        return [_POSTURE[lowest]]
    return []


def _from(posture: str) -> str:
    return {"lying": "the floor", "crawling": "the floor", "sitting": "sitting", "kneeling": "the knees"}.get(
        posture, "a crouch"
    )


def _arms(a: Attributes) -> Words:
    found = Words()
    if a.both_hands_over_shoulder > 0.1:
        found.append(("lift both arms", "lift both hands up", "hold both arms up", "put the hands up"))
    else:
        for side in ("left", "right"):
            if getattr(a, f"{side}_hand_over_shoulder") > 0.05:
                found.append((f"lift the {side} hand", f"lift the {side} arm", f"hold the {side} hand up"))
    if abs(a.arm_dominance) > 0.25 and max(a.left_hand_speed, a.right_hand_speed) > 0.35:
        side = "left" if a.arm_dominance > 0 else "right"
        hand = (f"move the {side} hand", f"use the {side} arm", f"act with the {side} hand", f"gesture {side}-handed")
        found.append(hand)
    return found


def _legs(a: Attributes) -> Words:
    lift = {side: getattr(a, f"{side}_foot_lift") for side in ("left", "right")}
    side = max(lift, key=lambda name: lift[name])
    if lift[side] < 0.3 or lift[side] < 1.5 * min(lift.values()) or a.speed_mean > 2:
        return []
    return [(f"lift the {side} leg", f"raise the {side} foot", f"bring the {side} leg up high")]


def _jumping(a: Attributes) -> Words:
    if a.jumps < 1:
        return []
    if a.jumps == 1:
        return [("jump", "jump once", "leap", "make a jump")]
    number = ("two", "three", "four", "five", "six")[min(int(a.jumps), 6) - 2]
    return [("jump repeatedly", "hop", f"jump {number} times", f"make {number} jumps")]


def _stillness(a: Attributes) -> Words:
    if a.stillness > 0.8 and a.posture_names[2] == "standing":
        return [("keep still", "remain motionless", "stay put")]
    if a.in_place and a.posture_names[2] == "standing" and a.steps < 2 and abs(a.turn) < 30:
        return [("stay on the spot", "stay in one place", "remain standing")]
    return []
