"""WalkNet at stride 1, TransNet and the pose prior: what is exported computes what was trained."""

from __future__ import annotations

import math

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from scipy.spatial.transform import Rotation  # noqa: E402
from tiny_nets import tiny_pose_prior, tiny_transnet, tiny_walknet  # noqa: E402

from motionrt_export import specs  # noqa: E402
from motionrt_export.gap import Gaps  # noqa: E402
from motionrt_export.motion_graphs import Hidden, TransNetGraph, WalkNetGraph, changes  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402
from motionrt_export.validate import open_session, run  # noqa: E402
from motionrt_export.walks import random_wishes  # noqa: E402
from motionrt_training.networks.motion_transformer import MotionTransformer  # noqa: E402
from motionrt_training.networks.transnet import _distances, clock, fill, find_gap  # noqa: E402
from motionrt_training.networks.walknet import WISHES  # noqa: E402


def poses(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """Frames (..., 219) of random rotations, anywhere within some metres."""
    rotations = Rotation.random(math.prod(shape) * 24, random_state=rng).as_matrix().reshape(*shape, 216)
    return np.concatenate([rotations, rng.normal(0, 3, (*shape, 3))], axis=-1).astype(np.float32)


@pytest.mark.parametrize("patch", [1, 5])
@pytest.mark.parametrize("batch", [1, 4])
def test_the_step_is_the_first_frame_that_walknet_predicts(batch: int, patch: int) -> None:
    model, rng = tiny_walknet(patch), np.random.default_rng(0)
    frames, speed = torch.from_numpy(poses(rng, batch, 30)), torch.rand(batch) * 2
    expected = model(frames, speed)[:, 0]
    torch.testing.assert_close(WalkNetGraph(model)(frames, speed), expected, atol=3e-6, rtol=1e-5)


@pytest.mark.parametrize("batch", [1, 4])
def test_the_step_of_a_network_that_knows_wishes_is_what_it_predicts_with_them_and_without(batch: int) -> None:
    model, rng = tiny_walknet(wishes=True), np.random.default_rng(6)
    model.body.embed.weight.data.unflatten(1, (5, -1))[..., -WISHES:] *= 100.0  # that wishes tell
    frames, speed = torch.from_numpy(poses(rng, batch, 30)), torch.rand(batch) * 2
    wish = torch.from_numpy(random_wishes(batch, rng).astype(np.float32))
    for told in ((frames, speed), (frames, speed, wish), (frames, speed, 0 * wish)):
        found, expected = WalkNetGraph(model)(*told), model(*told)[:, 0]
        torch.testing.assert_close(found, expected, atol=3e-6, rtol=1e-5)
    assert (model(frames, speed, wish)[:, 0] - model(frames, speed)[:, 0]).abs().max() > 1e-4


def test_characters_of_a_crowd_do_not_disturb_each_other() -> None:
    frames, speed = torch.from_numpy(poses(np.random.default_rng(1), 3, 30)), torch.tensor([0.5, 1.0, 1.5])
    step = WalkNetGraph(tiny_walknet())
    alone = torch.cat([step(frames[row : row + 1], speed[row : row + 1]) for row in range(3)])
    torch.testing.assert_close(step(frames, speed), alone)


@pytest.mark.parametrize("patch", [1, 4])
def test_transitions_are_those_of_transnet(patch: int) -> None:
    model, rng = tiny_transnet(patch), np.random.default_rng(2)
    frames, hidden = torch.from_numpy(poses(rng, 3, 120)), torch.zeros(3, 120, dtype=torch.bool)
    hidden[0, 60:119] = hidden[1, 60:80] = hidden[2, 60:118] = True
    found = TransNetGraph(model)(frames, hidden)
    torch.testing.assert_close(found, model(frames, hidden), atol=3e-5, rtol=1e-5)
    assert torch.equal(found[~hidden], frames[~hidden])


@pytest.mark.parametrize("batch", [1, 4])
@pytest.mark.parametrize(
    ("spec", "module"),
    [
        (specs.WALKNET, lambda: WalkNetGraph(tiny_walknet())),
        (specs.WALKNET_WISHES, lambda: WalkNetGraph(tiny_walknet(wishes=True))),
        (specs.TRANSNET, lambda: TransNetGraph(tiny_transnet())),
        (specs.POSE_PRIOR, tiny_pose_prior),
    ],
)
def test_the_file_takes_other_batches_than_the_traced_one(spec, module, batch: int) -> None:
    module, rng = module(), np.random.default_rng(batch)
    shapes = {tensor.name: tensor.resolved({"batch": batch}) for tensor in spec.inputs}
    feeds = {name: rng.normal(size=shape).astype(np.float32) for name, shape in shapes.items()}
    if "hidden" in feeds:
        feeds["hidden"] = np.zeros((batch, 120), bool)
        for row, gap in zip(feeds["hidden"], rng.integers(0, 60, batch), strict=True):
            row[60 : 60 + gap] = True
    found = run(open_session(trace(module, spec).SerializeToString()), feeds)[spec.outputs[0].name]
    expected = module(*(torch.from_numpy(feeds[tensor.name]) for tensor in spec.inputs))
    np.testing.assert_allclose(found, expected.numpy(), atol=1e-4)


NONE = torch.zeros(1)  # no key is masked


def test_the_layers_answer_for_the_first_frames_alone() -> None:
    torch.manual_seed(0)
    source = MotionTransformer(8, 8, 64, 3, 2, 64).eval()
    x = torch.randn(2, 30, 64)
    expected = source.layers[2](source.layers[1](source.layers[0](x, NONE), NONE), NONE)
    torch.testing.assert_close(Hidden(source)(x), expected, atol=1e-5, rtol=1e-5)
    for first in (1, 7):
        torch.testing.assert_close(Hidden(source, first=first)(x), expected[:, :first], atol=1e-5, rtol=1e-5)


def test_gaps_are_filled_and_told_as_the_network_does_it() -> None:
    frames, hidden = torch.from_numpy(poses(np.random.default_rng(4), 4, 120)), torch.zeros(4, 120, dtype=torch.bool)
    for row, length in zip(hidden, (0, 1, 57, 59), strict=True):
        row[60 : 60 + length] = True
    around, gap = find_gap(hidden), Gaps()(hidden[:, 60:])
    rest = frames[:, 60:].masked_fill(gap.there, 0.0)
    filled = gap.coasting @ torch.cat((frames[:, 58:60], gap.behind @ rest), dim=1)
    torch.testing.assert_close(torch.where(gap.there, filled, rest), fill(frames, around)[:, 60:], atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(gap.clock, clock(hidden, *_distances(around, hidden))[:, 60:])


def test_changes_are_differences_from_the_row_before() -> None:
    x = torch.tensor([[1.0], [4.0], [2.0]])
    assert (changes(3) @ x).flatten().tolist() == [3.0, 3.0, -2.0]
