"""Windows over a clip, and features of a part."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion, walking

from motionrt.motion.features import guo263
from motionrt.retrieval import motion_features, window_spans
from motionrt.retrieval.windows import span_features, spans_in_seconds


@pytest.mark.parametrize(
    ("frames", "expected"),
    [
        (1, [(0, 1)]),
        (200, [(0, 200)]),
        (201, [(0, 200), (1, 201)]),
        (300, [(0, 200), (100, 300)]),
        (450, [(0, 200), (100, 300), (200, 400), (250, 450)]),
    ],
)
def test_windows_of_ten_seconds_every_five_and_one_at_the_end(frames: int, expected: list[tuple[int, int]]) -> None:
    assert window_spans(frames) == expected


@given(st.integers(1, 3000))
def test_windows_cover_every_frame_and_none_repeats(frames: int) -> None:
    spans = window_spans(frames)
    assert set().union(*(range(start, end) for start, end in spans)) == set(range(frames))
    assert len(set(spans)) == len(spans)


def test_features_are_at_twenty_frames_a_second_whatever_the_motions_rate() -> None:
    assert motion_features(random_motion(61, fps=60.0)).shape == (21, guo263.WIDTH)
    assert motion_features(random_motion(1, fps=120.0)).shape == (1, guo263.WIDTH)


def test_features_do_not_see_where_the_floor_of_the_file_was() -> None:
    motion = walking(40)
    lifted = type(motion)(motion.rotations, motion.root + np.float32([0, 1.5, 0]), motion.fps)
    np.testing.assert_allclose(motion_features(lifted), motion_features(motion), atol=1e-5)


def test_the_features_of_a_span_are_those_of_the_cut_clip() -> None:
    motion = walking(60, turn=0.4)
    spans = [(0, 60), (10, 40), (30, 60)]
    for (start, end), found in zip(spans, span_features(motion_features(motion), spans), strict=True):
        np.testing.assert_allclose(found, motion_features(motion[start:end]), atol=2e-5)


def test_a_span_never_ends_after_its_clip() -> None:
    assert spans_in_seconds([(0, 21)], 1.02) == [(0.0, 1.02)]
