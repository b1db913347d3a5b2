"""The condition vector: the same classes from a motion and from words that describe it; sides exchange in a mirror."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.motion.attributes import measure
from motionrt.text import (
    SLOTS,
    TARGETS,
    attribute_targets,
    mirror_slots,
    parse_query,
    sideless_slots,
    slots_of_motion,
    slots_of_text,
)
from motionrt.text.slots import CLASSES

sys.path.insert(0, str(Path(__file__).parents[1] / "motion" / "attributes"))
import made

ORDER = list(SLOTS)


def _named(slots: np.ndarray) -> dict[str, str]:
    return {slot: CLASSES[slot][k - 1] for slot, k in zip(ORDER, slots.tolist(), strict=True) if k}


def _turn(degrees: float) -> np.ndarray:
    return made.led(made.standing(90), np.zeros((90, 2)), np.radians(np.linspace(0, degrees, 90)))


def _walk(forward: float, left: float) -> np.ndarray:
    return made.led(made.standing(91), np.linspace(0, 1, 91)[:, None] * [left, forward], np.zeros(91))


MOTIONS = {
    "turn left": _turn(90),
    "turn right": _turn(-80),
    "turn around to the left": _turn(180),
    "spin to the right": _turn(-400),
    "walks forward": _walk(3.6, 0),
    "walks backwards": _walk(-3.0, 0),
    "sidestep to the left": _walk(0, 1.5),
    "walks straight ahead": _walk(3.6, 0),
    "walks in a circle to the right": made.circle(1.0, -330, 5),
    "walks along a curve to the left": made.circle(2.0, 90, 3),
    "raises the left hand": made.raised("left"),
    "raise your right arm": made.raised("right"),
    "stands still": made.standing(),
    "squats": made.sinking(0.5, back=True),
    "jumps": made.jumping([0.3]),
    "jumps three times": made.jumping([0.3, 0.3, 0.3]),
}


@pytest.mark.parametrize("text", MOTIONS)
def test_a_motion_and_the_words_for_it_have_the_same_classes(text: str) -> None:
    motion, said = (_named(s) for s in (slots_of_motion(measure(MOTIONS[text], 30)), slots_of_text(parse_query(text))))
    shared = {name: said[name] for name in said if name in motion and not name.endswith("_move")}
    assert shared
    unlike = {name: (value, motion[name]) for name, value in shared.items() if motion[name] != value}
    unlike.pop("steps", None)  # the made bodies glide
    assert not unlike


def test_classes_are_numbered_from_one_and_zero_is_unknown() -> None:
    assert slots_of_text(parse_query("")).tolist() == [0] * len(SLOTS)
    for text in MOTIONS:
        slots = slots_of_text(parse_query(text))
        assert slots.dtype == np.int64
        assert all(0 <= k < SLOTS[slot] for slot, k in zip(ORDER, slots, strict=True))


@pytest.mark.parametrize("text", MOTIONS)
def test_the_mirror_image_has_mirrored_classes(text: str) -> None:
    joints = MOTIONS[text]
    own, other = (slots_of_motion(measure(p, 30)) for p in (joints, made.mirrored(joints)))
    assert mirror_slots(own).tolist() == other.tolist()
    said = parse_query(text)
    assert mirror_slots(slots_of_text(said)).tolist() == slots_of_text(said.mirrored()).tolist()


@given(st.tuples(*(st.integers(0, n - 1) for n in SLOTS.values())))
def test_mirroring_twice_gives_the_classes_back(slots: tuple[int, ...]) -> None:
    assert mirror_slots(mirror_slots(slots)).tolist() == list(slots)
    assert sideless_slots(mirror_slots(slots)).tolist() == sideless_slots(slots).tolist() or any(
        "left" in CLASSES[slot][k - 1] or "right" in CLASSES[slot][k - 1]
        for slot, k in zip(ORDER, slots, strict=True)
        if k and slot in ("arm", "leg", "turn")
    )


def test_sides_can_be_left_out_as_a_text_leaves_them_out() -> None:
    around = slots_of_motion(measure(_turn(180), 30))
    assert _named(sideless_slots(around))["turn"] == _named(slots_of_text(parse_query("turns around")))["turn"]
    batch = np.stack([around, around])
    assert sideless_slots(batch).shape == batch.shape


@pytest.mark.parametrize("text", MOTIONS)
def test_targets_are_small_and_change_sign_in_the_mirror(text: str) -> None:
    own, known = attribute_targets(measure(MOTIONS[text], 30))
    other, _ = attribute_targets(measure(made.mirrored(MOTIONS[text]), 30))
    assert own.dtype == np.float32
    assert own.shape == known.shape == (len(TARGETS),)
    assert (np.abs(own) <= 1).all()
    signed = [TARGETS.index(name) for name in ("turn", "path_bend", "walk_left", "arm_dominance", "leg_dominance")]
    assert other[signed] == pytest.approx(-own[signed], abs=1e-5)


def test_a_turn_means_nothing_when_lying() -> None:
    lying = made.standing()[..., [0, 2, 1]] * [1, 1, -1]
    _, known = attribute_targets(measure(lying, 30))
    assert not known[TARGETS.index("turn")]
