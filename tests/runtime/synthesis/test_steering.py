"""Turns and ways that texts say are met by what is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.motion.features import ego77
from motionrt.synthesis.steering import brought
from motionrt.text import Way, parse_query, way_of_text


def rows(turn: float = 0.0, left: float = 0.0, forward: float = 0.0, frames: int = 81) -> np.ndarray:
    """Features that turn so many degrees and go so many metres in equal steps of the body's own axes."""
    made = np.zeros((frames, ego77.WIDTH), np.float32)
    made[:, :3] = np.array([np.radians(turn), left, forward]) / max(frames - 1, 1)
    made[:, 3] = 0.9
    return made


def turned(features: np.ndarray) -> float:
    return float(np.degrees(features[:-1, 0].sum()))


def gone(features: np.ndarray) -> tuple[float, float]:
    """Net way, left and forward of the first frame, by adding up steps frame by frame."""
    x = z = yaw = 0.0
    for turn, left, forward in features[:-1, :3].astype(float):
        x += left * np.cos(yaw) + forward * np.sin(yaw)
        z += -left * np.sin(yaw) + forward * np.cos(yaw)
        yaw += turn
    return x, z


@pytest.mark.parametrize(
    ("text", "turn"),
    [("a person turns left", (60, 125)), ("someone turns right", (-125, -60)), ("walk straight ahead", (-12, 12))],
)
def test_a_turn_that_strays_is_brought_to_where_the_text_says(text: str, turn: tuple[float, float]) -> None:
    found = brought(rows(turn=40.0 if turn[0] < 0 else 20.0), way_of_text(parse_query(text), 4.0))
    assert found is not None
    assert turn[0] - 0.1 <= turned(found) <= turn[1] + 0.1


def test_a_turn_to_no_side_keeps_the_side_that_was_drawn() -> None:
    way = way_of_text(parse_query("a person turns around"), 4.0)
    found = brought(rows(turn=-90.0), way)
    assert found is not None
    assert -215.1 <= turned(found) <= -149.9


def test_what_is_in_its_ranges_stays_as_it_is() -> None:
    assert brought(rows(turn=3.0, forward=4.0), way_of_text(parse_query("a person walks straight ahead"), 4.0)) is None


def test_whoever_walks_backward_goes_backward_and_keeps_pose_and_height() -> None:
    found = brought(rows(forward=0.3), way_of_text(parse_query("a person walks backward"), 4.0))
    assert found is not None
    assert gone(found)[1] <= -0.4 * 4 + 1e-3
    np.testing.assert_array_equal(found[:, 3:], rows()[:, 3:])


@given(st.floats(-200, 200), st.floats(-2, 2), st.floats(-4, 4), st.floats(-3, 3), st.floats(-3, 3))
def test_any_way_comes_into_its_ranges(turn: float, left: float, forward: float, x: float, z: float) -> None:
    way = Way(None, (z, z + 0.5), (x, x + 0.5))
    given_rows = rows(turn, left, forward)
    found = brought(given_rows, way)
    reached = gone(given_rows if found is None else found)
    assert x - 0.03 <= reached[0] <= x + 0.53
    assert z - 0.03 <= reached[1] <= z + 0.53


@pytest.mark.parametrize("frames", [1, 2])
def test_motions_of_a_frame_or_two_are_steered_without_an_error(frames: int) -> None:
    found = brought(rows(frames=frames), Way((60, 90)))
    assert frames == 1 or found is not None
