"""The arms of one recording on the body of another."""

from __future__ import annotations

import numpy as np
import pytest
from motions import walking

from motionrt.motion.skeleton import SMPL24
from motionrt_training.corpora.composed import acting_arms, with_arms


def joints(frames: int = 40, speed: float = 1.0) -> np.ndarray:
    return np.asarray(walking(frames, speed=speed, fps=20.0).positions(), np.float64)


def turned(positions: np.ndarray, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    x, z = positions[..., 0], positions[..., 2]
    return np.stack([c * x + s * z, positions[..., 1], c * z - s * x], axis=-1)


def arm(side: str) -> list[int]:
    return [SMPL24.index(f"{side}_{joint}") for joint in ("elbow", "wrist", "hand")]


@pytest.mark.parametrize("degrees", [0.0, 35.0, -120.0])
def test_arms_of_the_same_pose_facing_elsewhere_are_the_arms_that_were_there(degrees: float) -> None:
    body = joints()
    np.testing.assert_allclose(with_arms(body, turned(body, degrees), ("left", "right")), body, atol=1e-9)


def test_only_the_named_arm_changes_and_keeps_its_bones() -> None:
    body, donor = joints(), joints(speed=2.0)
    donor[:, arm("left")] += [0.0, 0.2, 0.0]
    made = with_arms(body, donor, ("left",))
    others = [joint for joint in range(24) if joint not in arm("left")]
    np.testing.assert_array_equal(made[:, others], body[:, others])
    elbow, wrist = arm("left")[:2]
    expected = np.linalg.norm(donor[:, elbow] - donor[:, wrist], axis=1)
    np.testing.assert_allclose(np.linalg.norm(made[:, elbow] - made[:, wrist], axis=1), expected, atol=1e-9)


def test_an_arm_that_moves_alone_acts_and_whoever_walks_does_not_act_with_arms() -> None:
    standing = np.repeat(joints()[:1], 60, axis=0)
    standing[:, arm("right"), 1] += 0.3 * np.sin(np.arange(60) / 2.0)[:, None]
    assert acting_arms(standing) == ("right",)
    assert acting_arms(joints(60, speed=1.5)) == ()
