"""The model that is written by hand is the one that the onnx package reads and onnxruntime runs."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.retrieval.scan_graph import scan_model


def test_the_checker_of_onnx_reads_it() -> None:
    onnx = pytest.importorskip("onnx", reason="onnx is not installed")
    model = onnx.ModelProto.FromString(scan_model(70_000, 256))
    node = model.graph.node[0]
    assert (node.op_type, node.domain, list(node.input)) == (
        "MatMulNBits",
        "com.microsoft",
        ["query", "codes", "scales"],
    )
    assert {a.name: onnx.helper.get_attribute_value(a) for a in node.attribute} == {
        "K": 256, "N": 70_000, "bits": 8, "block_size": 256, "accuracy_level": 4,
    }  # fmt: skip
    assert [list(tensor.dims) for tensor in model.graph.initializer] == [[70_000, 1, 256], [70_000]]
    assert {(opset.domain, opset.version) for opset in model.opset_import} == {("", 17), ("com.microsoft", 1)}


def test_writing_it_again_with_onnx_changes_nothing() -> None:
    onnx = pytest.importorskip("onnx", reason="onnx is not installed")
    content = scan_model(300, 64)
    again = onnx.ModelProto.FromString(content)
    assert onnx.ModelProto.FromString(again.SerializeToString()) == again
    assert len(again.SerializeToString()) == len(content)  # no unknown and no doubled fields


@pytest.mark.parametrize("width", [16, 32, 128, 256])
def test_onnxruntime_computes_the_product(width: int) -> None:
    import onnxruntime

    random = np.random.default_rng(0)
    codes = random.integers(1, 256, (200, 1, width), dtype=np.uint8)
    scales = random.uniform(0.5, 2, 200).astype(np.float32)
    options = onnxruntime.SessionOptions()
    values = [onnxruntime.OrtValue.ortvalue_from_numpy(array) for array in (codes, scales)]
    options.add_external_initializers(["codes", "scales"], values)
    session = onnxruntime.InferenceSession(scan_model(200, width), options, providers=["CPUExecutionProvider"])
    query = random.integers(-127, 128, (1, width)).astype(np.float32)
    query[0, 0] = 127
    exact = (query @ (codes[:, 0].astype(np.float64) - 128).T) * scales
    np.testing.assert_allclose(session.run(None, {"query": query})[0], exact, rtol=1e-5, atol=1.0)


@pytest.mark.parametrize("width", [16, 128, 256])
def test_onnxruntime_computes_the_product_of_4_bits(width: int) -> None:
    import onnxruntime

    random = np.random.default_rng(1)
    codes = random.integers(1, 16, (200, width), dtype=np.uint8)
    packed = np.ascontiguousarray((codes[:, ::2] | (codes[:, 1::2] << 4))[:, None])
    options = onnxruntime.SessionOptions()
    values = [onnxruntime.OrtValue.ortvalue_from_numpy(array) for array in (packed, np.ones(200, np.float32))]
    options.add_external_initializers(["codes", "scales"], values)
    session = onnxruntime.InferenceSession(scan_model(200, width, 4), options, providers=["CPUExecutionProvider"])
    query = random.integers(-127, 128, (1, width)).astype(np.float32)
    query[0, 0] = 127
    np.testing.assert_allclose(session.run(None, {"query": query})[0], query @ (codes.astype(np.float64) - 8).T, atol=1)
