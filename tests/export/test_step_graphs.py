"""The step decoder of TEMOS: the loop in the file makes the motion that torch makes step by step."""

from __future__ import annotations

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import tiny_temos  # noqa: E402

from motionrt_export.optimise import CHOICES, quantise  # noqa: E402
from motionrt_export.specs import TEMOS_DECODER  # noqa: E402
from motionrt_export.step_graphs import STEP, Steps  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402
from motionrt_export.validate import open_session, run  # noqa: E402
from motionrt_training.networks.temos import Temos  # noqa: E402


@pytest.fixture(scope="module")
def model() -> Temos:
    return tiny_temos(decoder="steps")


@pytest.fixture(scope="module")
def file(model: Temos) -> onnx.ModelProto:
    return exported(model)


def exported(model: Temos, *, small: bool = False) -> onnx.ModelProto:
    steps = Steps.of(model)
    assert steps is not None
    step = trace(steps.step, STEP)
    return steps.looped(quantise(step, CHOICES["temos_decoder"]) if small else step)


def decoded(file: onnx.ModelProto, latent: torch.Tensor, mask: torch.Tensor) -> np.ndarray:
    session = open_session(file.SerializeToString())
    return run(session, {"latent": latent.numpy(), "mask": mask.numpy()})["motion"]


@pytest.mark.parametrize(("batch", "length"), [(1, 1), (1, 8), (3, 9), (2, 61)])
def test_the_loop_makes_the_motion_of_torch(model: Temos, file: onnx.ModelProto, batch: int, length: int) -> None:
    latent, mask = torch.randn(batch, 256), torch.ones(batch, length, dtype=torch.bool)
    mask[-1, max(1, length // 2) :] = False
    expected = model.decode(latent, mask).numpy()
    np.testing.assert_allclose(decoded(file, latent, mask), expected, atol=1e-4)
    assert np.abs(expected[0, -1] - expected[0, 0]).max() > 0 or length == 1


def test_the_file_is_valid_and_declared_as_agreed(file: onnx.ModelProto) -> None:
    onnx.checker.check_model(file)
    declared = [(v.name, [d.dim_param or d.dim_value for d in v.type.tensor_type.shape.dim]) for v in file.graph.input]
    assert declared == [(tensor.name, list(tensor.shape)) for tensor in TEMOS_DECODER.inputs]


def test_what_the_latent_says_is_worked_out_once(file: onnx.ModelProto) -> None:
    loop = next(node for node in file.graph.node if node.op_type == "Loop")
    inside = [node.name for node in loop.attribute[0].g.node if node.op_type == "MatMul"]
    outside = [node.name for node in file.graph.node if node.op_type == "MatMul"]
    assert outside == ["/shape/MatMul"]
    assert len(inside) == 3 + 2 * 2  # frames and clock in, two layers, frames out


def test_eight_bits_are_enough_and_two_exports_are_the_same_bytes(model: Temos, file: onnx.ModelProto) -> None:
    small = exported(model, small=True)
    assert small.SerializeToString(deterministic=True) == exported(model, small=True).SerializeToString(
        deterministic=True
    )
    latent, mask = torch.randn(1, 256), torch.ones(1, 40, dtype=torch.bool)
    error = decoded(small, latent, mask) - decoded(file, latent, mask)
    assert 0 < np.sqrt(np.square(error).mean()) < 0.03


def test_a_network_that_decodes_at_once_has_no_steps() -> None:
    assert Steps.of(tiny_temos()) is None
