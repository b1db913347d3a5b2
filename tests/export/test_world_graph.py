"""WalkNet with the world around it: one step of the runtime's crowd, in a file of its own."""

from __future__ import annotations

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from scipy.spatial.transform import Rotation  # noqa: E402
from tiny_nets import tiny_walknet  # noqa: E402

from motionrt.locomotion.crowd import Crowd  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402
from motionrt_export.validate import open_session  # noqa: E402
from motionrt_export.world_graph import SPEC, WalkNetWorldGraph, proper  # noqa: E402


def walkers(count: int, away: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Histories (B, 30, 219) of poses that hardly change, goals (B, 3) near them, speeds (B,)."""
    rng = np.random.default_rng(count)
    poses = Rotation.random(count * 24, random_state=rng).as_matrix().reshape(count, 1, 216)
    places = rng.normal(0, 1, (count, 30, 3)) * 0.1 + np.array([away, 1.0, -away])
    goals = np.column_stack([places[:, -1, [0, 2]] + rng.normal(size=(count, 2)), rng.uniform(-3, 3, count)])
    return np.concatenate([np.repeat(poses, 30, axis=1), places], axis=2), goals, rng.uniform(0.8, 1.5, count)


@pytest.mark.parametrize(("away", "close"), [(0.0, 3e-6), (1000.0, 2e-4)])
@pytest.mark.parametrize("count", [1, 5])
def test_the_file_makes_the_step_of_the_runtime_anywhere(count: int, away: float, close: float) -> None:
    model = tiny_walknet()
    history, goals, speeds = walkers(count, away)

    def step(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        with torch.no_grad():
            return model(torch.from_numpy(frames), torch.from_numpy(speed.copy()))[:, 0].numpy()

    expected = Crowd(step, history).step(goals, speeds)
    session = open_session(trace(WalkNetWorldGraph(model), SPEC).SerializeToString())
    feeds = {"history": history, "goal": goals, "speed": speeds}
    found = session.run(["next"], {name: value.astype(np.float32) for name, value in feeds.items()})[0]
    np.testing.assert_allclose(found, expected, atol=close)


def test_rotations_that_are_a_fifth_off_become_the_nearest_proper_ones() -> None:
    rng = np.random.default_rng(0)
    turns = Rotation.random(24, random_state=rng).as_matrix()
    stretched = turns @ np.diag([1.2, 0.85, 1.1])
    frame = np.concatenate([stretched.ravel(), [1.0, 2.0, 3.0]])[None].astype(np.float32)
    found = proper(torch.from_numpy(frame)).numpy()
    np.testing.assert_allclose(found[0, :216], turns.ravel(), atol=2e-6)
    np.testing.assert_array_equal(found[0, 216:], frame[0, 216:])
