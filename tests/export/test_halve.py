"""Weights stored as float16: half the bytes, the same graph, computed in float32, folded when it opens."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

import onnxruntime as ort  # noqa: E402
from onnx import TensorProto, helper, numpy_helper  # noqa: E402

from motionrt_export.halve import halve  # noqa: E402
from motionrt_export.validate import open_session  # noqa: E402

RANDOM = np.random.default_rng(0)
TABLE = RANDOM.standard_normal((50, 32)).astype(np.float32)
MATRIX = RANDOM.standard_normal((32, 64)).astype(np.float32)
HUGE = np.full((32, 64), 1e6, np.float32)
BIAS = RANDOM.standard_normal(2048).astype(np.float32)


def model(weight: np.ndarray = MATRIX) -> onnx.ModelProto:
    """ids -> rows of a table -> a product with a weight that is used twice -> a sum of both."""
    nodes = [
        helper.make_node("Gather", ["table", "ids"], ["rows"], name="look"),
        helper.make_node("MatMul", ["rows", "weight"], ["first"], name="a"),
        helper.make_node("Transpose", ["weight"], ["turned"], name="turn", perm=[1, 0]),
        helper.make_node("MatMul", ["first", "turned"], ["second"], name="b"),
        helper.make_node("Tile", ["second", "times"], ["wide"], name="tile"),
        helper.make_node("Add", ["wide", "bias"], ["out"], name="add"),
    ]
    constants = {"table": TABLE, "weight": weight, "bias": BIAS, "times": np.array([1, 64])}
    tensors = [numpy_helper.from_array(value, name) for name, value in constants.items()]
    ids = helper.make_tensor_value_info("ids", TensorProto.INT64, ["batch"])
    out = helper.make_tensor_value_info("out", TensorProto.FLOAT, ["batch", 2048])
    graph = helper.make_graph(nodes, "small", [ids], [out], tensors)
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=10)


def result(content: onnx.ModelProto) -> np.ndarray:
    found: np.ndarray = open_session(content.SerializeToString()).run(None, {"ids": np.array([3, 49, 3])})[0]
    return found


def stored(content: onnx.ModelProto) -> dict[str, np.ndarray]:
    return {tensor.name: numpy_helper.to_array(tensor) for tensor in content.graph.initializer}


def test_matrices_are_halved_once_and_vectors_stay() -> None:
    halved = halve(model())
    onnx.checker.check_model(halved, full_check=True)
    assert {name: value.dtype.name for name, value in stored(halved).items()} == {
        "table.float16": "float16",
        "weight.float16": "float16",
        "bias": "float32",
        "times": "int64",
    }


def test_the_result_is_that_of_float32_with_rounded_weights() -> None:
    def rounded(value: np.ndarray) -> np.ndarray:
        return value.astype(np.float16).astype(np.float64)

    rows = rounded(TABLE)[[3, 49, 3]]
    expected = np.tile(rows @ rounded(MATRIX) @ rounded(MATRIX).T, 64) + BIAS
    np.testing.assert_allclose(result(halve(model())), expected, rtol=1e-4, atol=1e-3)


def test_the_original_is_not_touched() -> None:
    content = model()
    before = content.SerializeToString(deterministic=True)
    halve(content)
    assert content.SerializeToString(deterministic=True) == before


def test_what_float16_cannot_hold_stays_float32() -> None:
    halved = stored(halve(model(HUGE)))
    assert halved["weight"].dtype == np.float32
    assert halved["table.float16"].dtype == np.float16


def test_the_casts_of_matrices_are_folded_when_the_session_opens(tmp_path) -> None:
    options = ort.SessionOptions()
    options.optimized_model_filepath = str(tmp_path / "opened.onnx")
    options.log_severity_level = 3
    ort.InferenceSession(halve(model()).SerializeToString(), options, providers=["CPUExecutionProvider"])
    casts = [node.name for node in onnx.load(tmp_path / "opened.onnx").graph.node if node.op_type == "Cast"]
    assert len(casts) == 1  # the rows of the table
