"""Where clips stand, and whether the camera sees them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import walking

from motionrt.errors import InvalidInputError
from motionrt.studio.bodies import figure_box
from motionrt.studio.clips import Clip, colour
from motionrt.studio.figure import figure_of
from motionrt.studio.layout import AS_RECORDED, OVERLAID, SIDE_BY_SIDE, frame_all, offsets
from motionrt.studio.showing import checked_layout

number = st.floats(-20, 20)
size = st.floats(0.1, 15)


@st.composite
def boxes(draw: st.DrawFn) -> np.ndarray:
    low = np.array([draw(number), draw(st.floats(-1, 1)), draw(number)])
    high = low + np.array([draw(size), draw(size), draw(size)])
    return np.stack([low, high]).astype(np.float32)


def test_as_recorded_moves_nothing() -> None:
    assert not offsets([np.ones((2, 3))], [np.ones(3)], AS_RECORDED).any()
    assert offsets([], [], SIDE_BY_SIDE).shape == (0, 3)


@given(st.lists(boxes(), min_size=1, max_size=6))
def test_overlaid_clips_start_above_the_origin_and_keep_their_height(given_boxes: list[np.ndarray]) -> None:
    starts = [box.mean(axis=0) for box in given_boxes]
    moved = np.array(starts) + offsets(given_boxes, starts, OVERLAID)
    np.testing.assert_allclose(moved[:, [0, 2]], 0, atol=1e-4)
    np.testing.assert_allclose(moved[:, 1], np.array(starts)[:, 1], atol=1e-6)


@given(st.lists(boxes(), min_size=1, max_size=6))
def test_clips_side_by_side_do_not_touch_and_stand_in_the_middle(given_boxes: list[np.ndarray]) -> None:
    starts = [box.mean(axis=0) for box in given_boxes]
    moved = np.array(given_boxes) + offsets(given_boxes, starts, SIDE_BY_SIDE)[:, None]
    gaps = moved[1:, 0, 0] - moved[:-1, 1, 0]
    assert (gaps > 0.6).all()
    assert moved[0, 0, 0] + moved[-1, 1, 0] == pytest.approx(0, abs=1e-3)


@given(st.lists(boxes(), max_size=5), st.floats(0.4, 1.4), st.floats(0.7, 2.5), st.floats(0, 0.4))
def test_every_corner_of_every_box_is_in_the_uncovered_part_of_the_picture(
    given_boxes: list[np.ndarray], fov: float, aspect: float, covered: float
) -> None:
    place, target = (vector.astype(float) for vector in frame_all(given_boxes, fov, aspect, covered))
    forward = (target - place) / np.linalg.norm(target - place)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    corners = [[box[i, 0], box[j, 1], box[k, 2]] for box in given_boxes for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    for corner in corners:
        depth = (corner - place) @ forward
        across = (corner - place) @ right / depth / (math.tan(fov / 2) * aspect)  # -1 to 1 from edge to edge
        assert depth > 0
        assert -1 < across < 1 - 2 * covered + 1e-6
        assert abs((corner - place) @ up / depth / math.tan(fov / 2)) < 1


def test_an_empty_stage_is_seen_from_afar_enough_for_a_person() -> None:
    place, target = frame_all([], 0.72, 1.6)
    assert np.linalg.norm(place - target) > 3


def test_layouts_are_understood_with_hyphens_and_unknown_ones_refused() -> None:
    assert checked_layout("Side-by-side") == SIDE_BY_SIDE
    with pytest.raises(InvalidInputError, match="did you mean 'overlaid'"):
        checked_layout("overlayed")


def test_what_is_framed_of_a_figure_holds_all_of_its_skin_and_not_only_its_joints() -> None:
    clip, figure = Clip("walk", walking(20), colour(0)), figure_of()
    turns, joints, (low, high) = clip.motion.global_rotations()[:, :22], clip.joints, figure_box(clip)
    for frame in range(0, 20, 4):
        moved = np.einsum("fij,vfj->vfi", turns[frame], figure.vertices[:, None] - figure.bones) + joints[frame]
        skin = np.einsum("vf,vfi->vi", figure.weights, moved)
        assert (skin >= low).all()
        assert (skin <= high).all()
        assert skin[:, 1].max() > clip.box[1, 1] + 0.1  # the head is above its joint
