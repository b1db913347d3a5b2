"""The wrapper of the decoder: shapes, refusals, the name that it asks the sessions for, starts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tiny_models import TINY
from toy_prior import ToyPrior, positions_by_scipy

from motionrt.errors import InvalidInputError, ModelNotFoundError
from motionrt.locomotion.posing import solve_pose
from motionrt.models import Sessions
from motionrt.models.pose_prior import PosePrior


def toy() -> PosePrior:
    return PosePrior(lambda rows: ToyPrior().decode(rows).astype(np.float32))


def test_any_function_can_be_the_decoder() -> None:
    rotations = toy().decode(np.zeros((2, 32)))
    assert rotations.shape == (2, 24, 3, 3)
    assert rotations.dtype == np.float32
    assert toy().decode(np.zeros((0, 32))).shape == (0, 24, 3, 3)


def test_the_manifests_model_is_asked_for_rotations() -> None:
    asked: list[Any] = []

    class Recording(Sessions):
        def run(self, model: str, outputs: list[str], feeds: Any, variant: str | None = None) -> list[np.ndarray]:
            asked.append((model, outputs, {name: (rows.shape, rows.dtype) for name, rows in feeds.items()}, variant))
            return [ToyPrior().decode(feeds["latent"]).astype(np.float32)]

    PosePrior.open(Recording(TINY), variant="fp32").decode(np.zeros((3, 32), np.float64))
    assert asked == [("pose_prior", ["rotations"], {"latent": ((3, 32), np.float32)}, "fp32")]


def test_a_manifest_without_a_prior_says_so() -> None:
    manifest = Sessions(TINY)
    if "pose_prior" in manifest.manifest.models:
        assert PosePrior.open(manifest).decode(np.zeros((1, 32))).shape == (1, 24, 3, 3)
    else:
        with pytest.raises(ModelNotFoundError, match="pose_prior"):
            PosePrior.open(manifest).decode(np.zeros((1, 32)))


@pytest.mark.parametrize("shape", [(32,), (2, 31), (1, 2, 32)])
def test_latents_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match=r"expected latents \(B, 32\)"):
        toy().decode(np.zeros(shape))


def test_latents_that_are_not_finite_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="not finite"):
        toy().decode(np.full((1, 32), np.nan))


def test_starts_are_the_mean_and_draws_from_the_prior_decoded_once() -> None:
    calls: list[int] = []

    def decode(rows: np.ndarray) -> np.ndarray:
        calls.append(len(rows))
        return ToyPrior().decode(rows).astype(np.float32)

    prior = PosePrior(decode)
    latents, joints = prior.starts
    assert prior.starts[0] is latents
    assert latents.shape == (256, 32)
    np.testing.assert_array_equal(latents[0], 0)
    assert abs(latents[1:].mean()) < 0.05
    assert latents[1:].std() == pytest.approx(1, abs=0.05)
    expected = positions_by_scipy(prior.decode(latents[5:6])[0], np.zeros(3))
    np.testing.assert_allclose(joints[5], expected, atol=1e-6)
    assert joints.shape == (256, 24, 3)
    assert calls == [256, 1]


def test_float32_decoding_is_enough_to_meet_keypoints() -> None:
    points = {"right_hand": (-0.2, 1.1, 0.4), "left_foot": (0.1, 0, 0.1), "right_foot": (-0.1, 0, 0.1)}
    assert solve_pose(points, toy()).max_error_cm < 1.0
