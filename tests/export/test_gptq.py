"""Rounding whose errors make up for each other: against GPTQ's formula, every rounding there is, and the nearest."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from onnx import TensorProto, helper, numpy_helper  # noqa: E402

from motionrt_export.calibration import MORE_SENTENCES, SENTENCES  # noqa: E402
from motionrt_export.gptq import DAMPING, input_products, rounded  # noqa: E402
from motionrt_export.optimise import Quantisation, quantise  # noqa: E402
from motionrt_export.quantise import LIMIT, product_names  # noqa: E402

RNG = np.random.default_rng(5)
MIX = RNG.normal(size=(24, 24)) * RNG.uniform(0.2, 3, size=24)
X = (RNG.normal(size=(300, 24)) @ MIX).astype(np.float32)  # channels that go together
WEIGHT = RNG.normal(size=(24, 10)).astype(np.float32)


def product() -> onnx.ModelProto:
    node = helper.make_node("MatMul", ["x", "w"], ["y"], name="/part/MatMul")
    x, y = (helper.make_tensor_value_info(n, TensorProto.FLOAT, ["n", None]) for n in "xy")
    graph = helper.make_graph([node], "g", [x], [y], [numpy_helper.from_array(WEIGHT, "w")])
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=10)


def weight_of(model: onnx.ModelProto) -> np.ndarray:
    kept = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    whole, zero = (kept[name].astype(np.float64) for name in ("w.int8", "w.channel_zero"))
    assert np.abs(whole).max() <= LIMIT
    return np.asarray((whole - zero) * kept["w.channel_scale"])


def cost(result: np.ndarray, target: np.ndarray, products: np.ndarray) -> float:
    return float(np.einsum("io,ij,jo->", result - target, products, result - target))


def by_the_paper(target: np.ndarray, products: np.ndarray, low: float, high: float) -> np.ndarray:
    """Algorithm 1 of GPTQ: the Cholesky factor of the inverse, what matters most first."""
    order = np.argsort(-np.diag(products), kind="stable")
    damped = products[np.ix_(order, order)] + DAMPING * np.diag(products).mean() * np.eye(len(products))
    factor = np.linalg.cholesky(np.linalg.inv(damped)).T
    wanted, result = target[order].copy(), np.empty_like(target)
    for i, row in enumerate(order):
        result[row] = np.clip(np.rint(wanted[i]), low, high)
        wanted[i:] -= np.outer(factor[i, i:], (wanted[i] - result[row]) / factor[i, i])
    return result


def test_it_is_gptq() -> None:
    products = X.T.astype(np.float64) @ X
    target = RNG.normal(size=(24, 150)) * 20
    np.testing.assert_array_equal(rounded(target, products, -64, 64), by_the_paper(target, products, -64, 64))


def test_one_output_comes_near_the_best_of_all_roundings() -> None:
    products, target = X[:, :6].T.astype(np.float64) @ X[:, :6], RNG.normal(size=(6, 1)) * 5
    choices = itertools.product(*(np.floor(value) + np.arange(-1, 3) for value in target[:, 0]))
    best = min(cost(np.array(choice)[:, None], target, products) for choice in choices)
    found = cost(rounded(target, products, -64, 64), target, products)
    nearest = cost(np.rint(target), target, products)
    assert best <= found < nearest
    assert found - best < 0.5 * (nearest - best)


def test_without_anything_in_common_it_is_the_nearest() -> None:
    target = RNG.uniform(-60, 60, size=(24, 10))
    np.testing.assert_array_equal(rounded(target, np.diag(RNG.uniform(1, 9, size=24)), -64, 64), np.rint(target))


def test_whole_numbers_stay_in_their_range() -> None:
    found = rounded(RNG.normal(size=(24, 10)) * 90, X.T.astype(np.float64) @ X, -64, 64)
    assert found.min() == -64
    assert found.max() == 64


def test_products_are_those_of_the_inputs() -> None:
    model = product()
    found = input_products(model, product_names(model), [{"x": X[:100]}, {"x": X[100:]}])
    np.testing.assert_allclose(found["x"], X.T.astype(np.float64) @ X, rtol=1e-3, atol=0.05)


def test_outputs_are_nearer_than_with_the_nearest_weights_and_twice_the_same() -> None:
    model, choice, feeds = product(), Quantisation(), [{"x": X}]
    compensated = replace(choice, compensated=("/part/",))
    nearest, found, again = (quantise(model, one, feeds) for one in (choice, compensated, compensated))
    error, before = (np.linalg.norm(X @ (weight_of(one) - WEIGHT)) for one in (found, nearest))
    assert error < 0.8 * before
    assert found.SerializeToString(deterministic=True) == again.SerializeToString(deterministic=True)
    assert "part: rounded by GPTQ" in compensated.describe()


def test_calibration_and_the_captions_that_judge_it_have_nothing_in_common() -> None:
    from motionrt.retrieval.captions import read_captions
    from motionrt.services.search import DEFAULT_CAPTIONS

    known = [sentence.lower() for sentence in (*SENTENCES, *MORE_SENTENCES)]
    assert len({*known}) == len(known)
    assert not {*known} & {caption.lower() for caption in read_captions(DEFAULT_CAPTIONS)}
