"""The machine's peaks, what benchmarks multiply and read, and how both are set against each other."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tiny_models import TINY, TINY_GENERATORS

from motionrt.bench import peaks
from motionrt.bench.limits import against_times, limit_row, limits, search_row
from motionrt.bench.nodes import Work, read_work, work_of
from motionrt.bench.onnx_bytes import FLOAT, INT32, UINT8, product_model
from motionrt.bench.peaks import SHAPES, machine_peaks
from motionrt.bench.profiling import BenchmarkWork, benchmark_work, profile
from motionrt.bench.workload import TEXTS
from motionrt.errors import InvalidInputError
from motionrt.models.sessions import quiet_options
from motionrt.text import clauses

PEAKS = {
    "fp32_gmacs": {"large": 50.0, "small": 10.0},
    "int8_gmacs": {"large": 200.0, "small": 20.0},
    "read_gbs": {"cache": 60.0, "memory": 20.0},
}


def answer_of(model: bytes, given: np.ndarray) -> np.ndarray:
    """What onnxruntime makes of a model that was written byte by byte."""
    import onnxruntime

    session = onnxruntime.InferenceSession(model, quiet_options(1), providers=["CPUExecutionProvider"])
    return np.asarray(session.run(None, {"a": given})[0])


def test_a_model_of_bytes_multiplies_as_numpy_does() -> None:
    chance = np.random.default_rng(0)
    given, weight = chance.normal(size=(3, 40)).astype(np.float32), chance.normal(size=(40, 300)).astype(np.float32)
    found = answer_of(product_model("MatMul", 3, weight, FLOAT, FLOAT), given)
    np.testing.assert_allclose(found, given @ weight, rtol=1e-4, atol=1e-4)


def test_a_model_of_bytes_multiplies_integers_exactly() -> None:
    chance = np.random.default_rng(1)
    given, weight = chance.integers(0, 256, (5, 129), np.uint8), chance.integers(-64, 65, (129, 7), np.int8)
    found = answer_of(product_model("MatMulInteger", 5, weight, UINT8, INT32), given)
    np.testing.assert_array_equal(found, given.astype(np.int32) @ weight.astype(np.int32))


def test_every_peak_of_the_machine_is_a_positive_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peaks, "PLACES", {"cache": 1, "memory": 2})
    found = machine_peaks(1, seconds=0.001)
    assert set(found) == {"fp32_gmacs", "int8_gmacs", "read_gbs", "copy_gbs"}
    assert set(found["fp32_gmacs"]) == set(found["int8_gmacs"]) == set(SHAPES)
    assert all(rate > 0 for rates in found.values() for rate in rates.values())


def node(operator: str, given: list[list[int]], made: list[int], **more: Any) -> dict[str, Any]:
    """An event as onnxruntime writes it."""
    arguments = {
        "op_name": operator,
        "input_type_shape": [{"float": shape} for shape in given],
        "output_type_shape": [{"float": made}],
        **more,
    }
    return {"cat": "Node", "name": f"{operator}_kernel_time", "dur": 1000, "args": arguments}


def test_products_are_counted_by_their_shapes() -> None:
    events = [
        {"cat": "Session", "name": "model_run", "dur": 9000},
        node("DynamicQuantizeMatMul", [[1, 52, 256], [768]], [1, 52, 768], parameter_size="3072"),  # packed weights
        node("MatMul", [[1, 4, 52, 64], [1, 4, 64, 52]], [1, 4, 52, 52], parameter_size="0"),  # two activations
        node("Gemm", [[1, 8], [8, 4], [4]], [1, 4], parameter_size="144"),  # weights that were not packed
        node("Gather", [[30522, 384], [1, 16]], [1, 16, 384], parameter_size="11720448", output_size="24576"),
        node("Add", [[1, 8], [8]], [1, 8], parameter_size="32"),
    ]
    found = work_of(events)
    assert found.macs_int8 == 52 * 256 * 768
    assert found.macs_fp32 == 4 * 52 * 64 * 52 + 8 * 4
    assert found.weight_bytes == (256 * 768 + 3072) + 144 + 24576 + 32
    assert found.seconds["DynamicQuantizeMatMul"] == pytest.approx(0.001)
    assert (found.runs, found.run_seconds) == (1, pytest.approx(0.009))


def test_work_adds_up_and_is_shared_out() -> None:
    one = Work({"MatMul": 1.0}, 1, 10.0, 0.0, 4.0, 2.0)
    other = Work({"MatMul": 1.0, "Add": 3.0}, 3, 0.0, 20.0, 0.0, 6.0)
    assert (one + other).of_one(2) == Work({"MatMul": 1.0, "Add": 1.5}, 2, 5.0, 10.0, 2.0, 4.0)


def test_the_profile_of_a_product_counts_what_it_multiplies(tmp_path: Path) -> None:
    import onnxruntime

    options = quiet_options(1)
    options.enable_profiling, options.profile_file_prefix = True, str(tmp_path / "profile")
    model = product_model("MatMul", 6, np.ones((40, 20), np.float32), FLOAT, FLOAT)
    session = onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
    for _ in range(3):
        session.run(None, {"a": np.ones((6, 40), np.float32)})
    found = read_work(Path(session.end_profiling())).of_one(3)
    assert (found.runs, found.macs_fp32, found.macs_int8) == (1, 6 * 40 * 20, 0)
    assert found.weight_bytes == 40 * 20 * 4


def test_a_benchmark_is_held_against_the_slower_of_sums_and_reads() -> None:
    arithmetic = BenchmarkWork("case", 2, 1.0, {"m": Work({}, 1, 50e6, 200e6, 6e6, 0.004)})
    row = limit_row(arithmetic, PEAKS)
    assert (row["sums_ms"], row["reads_ms"]) == (pytest.approx(1.0), pytest.approx(0.05))  # of one unit of two
    assert row["limit_ms"] == row["sums_ms"]
    assert row["models_ms"] == pytest.approx(2.0)


def test_weights_of_many_small_calls_come_from_the_cache_and_those_of_one_large_call_from_memory() -> None:
    small = limit_row(BenchmarkWork("case", 1, 1.0, {"m": Work({}, 10, 0, 0, 60e6)}), PEAKS)
    large = limit_row(BenchmarkWork("case", 1, 1.0, {"m": Work({}, 1, 0, 0, 60e6)}), PEAKS)
    assert (small["reads_ms"], large["reads_ms"]) == (pytest.approx(1.0), pytest.approx(3.0))


def test_a_search_reads_a_byte_for_every_number() -> None:
    row = search_row(1_000_000, PEAKS)
    assert (row["case"], row["weights_mb"]) == ("search 1,000,000", 256.0)
    assert row["limit_ms"] == pytest.approx(256e6 / 20e9 * 1000)


def test_limits_are_told_of_what_was_timed_only() -> None:
    rows = [{"case": "a", "limit_ms": 2.0}, {"case": "b", "limit_ms": 1.0}, {"case": "c", "limit_ms": 0.0}]
    found = against_times(rows, [{"case": "a", "p50_ms": 5.0}, {"case": "c", "p50_ms": 1.0}])
    assert found == [{"case": "a", "limit_ms": 2.0, "p50_ms": 5.0, "times_limit": 2.5}]


def test_a_benchmark_is_profiled_model_by_model() -> None:
    found = benchmark_work("text", str(TINY), 1, seconds=0.01)
    assert found.case == "text encoding"
    assert {name: work.runs for name, work in found.models.items()} == {"tmr_student": 1}
    full = benchmark_work("full-text", str(TINY), 1, seconds=0.01)
    assert full.case == "text encoding, full tower"
    assert {name for name, work in full.models.items() if work.runs} == {"tmr_text"}
    assert found.all.weight_bytes > 0
    assert "Mul" in found.all.seconds
    assert 0 < found.all.run_seconds < found.wall_s


def test_the_denoiser_of_a_motion_runs_twelve_times_for_each_act_of_its_text() -> None:
    acts = len(clauses(TEXTS[0]))
    runs = benchmark_work("generate", str(TINY_GENERATORS), 1, seconds=0.0).models["motion_denoiser"].runs
    assert (acts, runs) == (2, 24)


def test_a_profile_is_json_and_names_functions() -> None:
    found = profile("text", str(TINY), 1)
    assert json.loads(json.dumps(found)) == found
    assert found["wall_ms"] == pytest.approx(sum(found["models_ms"].values()) + found["outside_ms"])
    assert any("encode" in each["function"] for each in found["python"])
    assert found["operators_ms"]


@pytest.mark.parametrize(
    ("benchmark", "why"), [("walk", "walknet"), ("cold", "many things"), ("swim", "no benchmark is called")]
)
def test_benchmarks_that_cannot_be_profiled_say_why(benchmark: str, why: str) -> None:
    with pytest.raises(InvalidInputError, match=why):
        benchmark_work(benchmark, str(TINY), 1)


def test_limits_of_the_tiny_models() -> None:
    found = limits(str(TINY), 1, only=["text", "motion", "search", "walk"], sizes=(1000,), seconds=0.005)
    assert [row["benchmark"] for row in found["benchmarks"]] == ["text", "motion", "search"]
    assert all(row["limit_ms"] > 0 for row in found["benchmarks"])
