"""8-bit weights against NumPy, weights that no CPU saturates on, and smoothing that changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

import onnxruntime as ort  # noqa: E402
from onnx import TensorProto, helper, numpy_helper  # noqa: E402

from motionrt_export.quantise import LIMIT, blocks, channels, int8_rows, product_names  # noqa: E402
from motionrt_export.smooth import PARTS, input_peaks, smooth  # noqa: E402

RNG = np.random.default_rng(11)
WEIGHT = (RNG.normal(size=(200, 48)) * RNG.uniform(0.1, 3, size=48) + 0.2).astype(np.float32)
X = RNG.normal(size=(5, 200)).astype(np.float32)


def product(weight: np.ndarray = WEIGHT) -> onnx.ModelProto:
    """x (N, K) @ weight."""
    node = helper.make_node("MatMul", ["x", "w"], ["y"], name="/part/MatMul")
    value = [helper.make_tensor_value_info(n, TensorProto.FLOAT, ["n", None]) for n in "xy"]
    graph = helper.make_graph([node], "g", [value[0]], [value[1]], [numpy_helper.from_array(weight, "w")])
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=10)


def lookup(table: np.ndarray) -> onnx.ModelProto:
    node = helper.make_node("Gather", ["t", "ids"], ["y"], name="/words/Gather")
    ids = helper.make_tensor_value_info("ids", TensorProto.INT64, ["n"])
    y = helper.make_tensor_value_info("y", TensorProto.FLOAT, ["n", None])
    graph = helper.make_graph([node], "g", [ids], [y], [numpy_helper.from_array(table, "t")])
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=10)


def run(model: onnx.ModelProto, **feeds: np.ndarray) -> np.ndarray:
    session = ort.InferenceSession(model.SerializeToString(), providers=["CPUExecutionProvider"])
    result: np.ndarray = session.run(None, feeds)[0]
    return result


def stored(model: onnx.ModelProto) -> dict[str, np.ndarray]:
    return {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}


def relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.linalg.norm(found - expected) / np.linalg.norm(expected))


def test_channels_hold_the_weight_to_half_a_step() -> None:
    model = product()
    channels(model, product_names(model))
    kept = stored(model)
    scale = kept["w.channel_scale"]
    weight = (kept["w.int8"].astype(np.float64) - kept["w.channel_zero"]) * scale
    assert (np.abs(weight - WEIGHT) <= scale * 1.01).all()
    assert "w" not in kept
    assert relative(run(model, x=X), X @ WEIGHT) < 0.02


def test_two_products_of_a_channel_weight_fit_16_bits() -> None:
    model = product(WEIGHT * 100)
    channels(model, product_names(model))
    integers = stored(model)["w.int8"].astype(int)
    assert np.abs(integers).max() == LIMIT
    assert 2 * 255 * np.abs(integers).max() < 2**15


@pytest.mark.parametrize("block", [32, 64, 128])
def test_blocks_hold_the_weight_to_half_a_step(block: int) -> None:
    model = product()
    blocks(model, product_names(model), block=block)
    kept = stored(model)
    count = -(-200 // block)
    scale = kept["w.scales"].reshape(48, count, 1)
    weight = ((kept["w.blocks"].astype(np.float64) - 128) * scale).reshape(48, -1)[:, :200].T
    step = np.repeat(scale[..., 0], block, axis=1)[:, :200].T
    assert (np.abs(weight - WEIGHT) <= step * 0.501).all()
    assert relative(run(model, x=X), X @ WEIGHT) < 0.01


def test_rows_of_blocks_do_not_disturb_each_other() -> None:
    model = product()
    blocks(model, product_names(model))
    loud = np.concatenate([X, X[:1] * 1000])
    np.testing.assert_allclose(run(model, x=loud)[:5], run(model, x=X), rtol=1e-5, atol=1e-5)


def test_big_tables_become_rows_of_int8() -> None:
    table = (RNG.normal(size=(1500, 24)) * RNG.uniform(0.01, 5, size=(1500, 1))).astype(np.float32)
    model, ids = lookup(table), np.array([3, 0, 1499, 3])
    int8_rows(model)
    assert stored(model)["t.int8"].dtype == np.int8
    error = np.abs(run(model, ids=ids) - table[ids])
    assert (error <= np.abs(table[ids]).max(axis=1, keepdims=True) / 127 * 0.51).all()


def test_small_tables_stay() -> None:
    model = lookup(np.ones((20, 4), np.float32))
    before = model.SerializeToString(deterministic=True)
    int8_rows(model)
    assert model.SerializeToString(deterministic=True) == before


def outliers() -> np.ndarray:
    x = X.copy()
    x[:, 7] *= 80
    return x


def test_smoothing_changes_no_result() -> None:
    model = product()
    smooth(model, product_names(model), [{"x": outliers()}], alpha=0.6)
    np.testing.assert_allclose(run(model, x=outliers()), outliers() @ WEIGHT, rtol=1e-4, atol=1e-3)
    factors = stored(model)["/part/MatMul.smooth"]
    np.testing.assert_allclose(PARTS * np.log2(factors), np.rint(PARTS * np.log2(factors)), atol=1e-5)
    assert factors[7] < np.median(factors)


def test_smoothing_makes_outliers_bearable() -> None:
    plain, smoothed = product(), product()
    smooth(smoothed, product_names(smoothed), [{"x": outliers()}], alpha=0.6)
    for model in (plain, smoothed):
        channels(model, product_names(model))
    rest = np.delete(np.arange(200), 7)
    x = outliers()
    x[0, rest] *= 3
    expected = x @ WEIGHT
    assert relative(run(smoothed, x=x), expected) < relative(run(plain, x=x), expected)


def test_peaks_are_taken_over_all_of_the_calibration() -> None:
    model = product()
    peaks = input_peaks(model, product_names(model), [{"x": X}, {"x": -2 * X}])
    np.testing.assert_allclose(peaks["x"], np.abs(2 * X).max(axis=0))
