"""Feet that stand carry whoever stays on the spot."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.footing import carried, share_of
from motionrt.text import parse_query

LEFT_TOE = SMPL24.index("left_foot")


def swaying(frames: int = 40) -> np.ndarray:
    """Features of a body that turns and drifts above a left foot, in contact, that stands at one point of the world."""
    rows = np.zeros((frames, ego77.WIDTH), np.float32)
    rows[:, 0] = 0.01 * np.sin(np.arange(frames) / 4)
    time = np.arange(frames)
    place = np.stack([0.1 * np.sin(time / 6), 0.08 * np.cos(time / 7)], axis=1)
    yaw = np.concatenate([[0.0], np.cumsum(rows[:-1, 0].astype(float))])
    away = np.array([0.3, 0.2]) - place
    x, z = ego77.to_body(away[:, 0], away[:, 1], yaw)
    column = ego77.JOINTS.start + 3 * (LEFT_TOE - 1)
    rows[:, column], rows[:, column + 2] = x, z
    rows[:, ego77.CONTACTS] = [0, 0, 1, 0]
    return rows


def slid(rows: np.ndarray) -> float:
    """How far the toe is from where it stood at first, at most, metres."""
    toe = ego77.decode(rows)[:, LEFT_TOE, [0, 2]]
    return float(np.linalg.norm(toe - toe[0], axis=1).max())


def test_the_root_goes_so_that_the_standing_foot_stays() -> None:
    rows = swaying()
    assert slid(rows) > 0.1
    assert slid(carried(rows, 1.0)) < 0.005


def test_a_share_of_nothing_and_feet_in_the_air_change_nothing_but_trembling() -> None:
    rows = swaying()
    flying = rows.copy()
    flying[:, ego77.CONTACTS] = 0
    np.testing.assert_allclose(carried(rows, 0.0)[:, 1:3], rows[:, 1:3], atol=1e-6)
    np.testing.assert_allclose(carried(flying, 1.0)[:, 1:3], rows[:, 1:3], atol=1e-6)


@pytest.mark.parametrize(
    ("text", "share"),
    [("a person waves", 1.0), ("a person walks forward", 0.3), ("walk in a circle", 0.0), ("jump up", 0.0)],
)
def test_whoever_goes_a_way_is_carried_less(text: str, share: float) -> None:
    assert share_of(parse_query(text)) == share
