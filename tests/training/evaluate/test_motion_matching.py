"""Motion matching as a baseline: it plays recordings, follows paths, and its changes do not pop."""

from __future__ import annotations

import numpy as np
import pytest
from motions import walking

from motionrt.errors import InvalidInputError
from motionrt.locomotion import Goal, Path
from motionrt.locomotion.transitions import placed
from motionrt.metrics.locomotion import path_deviation
from motionrt.motion import Motion
from motionrt.motion.transforms import heading
from motionrt_training.corpora.bend import bent
from motionrt_training.evaluate.motion_matching import Clips, body_rows, clip_rows, curves, matched


def turned(motion: Motion, rate: float) -> Motion:
    """The walk along an arc of ``rate`` rad/m."""
    return bent(motion, np.full(motion.frames, rate))


@pytest.fixture(scope="module")
def clips() -> Clips:
    straight = walking(240, fps=30).grounded()
    return Clips.of([straight, *(turned(straight, rate) for rate in (-0.6, -0.3, 0.3, 0.6))])


def test_a_row_does_not_change_with_where_a_walk_is_and_where_it_looks() -> None:
    walk = walking(90, fps=30).grounded()
    elsewhere = placed(walk, Goal(3.0, -2.0, 1.1))
    np.testing.assert_allclose(clip_rows(elsewhere), clip_rows(walk), atol=1e-3)
    assert body_rows(walk).shape == (90, 15)


def test_the_best_row_for_a_frame_of_a_recording_is_that_frame(clips: Clips) -> None:
    row = clip_rows(clips.motions[3])[40]
    clip, frame = clips.best(row)
    found = clip_rows(clips.motions[clip])[frame]
    np.testing.assert_allclose(found, row, atol=0.05)


@pytest.mark.parametrize("path", [*curves(2, 8.0), Path(np.array([[0, 0], [0, 8]], np.float32))])
def test_it_follows_a_path_without_jumps(clips: Clips, path: Path) -> None:
    walk = matched(clips, path)
    assert path_deviation(walk.root[:, [0, 2]], path.points).mean < 0.3
    assert np.linalg.norm(walk.root[-1, [0, 2]] - path.points[-1]) < 0.6
    assert np.linalg.norm(np.diff(walk.root, axis=0), axis=1).max() * 30 < 3.0
    assert np.abs(np.diff(np.unwrap(heading(walk)))).max() * 30 < 4.0


def test_recordings_that_are_too_short_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="second"):
        Clips.of([walking(20, fps=30)])
