"""Gestures are made: hands where they belong, bones as long as they are, and nothing else is touched."""

from __future__ import annotations

import numpy as np
import pytest
from motions import standing

from motionrt.motion import SMPL24
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.synthesis.gesturing import gestured
from motionrt.text import parse_query

FRAMES = 80


def stands() -> np.ndarray:
    """Somebody who stands with hanging arms, for four seconds."""
    joints = standing(FRAMES).positions().astype(float).copy()
    for side in ("left", "right"):
        shoulder = joints[:, SMPL24.index(f"{side}_shoulder")]
        for name, far in (("elbow", 0.27), ("wrist", 0.52), ("hand", 0.605)):
            joints[:, SMPL24.index(f"{side}_{name}")] = shoulder - [0, far, 0]
    return ego77.encode(joints)


def made(text: str) -> tuple[np.ndarray, np.ndarray]:
    """Joints (F, 24, 3) and the parts that were led."""
    rows, parts = gestured(stands(), parse_query(text))
    return ego77.decode(rows), parts


def at(joints: np.ndarray, name: str) -> np.ndarray:
    return joints[:, SMPL24.index(name)]


def test_hands_that_clap_meet_and_part() -> None:
    joints, parts = made("a person claps")
    gap = np.linalg.norm(at(joints, "left_wrist") - at(joints, "right_wrist"), axis=1)[25:]
    assert gap.min() < 0.12
    assert gap.max() > 0.3
    assert 5 <= (np.diff(np.sign(gap - gap.mean())) < 0).sum() <= 7  # twice a second
    assert set(np.flatnonzero(parts.any(axis=0))) == {PARTS.index("left arm"), PARTS.index("right arm")}


@pytest.mark.parametrize("side", ["left", "right"])
def test_who_points_stretches_the_arm_ahead(side: str) -> None:
    joints, parts = made(f"points ahead with the {side} hand")
    way = (at(joints, f"{side}_wrist") - at(joints, f"{side}_shoulder"))[-1]
    assert way[2] > 0.45
    assert set(np.flatnonzero(parts.any(axis=0))) == {PARTS.index(f"{side} arm")}


def test_three_claps_end() -> None:
    joints, parts = made("claps three times")
    assert not parts[-1].any()
    assert np.allclose(joints[-1], ego77.decode(stands())[-1], atol=1e-5)


def test_a_drink_is_at_the_mouth_once() -> None:
    joints, _ = made("drinks with the left hand")
    far = np.linalg.norm(at(joints, "left_wrist") - at(joints, "head"), axis=1)
    assert far.min() < 0.22
    assert far[0] > 0.5
    assert far[-1] > 0.3


def test_who_bows_comes_up_again_and_keeps_the_feet_where_they_are() -> None:
    joints, _ = made("takes a bow")
    neck = at(joints, "neck") - at(joints, "pelvis")
    lean = np.degrees(np.arctan2(neck[:, 2], neck[:, 1]))
    assert 45 < lean.max() < 65
    assert abs(lean[0]) < 5
    assert abs(lean[-1]) < 5
    assert np.allclose(at(joints, "left_foot"), at(joints, "left_foot")[0], atol=1e-4)


def test_who_marches_lifts_the_feet_in_turn() -> None:
    joints, _ = made("marches in place")
    left, right = (at(joints, f"{side}_ankle")[:, 1] > 0.2 for side in ("left", "right"))
    assert left.any()
    assert right.any()
    assert not (left & right).any()


def test_who_kneels_has_the_knees_on_the_floor_where_the_pelvis_is_low() -> None:
    rows = stands()
    rows[:, 3] -= 0.5
    rows[:, ego77.JOINTS].reshape(FRAMES, -1, 3)[..., 1] -= 0.5
    knelt, parts = gestured(rows, parse_query("kneels on the left knee"))
    joints = ego77.decode(knelt)
    assert at(joints, "left_knee")[:, 1].max() < 0.12
    assert at(joints, "right_ankle")[:, 1] == pytest.approx(0.09, abs=0.02)
    assert parts[:, PARTS.index("left leg")].all()


@pytest.mark.parametrize(
    "text", ["claps", "points left", "marches", "scratches the head", "balances on one leg", "bows"]
)
def test_bones_keep_their_lengths_where_a_gesture_is_in_full(text: str) -> None:
    joints, _ = made(text)
    for side in ("left", "right"):
        for a, b in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle")):
            length = np.linalg.norm(at(joints, f"{side}_{a}") - at(joints, f"{side}_{b}"), axis=1)
            known = np.linalg.norm(SMPL24.offsets[SMPL24.index(f"{side}_{b}")])
            assert length == pytest.approx(known, abs=2e-3), (side, a, b)


def test_a_text_without_gestures_changes_nothing() -> None:
    rows, parts = gestured(stands(), parse_query("walks forward"))
    assert np.array_equal(rows, stands())
    assert not parts.any()


def test_one_frame_is_no_trouble() -> None:
    rows, _ = gestured(stands()[:1], parse_query("claps and bows and marches and drinks"))
    assert np.isfinite(rows).all()
