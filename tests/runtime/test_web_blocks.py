"""Models for the page are the same function without products by 8-bit blocks, and otherwise the same bytes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from motionrt.web.blocks import unfolded

onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

WIDTH, COUNT, BLOCK = 256, 48, 128


def model(*, bias: bool, bits: int = 8) -> Any:
    random = np.random.default_rng(0)
    arrays = {
        "codes": random.integers(0, 256, (COUNT, WIDTH // BLOCK, BLOCK * bits // 8), dtype=np.uint8),
        "scales": random.uniform(0.01, 0.02, COUNT * WIDTH // BLOCK).astype(np.float32),
        "bias": random.normal(size=COUNT).astype(np.float32),
    }
    inputs = ["x", "codes", "scales", *(["", "", "bias"] if bias else [])]
    sizes = {"K": WIDTH, "N": COUNT, "bits": bits, "block_size": BLOCK, "accuracy_level": 0}
    nodes = [
        onnx.helper.make_node("MatMulNBits", inputs, ["y"], name="product", domain="com.microsoft", **sizes),
        onnx.helper.make_node("Relu", ["y"], ["z"], name="relu"),
    ]
    graph = onnx.helper.make_graph(
        nodes,
        "small",
        [onnx.helper.make_tensor_value_info("x", 1, [None, WIDTH])],
        [onnx.helper.make_tensor_value_info("z", 1, [None, COUNT])],
        [onnx.numpy_helper.from_array(array, name) for name, array in arrays.items()],
    )
    opsets = [onnx.helper.make_opsetid("", 18), onnx.helper.make_opsetid("com.microsoft", 1)]
    return onnx.helper.make_model(graph, opset_imports=opsets, ir_version=8)


def answer(content: bytes, given: np.ndarray) -> np.ndarray:
    import onnxruntime

    return onnxruntime.InferenceSession(content, providers=["CPUExecutionProvider"]).run(None, {"x": given})[0]


@pytest.mark.parametrize("bias", [False, True])
def test_blocks_are_decoded_by_plain_operators_to_the_same_numbers(bias: bool) -> None:
    made = model(bias=bias)
    plain = unfolded(made.SerializeToString())
    found = onnx.load_model_from_string(plain)
    onnx.checker.check_model(found)
    assert "MatMulNBits" not in {node.op_type for node in found.graph.node}
    codes, scales, offset = (onnx.numpy_helper.to_array(one) for one in made.graph.initializer)
    weights = ((codes.astype(np.float64) - 128) * scales.reshape(COUNT, -1, 1)).reshape(COUNT, WIDTH)
    given = np.random.default_rng(1).normal(size=(5, WIDTH)).astype(np.float32)
    wanted = np.maximum(given @ weights.T + (offset if bias else 0), 0)
    np.testing.assert_allclose(answer(plain, given), wanted, atol=1e-3)


def test_a_model_without_such_blocks_stays_byte_by_byte() -> None:
    content = model(bias=True, bits=4).SerializeToString()
    assert unfolded(content) == content


def columns(kind: str) -> Any:
    """A product of 8-bit numbers, whose weights have a scale a column."""
    random = np.random.default_rng(2)
    arrays = {
        "codes": random.integers(-64, 65, (WIDTH, COUNT), dtype=np.int8),
        "scales": random.uniform(0.01, 0.02, COUNT).astype(np.float32),
        "zeros": np.zeros(COUNT, np.int8),
        "bias": random.normal(size=COUNT).astype(np.float32),
    }
    if kind == "DynamicQuantizeMatMul":
        nodes = [("x", "codes", "scales", "zeros", "bias")]
    else:
        nodes = [("q", "codes", "step", "scales", "zero", "zeros", "bias")]
    made = [onnx.helper.make_node(kind, nodes[0], ["z"], name="product", domain="com.microsoft")]
    if kind != "DynamicQuantizeMatMul":
        made.insert(0, onnx.helper.make_node("DynamicQuantizeLinear", ["x"], ["q", "step", "zero"], name="codes of x"))
    graph = onnx.helper.make_graph(
        made,
        "small",
        [onnx.helper.make_tensor_value_info("x", 1, [None, WIDTH])],
        [onnx.helper.make_tensor_value_info("z", 1, [None, COUNT])],
        [onnx.numpy_helper.from_array(array, name) for name, array in arrays.items()],
    )
    opsets = [onnx.helper.make_opsetid("", 18), onnx.helper.make_opsetid("com.microsoft", 1)]
    return onnx.helper.make_model(graph, opset_imports=opsets, ir_version=8), arrays


@pytest.mark.parametrize("kind", ["DynamicQuantizeMatMul", "MatMulIntegerToFloat"])
def test_exact_files_round_no_activations(kind: str) -> None:
    made, arrays = columns(kind)
    content = made.SerializeToString()
    assert unfolded(content) == content
    exact = unfolded(content, exact=True)
    assert kind not in {node.op_type for node in onnx.load_model_from_string(exact).graph.node}
    given = np.random.default_rng(3).normal(size=(5, WIDTH)).astype(np.float32)
    wanted = given @ (arrays["codes"].astype(np.float64) * arrays["scales"]) + arrays["bias"]
    np.testing.assert_allclose(answer(exact, given), wanted, atol=1e-4)
    assert np.abs(answer(content, given) - wanted).max() > 1e-3
