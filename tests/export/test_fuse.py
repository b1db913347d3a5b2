"""Attention as one operator, fused graphs and switched outputs: the same numbers, fewer operators, nothing of more."""

from __future__ import annotations

from collections import Counter

import numpy as np
import onnxruntime as ort
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from onnx import TensorProto, helper, numpy_helper  # noqa: E402
from tiny_nets import TinySources, tiny_sources  # noqa: E402

from motionrt_export.attention import join_attention  # noqa: E402
from motionrt_export.branch import switched, with_switch  # noqa: E402
from motionrt_export.fuse import fused  # noqa: E402
from motionrt_export.optimise import CHOICES, quantise  # noqa: E402
from motionrt_export.quantise import blocks  # noqa: E402
from motionrt_export.specs import TMR_MOTION, TMR_TEXT  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402

NAMES = [tensor.name for tensor in TMR_TEXT.outputs]
WHOLE, PART = NAMES[:2], NAMES[2:]


def run(model: onnx.ModelProto, feeds: dict[str, np.ndarray], names: list[str]) -> list[np.ndarray]:
    options = ort.SessionOptions()
    options.intra_op_num_threads, options.log_severity_level = 1, 3
    session = ort.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])
    found: list[np.ndarray] = session.run(names, feeds)
    return found


def operators(model: onnx.ModelProto) -> Counter[str]:
    return Counter(node.op_type for node in model.graph.node)


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> TinySources:
    return tiny_sources(tmp_path_factory.mktemp("checkpoints"))


@pytest.fixture(scope="module")
def exact(sources: TinySources) -> onnx.ModelProto:
    return trace(sources.source("tmr_text").module, TMR_TEXT)


def feeds_of(sources: TinySources) -> dict[str, np.ndarray]:
    """Three rows, two of them with padding, whose ids must not matter."""
    feeds = sources.sentences(3, 11, 5)
    feeds["attention_mask"][1, 7:], feeds["attention_mask"][2, 2:] = 0, 0
    return feeds


def test_joined_attention_gives_the_same_numbers(sources: TinySources, exact: onnx.ModelProto) -> None:
    joined = onnx.ModelProto.FromString(exact.SerializeToString())
    join_attention(joined)
    before, after = operators(exact), operators(joined)
    assert after["MultiHeadAttention"] == 2  # the sentence encoder's layer, and the first of the head's two
    assert after["Softmax"] == before["Softmax"] - 2
    feeds = feeds_of(sources)
    shown = feeds["attention_mask"].astype(bool)
    for name, found, expected in zip(NAMES, run(joined, feeds, NAMES), run(exact, feeds, NAMES), strict=True):
        rows = shown if name == "token_features" else slice(None)
        np.testing.assert_allclose(found[rows], expected[rows], atol=2e-6, err_msg=name)


def test_attention_without_a_mask_of_keys_is_left_alone(sources: TinySources) -> None:
    source = sources.source("latent_denoiser")
    model = trace(source.module, source.spec)
    before = model.SerializeToString(deterministic=True)
    join_attention(model)
    assert model.SerializeToString(deterministic=True) == before


def test_a_fused_graph_gives_the_same_bits_and_is_the_same_file_again(sources: TinySources) -> None:
    source = sources.source("tmr_motion")
    choice = CHOICES["tmr_motion"]
    assert choice is not None
    model = trace(source.module, TMR_MOTION)
    done = quantise(model, choice)
    assert quantise(model, choice).SerializeToString(deterministic=True) == done.SerializeToString(deterministic=True)
    assert fused(done).SerializeToString(deterministic=True) == done.SerializeToString(deterministic=True)
    assert operators(done)["DynamicQuantizeMatMul"] > 0
    assert operators(done)["MatMulInteger"] == 0
    assert {opset.domain for opset in done.opset_import} == {"", "com.microsoft"}
    assert [value.name for value in done.graph.input] == [tensor.name for tensor in TMR_MOTION.inputs]
    onnx.checker.check_model(done)


