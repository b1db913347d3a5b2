"""Transitions: they end where they should, see the world from the target, and a tiny ONNX model fills them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.locomotion.goal_frame import Goal, canonicalise, uncanonicalise
from motionrt.locomotion.transitions import FRAMES, SETTLE, distance, goal_of, placed, speed_of, transition
from motionrt.metrics.locomotion import foot_skate
from motionrt.models.transnet import SEED, WINDOW, TransitionModel
from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import ccf219
from motionrt.motion.transforms import heading

FPS = 30.0
POSE = random_motion(1, FPS, seed=5, root=(0.3, 0.8, -0.2))


def stays(frames: np.ndarray, hidden: np.ndarray) -> np.ndarray:
    """Hidden frames are the target already."""
    return np.where(hidden[..., None], frames[:, -1:], frames)


def glides(frames: np.ndarray, hidden: np.ndarray) -> np.ndarray:
    """The pose of the last seed frame, its root on a straight line to the target."""
    share = np.clip((np.arange(WINDOW) - SEED + 1) / FRAMES, 0, 1)[:, None]
    filled = np.repeat(frames[:, SEED - 1 : SEED], WINDOW, axis=1)
    filled[..., 216:] += share * (frames[:, -1:, 216:] - filled[..., 216:])
    return np.where(hidden[..., None], filled, frames).astype(np.float32)


class OneModel:
    """Sessions with a single file."""

    def __init__(self, path: Path) -> None:
        onnxruntime = pytest.importorskip("onnxruntime", reason="onnxruntime is not installed")
        self.session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])

    def run(self, model: str, outputs: list[str], feeds: dict[str, np.ndarray], variant: str | None) -> Any:
        assert (model, variant) == ("transnet", "tiny")
        return self.session.run(outputs, feeds)


@pytest.fixture(scope="module")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> TransitionModel:
    """`stays` as an ONNX file with the real names, types and axes."""
    onnx = pytest.importorskip("onnx", reason='onnx is not installed: pip install "motionrt[export]"')
    make, node, types = onnx.helper.make_tensor_value_info, onnx.helper.make_node, onnx.TensorProto
    constants = {"last": [WINDOW - 1], "end": [WINDOW], "time": [1], "behind": [-1]}
    tensors = [onnx.numpy_helper.from_array(np.array(value, np.int64), name) for name, value in constants.items()]
    nodes = [
        node("Slice", ["frames", "last", "end", "time"], ["target"]),
        node("Unsqueeze", ["hidden", "behind"], ["column"]),
        node("Where", ["column", "target", "frames"], ["motion"]),
    ]
    inputs = [
        make("frames", types.FLOAT, ["batch", WINDOW, 219]),
        make("hidden", types.BOOL, ["batch", WINDOW]),
    ]
    outputs = [make("motion", types.FLOAT, ["batch", WINDOW, 219])]
    graph = onnx.helper.make_graph(nodes, "transnet", inputs, outputs, tensors)
    model = onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model, full_check=True)
    path = tmp_path_factory.mktemp("models") / "transnet.tiny.onnx"
    path.write_bytes(model.SerializeToString())
    return TransitionModel(OneModel(path), "tiny")  # type: ignore[arg-type]


@pytest.mark.parametrize("batch", [1, 3])
def test_the_model_fills_hidden_frames_of_any_number_of_windows(tiny: TransitionModel, batch: int) -> None:
    rng = np.random.default_rng(0)
    frames = rng.normal(size=(batch, WINDOW, 219)).astype(np.float32)
    hidden = np.zeros((batch, WINDOW), bool)
    for row, frame in zip(hidden, (WINDOW - 1, SEED + 1, SEED), strict=False):
        row[SEED:frame] = True
    np.testing.assert_array_equal(tiny(frames, hidden), stays(frames, hidden))


def test_windows_of_another_shape_or_with_another_gap_are_refused(tiny: TransitionModel) -> None:
    frames, hidden = np.zeros((2, WINDOW, 219), np.float32), np.zeros((2, WINDOW), bool)
    with pytest.raises(InvalidInputError, match="shapes"):
        tiny(frames[:, 1:], hidden[:, 1:])
    with pytest.raises(InvalidInputError, match="shapes"):
        tiny(frames, hidden[:1])
    for gap in (slice(SEED, WINDOW), slice(SEED - 1, 90), slice(SEED + 1, 90)):
        wrong = hidden.copy()
        wrong[1, gap] = True
        with pytest.raises(InvalidInputError, match="one gap, from frame 60 on"):
            tiny(frames, wrong)
    hidden[1, SEED:80] = hidden[1, 90:100] = True
    with pytest.raises(InvalidInputError, match="one gap"):
        tiny(frames, hidden)


@given(
    x=st.floats(-20, 20),
    z=st.floats(-20, 20),
    yaw=st.floats(-3, 3),
)
@settings(max_examples=20, deadline=None)
def test_a_transition_ends_in_the_target_at_its_goal(x: float, z: float, yaw: float) -> None:
    found = transition(glides, walking(70, FPS), POSE, Goal(x, z, yaw))
    assert found.frames == FRAMES
    assert found.fps == FPS
    body = POSE.positions()[0] - POSE.root[0] * [1, 0, 1]
    turn = Rotation.from_euler("y", yaw - float(heading(POSE)[0]))
    np.testing.assert_allclose(found.positions()[-1], turn.apply(body) + np.array([x, 0, z]), atol=2e-5)


def test_without_a_goal_the_target_stays_where_it_is_to_the_last_bit(tiny: TransitionModel) -> None:
    for lock in (False, True):
        found = transition(tiny, walking(60, FPS), POSE, foot_lock=lock)
        np.testing.assert_array_equal(found.rotations[-1], POSE.rotations[0])
        np.testing.assert_array_equal(found.root[-1], POSE.root[0])


def test_the_model_sees_the_world_from_the_target() -> None:
    seen = []

    def watch(frames: np.ndarray, hidden: np.ndarray) -> np.ndarray:
        seen.append((frames, hidden))
        return stays(frames, hidden)

    seed = walking(75, FPS, turn=0.3)
    transition(watch, seed, POSE, Goal(4, -2, 2.5))
    frames, hidden = seen[0]
    assert frames.shape == (1, WINDOW, 219)
    assert frames.dtype == np.float32
    assert np.flatnonzero(hidden[0]).tolist() == list(range(SEED, WINDOW - 1))
    assert not frames[0, SEED:-1].any()
    last = ccf219.decode(frames[0, -1:])
    np.testing.assert_allclose(last.root[0, [0, 2]], 0, atol=1e-6)
    assert abs(float(heading(last)[0])) < 1e-5
    np.testing.assert_allclose(frames[0, :SEED], ccf219.encode(canonicalise(seed[-SEED:], Goal(4, -2, 2.5))), atol=1e-5)


def test_a_transition_does_not_depend_on_where_in_the_world_it_happens() -> None:
    seed, elsewhere = walking(60, FPS), Goal(7, -3, 1.9)
    aim = placed(POSE, Goal(0.5, 1.5, 0.4))
    here = transition(glides, seed, aim)
    there = transition(glides, uncanonicalise(seed, elsewhere), uncanonicalise(aim, elsewhere))
    np.testing.assert_allclose(there.positions(), uncanonicalise(here, elsewhere).positions(), atol=1e-4)


def test_filled_matrices_come_back_as_rotations() -> None:
    def rough(frames: np.ndarray, hidden: np.ndarray) -> np.ndarray:
        noise = np.random.default_rng(1).normal(0, 0.1, frames.shape).astype(np.float32)
        return stays(frames, hidden) + noise  # visible frames too: they must not be taken from the model

    found = transition(rough, walking(60, FPS), POSE)
    gram = found.rotations @ np.swapaxes(found.rotations, -1, -2)
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-5)
    np.testing.assert_allclose(np.linalg.det(found.rotations), 1, atol=1e-5)
    np.testing.assert_array_equal(found.rotations[-1], POSE.rotations[0])


def test_a_pose_that_will_be_held_rests_at_the_end() -> None:
    found = transition(glides, walking(60, FPS), POSE, held=True)
    np.testing.assert_array_equal(found.root[-SETTLE:], np.repeat(POSE.root, SETTLE, axis=0))
    np.testing.assert_array_equal(found.rotations[-SETTLE:], np.repeat(POSE.rotations, SETTLE, axis=0))
    assert np.abs(found.root[-SETTLE - 1] - POSE.root[0]).max() > 1e-3


def test_a_motion_as_target_is_the_end_of_the_transition() -> None:
    stride = walking(20, FPS, speed=1.0)
    found = transition(glides, walking(60, FPS), stride, Goal(0, 3, 0.5))
    np.testing.assert_allclose(found[-20:].positions(), placed(stride, Goal(0, 3, 0.5)).positions(), atol=1e-5)
    assert goal_of(found[-20:]).heading == pytest.approx(0.5, abs=1e-5)


def test_a_short_seed_is_preceded_by_its_first_frame() -> None:
    seeds = []

    def watch(frames: np.ndarray, hidden: np.ndarray) -> np.ndarray:
        seeds.append(frames[0, :SEED])
        return stays(frames, hidden)

    short = walking(5, FPS)
    transition(watch, short, POSE)
    assert np.ptp(seeds[0][:56], axis=0).max() == 0
    assert np.ptp(seeds[0][55:], axis=0).max() > 0


def test_other_frame_rates_and_long_targets_are_refused() -> None:
    with pytest.raises(InvalidInputError, match=r"seed must be at 30 fps.*resample"):
        transition(stays, walking(60, 20.0), POSE)
    with pytest.raises(InvalidInputError, match="target must be at 30 fps"):
        transition(stays, walking(60, FPS), standing(1, 60.0))
    with pytest.raises(InvalidInputError, match="up to 20 frames, not 21"):
        transition(stays, walking(60, FPS), walking(21, FPS))


def test_locked_feet_slide_less_and_the_ends_stay() -> None:
    """The body sways over its feet by 4 cm, and both slide along."""
    body = standing(1, FPS)
    bent = body.rotations.copy()
    for joint, angle in (("hip", -0.3), ("knee", 0.6), ("ankle", -0.3)):
        for side in ("left", "right"):
            bent[0, SMPL24.index(f"{side}_{joint}")] = Rotation.from_euler("x", angle).as_matrix()
    pose = Motion(bent, body.root, FPS).grounded()
    aim = Motion(pose.rotations, pose.root + np.array([0, 0, 0.04], np.float32), FPS)
    seed = Motion(np.repeat(pose.rotations, 60, axis=0), np.repeat(pose.root, 60, axis=0), FPS)
    loose, firm = (transition(glides, seed, aim, foot_lock=lock) for lock in (False, True))
    assert foot_skate(firm.positions()[6:-6]) < 0.5 * foot_skate(loose.positions()[6:-6])
    np.testing.assert_allclose(firm.positions()[0], loose.positions()[0], atol=2e-3)
    np.testing.assert_array_equal(firm.root[-1], aim.root[0])


def test_a_stop_or_start_covers_more_ground_the_faster_it_is() -> None:
    assert distance(0, 0) == 0
    assert distance(1.0, 0.0) < distance(1.5, 0.0) < distance(1.5, 1.0)
    assert 0.5 < distance(1.2, 0.0) < 1.2
    with pytest.raises(InvalidInputError, match="metres per second"):
        distance(-1, 0)
    with pytest.raises(InvalidInputError, match="metres per second"):
        distance(0, float("nan"))


def test_speed_is_that_of_the_last_half_second() -> None:
    assert speed_of(walking(60, FPS, speed=1.3)) == pytest.approx(1.3, rel=1e-4)
    assert speed_of(standing(1, FPS)) == 0
