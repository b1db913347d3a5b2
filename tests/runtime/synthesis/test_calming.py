"""Limbs that a text leaves out move less; what it names moves on."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.calming import calmed
from motionrt.text import parse_query


def waving(left: float, right: float, frames: int = 60) -> np.ndarray:
    """Features in which hands swing by so many metres beside shoulders that stand."""
    rows = np.zeros((frames, ego77.WIDTH), np.float32)
    swing = np.sin(np.arange(frames) / 3.0)
    for side, metres in (("left", left), ("right", right)):
        for joint in ("elbow", "wrist", "hand"):
            rows[:, _first(f"{side}_{joint}")] = 0.3 + metres * swing
    return rows


def _first(joint: str) -> int:
    return ego77.JOINTS.start + 3 * (SMPL24.index(joint) - 1)


def _swing(rows: np.ndarray, joint: str) -> float:
    return float(np.ptp(rows[:, _first(joint)]))


@pytest.mark.parametrize(("side", "other"), [("left", "right"), ("right", "left")])
def test_the_arm_that_a_text_does_not_name_moves_less_than_the_one_it_names(side: str, other: str) -> None:
    rows = waving(0.2, 0.2)
    found, parts = calmed(rows, parse_query(f"a person waves with the {side} hand"))
    assert _swing(found, f"{side}_wrist") == pytest.approx(_swing(rows, f"{side}_wrist"))
    assert _swing(found, f"{other}_wrist") < 0.6 * _swing(rows, f"{other}_wrist")
    assert [part for part, changed in zip(PARTS, parts[0], strict=True) if changed] == [f"{other} arm"]


def test_an_arm_that_hangs_is_left_as_it_is() -> None:
    rows = waving(0.02, 0.2)
    found, parts = calmed(rows, parse_query("wave with the right hand"))
    np.testing.assert_array_equal(found, rows)
    assert not parts.any()


def test_whoever_stands_still_hardly_moves() -> None:
    rows = waving(0.2, 0.1)
    found, parts = calmed(rows, parse_query("a person stands still"))
    speed = np.abs(np.diff(found[:, _first("left_wrist")])).mean() * ego77.FPS
    assert parts.all()
    assert speed <= 0.16


def test_texts_that_name_no_arm_change_nothing() -> None:
    rows = waving(0.2, 0.1)
    np.testing.assert_array_equal(calmed(rows, parse_query("a person dances"))[0], rows)


def test_a_punch_stretches_the_arm_that_is_named_where_it_reached_out_farthest() -> None:
    rows = waving(0.1, 0.1)
    shoulder, wrist = _first("right_shoulder"), _first("right_wrist")
    found, parts = calmed(rows, parse_query("punch with the right fist"))
    reach = np.linalg.norm(found[:, wrist : wrist + 3] - found[:, shoulder : shoulder + 3], axis=1)
    before = np.linalg.norm(rows[:, wrist : wrist + 3] - rows[:, shoulder : shoulder + 3], axis=1)
    bones = [SMPL24.offsets[SMPL24.index(f"right_{joint}")] for joint in ("elbow", "wrist")]
    assert reach.max() == pytest.approx(0.97 * np.linalg.norm(bones, axis=1).sum(), abs=1e-3)
    assert reach.argmax() == before.argmax()
    assert np.median(reach) == pytest.approx(np.median(before), abs=5e-3)
    assert parts[0, PARTS.index("right arm")]


@pytest.mark.parametrize("text", ["a person stands still", "wave with the right hand", "punch with the right fist"])
def test_what_is_calmed_or_stretched_needs_no_more_however_it_is_rounded(text: str) -> None:
    found, _ = calmed(waving(0.1, 0.1), parse_query(text))
    for rounding in (1 - 1e-6, 1.0, 1 + 1e-6):
        again, parts = calmed(found * np.float32(rounding), parse_query(text))
        assert not parts.any()
        np.testing.assert_array_equal(again, found * np.float32(rounding))
