"""Heads do what texts say of them, and no other text moves them."""

from __future__ import annotations

import numpy as np
import pytest
from motions import standing

from motionrt.motion import SMPL24
from motionrt.synthesis.heads import with_heads
from motionrt.synthesis.timeline import Line

HEAD = SMPL24.index("head")


def facing(text: str, start: float = 0.0, end: float = 4.0) -> np.ndarray:
    """Where the head of somebody who stands faces, (F, 3), for four seconds at 30 fps."""
    motion = with_heads(standing(120, fps=30), [Line(text, start, end)])
    return motion.global_rotations()[:, HEAD] @ [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("text", "axis", "sign"),
    [("looks to the left", 0, 1), ("looks right", 0, -1), ("looks up", 1, 1), ("glances down", 1, -1)],
)
def test_heads_are_turned_and_kept(text: str, axis: int, sign: int) -> None:
    way = facing(text)
    assert sign * way[60, axis] > 0.4
    assert np.allclose(way[60], way[80], atol=1e-5)
    assert np.allclose(way[0], [0, 0, 1], atol=1e-5)


@pytest.mark.parametrize(("text", "axis", "times"), [("looks around", 0, 2), ("shakes his head", 0, 9), ("nods", 1, 9)])
def test_heads_go_there_and_back(text: str, axis: int, times: int) -> None:
    side = facing(text)[:, axis]
    crossings = (np.diff(np.sign(side[5:-5])) != 0).sum()
    assert times - 1 <= crossings <= times + 1
    assert side.max() > 0.3
    assert side.min() < -0.3


def test_a_head_moves_only_in_the_time_of_its_text() -> None:
    way = facing("nods", 1.0, 2.0)
    assert np.allclose(way[:30], [0, 0, 1], atol=1e-5)
    assert np.allclose(way[61:], [0, 0, 1], atol=1e-5)
    assert way[30:60, 1].min() < -0.2


def test_other_texts_leave_the_motion_as_it_is() -> None:
    motion = standing(30)
    assert with_heads(motion, [Line("walks forward", 0, 1)]) is motion
