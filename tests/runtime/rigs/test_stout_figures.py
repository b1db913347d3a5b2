"""Figures of other proportions than people's stand on the floor when their motion is read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from motions import standing

from motionrt import load_motion
from motionrt.motion.transforms import moved

ROBOT = Path(__file__).parents[3] / "examples" / "robot.glb"
TOES = [10, 11]


def test_a_figure_with_high_ankles_comes_back_onto_the_floor(tmp_path: Path) -> None:
    stand = standing(60, fps=30)
    stand.retarget_to(ROBOT).save(tmp_path / "robot.glb")
    lowest = load_motion(tmp_path / "robot.glb").positions()[:, TOES, 1].min(axis=1)
    assert abs(float(np.median(lowest))) < 0.03


def test_one_that_plays_high_above_the_floor_stays_there(tmp_path: Path) -> None:
    stand = moved(standing(60, fps=30), np.array([0, 0.6, 0], np.float32))
    stand.retarget_to(ROBOT).save(tmp_path / "robot.glb")
    lowest = load_motion(tmp_path / "robot.glb").positions()[:, TOES, 1].min(axis=1)
    assert float(np.median(lowest)) > 0.4