def test_outputs_that_are_switched_off_come_without_rows(sources: TinySources, exact: onnx.ModelProto) -> None:
    model, feeds = with_switch(exact, TMR_TEXT), feeds_of(sources)
    onnx.checker.check_model(model, full_check=True)
    expected = run(exact, feeds, NAMES)
    for found, wanted in zip(run(model, feeds | {"embed": np.array(True)}, NAMES), expected, strict=True):
        np.testing.assert_array_equal(found, wanted)
    off = run(model, feeds | {"embed": np.array(False)}, NAMES)
    assert [array.shape for array in off[:2]] == [(0, 256), (0, 256)]
    for found, wanted in zip(off[2:], expected[2:], strict=True):
        np.testing.assert_array_equal(found, wanted)


def test_what_is_switched_off_is_not_computed(exact: onnx.ModelProto) -> None:
    """Nothing of the head is left outside of its branch, and nothing of the sentence encoder is in it."""
    model = with_switch(exact, TMR_TEXT)
    choose = model.graph.node[-1]
    assert choose.op_type == "If"
    branch = next(attribute.g for attribute in choose.attribute if attribute.name == "then_branch")
    inside, outside = [n.name for n in branch.node], [n.name for n in model.graph.node[:-1]]
    assert not [name for name in inside if name.startswith("/sentences/layers")]
    assert not [name for name in outside if name.startswith("/encoder/layers")]
    assert len(inside) + len(outside) == len(exact.graph.node)


def test_the_switch_is_an_input_and_no_initializer_of_which_onnxruntime_would_warn(exact: onnx.ModelProto) -> None:
    session = ort.InferenceSession(with_switch(exact, TMR_TEXT).SerializeToString(), providers=["CPUExecutionProvider"])
    assert [value.name for value in session.get_inputs()] == ["input_ids", "attention_mask", "embed"]
    assert session.get_overridable_initializers() == []


def test_a_weight_that_both_sides_read_stays_outside() -> None:
    x, kept, gone = (helper.make_tensor_value_info(n, TensorProto.FLOAT, ["b", 3]) for n in ("x", "kept", "gone"))
    nodes = [
        helper.make_node("Mul", ["x", "w"], ["kept"]),
        helper.make_node("Add", ["kept", "w"], ["sum"]),
        helper.make_node("Mul", ["sum", "own"], ["gone"]),
    ]
    weights = {"w": np.array([1, 2, 3], np.float32), "own": np.array([2, 2, 2], np.float32)}
    tensors = [numpy_helper.from_array(value, name) for name, value in weights.items()]
    graph = helper.make_graph(nodes, "both", [x], [kept, gone], tensors)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=10)
    made, feeds = switched(model, "more", ("gone",)), {"x": np.ones((2, 3), np.float32)}
    assert [tensor.name for tensor in made.graph.initializer] == ["w"]
    assert run(made, feeds | {"more": np.array(True)}, ["gone"])[0].tolist() == [[4, 8, 12]] * 2
    assert run(made, feeds | {"more": np.array(False)}, ["gone"])[0].shape == (0, 3)


def test_blocks_say_nothing_that_the_oldest_supported_onnxruntime_does_not_know() -> None:
    known = {"K", "N", "bits", "block_size", "accuracy_level"}  # of MatMulNBits in onnxruntime 1.22
    weight = np.random.default_rng(0).standard_normal((128, 64)).astype(np.float32)
    model = helper.make_model(
        helper.make_graph(
            [helper.make_node("MatMul", ["x", "w"], ["y"], name="/hear/MatMul")],
            "blocks",
            [helper.make_tensor_value_info("x", TensorProto.FLOAT, ["rows", 128])],
            [helper.make_tensor_value_info("y", TensorProto.FLOAT, ["rows", 64])],
            [numpy_helper.from_array(weight, "w")],
        ),
        opset_imports=[helper.make_opsetid("", 18)],
        ir_version=10,
    )
    blocks(model, ["/hear/MatMul"], block=128)
    (node,) = (node for node in fused(model).graph.node if node.op_type == "MatMulNBits")
    assert {attribute.name for attribute in node.attribute} <= known
