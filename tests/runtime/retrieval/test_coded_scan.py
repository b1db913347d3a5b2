"""The scan in few bits never changes an answer: against plain float32 and float64, on galleries made to break it."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.retrieval import coded_scan, narrow, search
from motionrt.retrieval.coded_scan import CodedScan
from motionrt.retrieval.codes import LONGEST, code_query, code_rows, padded
from motionrt.retrieval.narrow import Directions
from motionrt.retrieval.nibbles import code_nibbles
from motionrt.retrieval.search import CODED_FROM, CODED_LATE_FROM, ExactIndex, nearest_per_group

Make = Callable[[np.random.Generator, int, int], np.ndarray]


def unit(vectors: np.ndarray) -> np.ndarray:
    vectors = vectors.astype(np.float32)
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-20)


def noise(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    return unit(random.normal(size=(count, width)))


def clusters(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    return unit(noise(random, 20, width)[random.integers(0, 20, count)] + 0.02 * random.normal(size=(count, width)))


def near_duplicates(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    """Differences far below what 8 bits can tell apart."""
    return unit(noise(random, 1, width) + 1e-6 * random.normal(size=(count, width)))


def duplicates(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    return noise(random, 30, width)[random.integers(0, 30, count)]


def all_equal(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    return np.repeat(noise(random, 1, width), count, axis=0)


def spikes(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    """One large number a row makes the steps of its code coarse."""
    vectors = 0.01 * random.normal(size=(count, width))
    vectors[np.arange(count), random.integers(0, width, count)] = random.choice([-1, 1], count)
    return vectors.astype(np.float32)


def unequal_lengths(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    return (noise(random, count, width) * 10.0 ** random.uniform(-6, 6, (count, 1))).astype(np.float32)


def with_zeros(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    return noise(random, count, width) * (random.random((count, 1)) < 0.3)


def flat(random: np.random.Generator, count: int, width: int) -> np.ndarray:
    """Nearly in a subspace, but for a few that are far outside."""
    rank = max(1, width // 20)
    vectors = random.normal(size=(count, rank)) @ random.normal(size=(rank, width))
    vectors += 0.01 * random.normal(size=(count, width))
    vectors[random.random(count) < 0.01] = random.normal(size=width)
    return unit(vectors)


GALLERIES = [flat, noise, clusters, near_duplicates, duplicates, all_equal, spikes, unequal_lengths, with_zeros]


def plain_answer(vectors: np.ndarray, query: np.ndarray, k: int) -> tuple[list[int], list[float]]:
    """A stable sort of the float32 products."""
    products = np.einsum("nd,d->n", vectors, query)
    order = np.argsort(-products, kind="stable")[:k]
    return order.tolist(), products[order].tolist()


def prepared(vectors: np.ndarray, monkeypatch: pytest.MonkeyPatch, bits: int = 8) -> ExactIndex:
    """Coded at any size: in 8 bits and narrowed, or in 4 bits."""
    monkeypatch.setattr(search, "CODED_FROM", 1)
    monkeypatch.setattr(coded_scan, "NARROW_FROM", 1)
    monkeypatch.setattr(coded_scan, "NIBBLES_FROM", 1)
    monkeypatch.setattr(CodedScan, "_narrows_down", lambda _: bits == 4)
    monkeypatch.setattr(narrow, "WIDTHS", (4, 16, 64, 128) if bits == 8 else ())
    index = ExactIndex(vectors)
    index.prepare()
    return index


@pytest.mark.parametrize("bits", [8, 4])
@pytest.mark.parametrize("make", GALLERIES)
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    count=st.integers(1, 1500),
    width=st.sampled_from([1, 3, 16, 100, 255, 256]),
    k=st.integers(1, 40),
    aim=st.sampled_from([0.0, 0.05, 1.0]),
    share=st.sampled_from([1.0, 0.5, 0.05, 0.0]),
    seed=st.integers(0, 2**31),
)
def test_the_answer_is_that_of_float32_bit_for_bit(
    make: Make,
    bits: int,
    count: int,
    width: int,
    k: int,
    aim: float,
    share: float,
    seed: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(seed)
    vectors = np.ascontiguousarray(make(random, count, width), dtype=np.float32)
    query = unit(vectors[count // 2] + aim * random.normal(size=width) / width**0.5)
    allowed = random.random(count) < share
    found, scores = prepared(vectors, monkeypatch, bits).nearest(query, k, None if share == 1 else allowed)
    expected, values = plain_answer(vectors[allowed], query, k)
    assert (found.tolist(), scores.tolist()) == (np.flatnonzero(allowed)[expected].tolist(), values)


@pytest.mark.parametrize("make", [flat, noise, clusters, duplicates, spikes])
def test_few_vectors_remain_to_be_compared_and_the_best_are_among_them(make: Make) -> None:
    random = np.random.default_rng(1)
    vectors = make(random, 6000, 256)
    scan = CodedScan.build(vectors)
    assert scan is not None
    for query in noise(random, 5, 256):
        found = scan.candidates(query, 10)
        assert found is not None
        assert len(found) < 1500
        assert np.all(np.diff(found) > 0)
        assert set(plain_answer(vectors, query, 10)[0]) <= set(found.tolist())


@given(st.sampled_from(GALLERIES), st.integers(0, 2**31), st.floats(-6, 6))
@settings(max_examples=40, deadline=None)
def test_the_scan_is_as_close_to_the_float64_product_as_promised(make: Make, seed: int, size: float) -> None:
    random = np.random.default_rng(seed)
    vectors = np.ascontiguousarray(make(random, 100, 96), dtype=np.float32)
    query = (random.normal(size=96) * 10.0**size).astype(np.float32)
    memory = np.empty((100, padded(96)), dtype=np.uint8)
    codes, coded = code_rows(vectors, memory), code_query(query.astype(np.float64))
    assert codes is not None
    assert coded is not None
    assert np.abs(coded.numbers).max() == 127
    stands_for = (memory.astype(np.float64) - 128) * codes.scales[:, None]
    scanned = coded.step * (stands_for @ coded.numbers[0].astype(np.float64))
    exact = vectors.astype(np.float64) @ query.astype(np.float64)
    assert np.abs(scanned - exact).max() <= codes.error(coded)
    assert np.linalg.norm(stands_for[:, :96] - vectors, axis=1).max() <= codes.residual


@given(st.sampled_from(GALLERIES), st.integers(0, 2**31), st.sampled_from([95, 96, 256]))
@settings(max_examples=40, deadline=None)
def test_what_4_bits_miss_of_every_row_is_known(make: Make, seed: int, width: int) -> None:
    random = np.random.default_rng(seed)
    vectors = np.ascontiguousarray(make(random, 100, width), dtype=np.float32)
    query = random.normal(size=width).astype(np.float32)
    memory = np.empty((100, padded(width) // 2), dtype=np.uint8)
    codes, coded = code_nibbles(vectors, memory), code_query(query.astype(np.float64))
    assert codes is not None
    assert codes.missed is not None
    assert coded is not None
    numbers = np.stack([memory & 15, memory >> 4], axis=-1).reshape(100, -1).astype(np.float64) - 8
    assert np.abs(numbers).max() <= 7
    stands_for = numbers * codes.scales[:, None]
    assert np.all(np.linalg.norm(stands_for[:, :width] - vectors, axis=1) <= codes.missed)
    scanned = coded.step * (stands_for @ coded.numbers[0].astype(np.float64))
    exact = vectors.astype(np.float64) @ query.astype(np.float64)
    assert np.all(np.abs(scanned - exact) <= codes.error(coded) + coded.length * codes.missed)


def test_a_large_library_without_few_directions_is_scanned_in_4_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coded_scan, "NARROW_FROM", 6000)
    monkeypatch.setattr(coded_scan, "_FEW", 4)  # of so few vectors a larger share remains
    random = np.random.default_rng(11)
    vectors = noise(random, 6000, 256)
    scan = CodedScan.build(vectors)
    assert scan is not None
    assert scan.width == 128
    for query in [*vectors[:3], *noise(random, 3, 256)]:
        found = scan.candidates(query, 10)
        assert found is not None
        assert set(plain_answer(vectors, query, 10)[0]) <= set(found.tolist())


def test_vectors_that_4_bits_cannot_tell_apart_are_scanned_in_8(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coded_scan, "NARROW_FROM", 6000)
    monkeypatch.setattr(narrow, "WIDTHS", ())
    random = np.random.default_rng(12)
    vectors = unit(noise(random, 1, 256) + 0.3 / 16 * random.normal(size=(6000, 256)))
    scan = CodedScan.build(vectors)
    assert scan is not None
    assert scan.width == 256


@pytest.mark.parametrize("width", [256, 300])
def test_a_library_in_a_subspace_is_scanned_in_fewer_numbers(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(9)
    vectors = flat(random, 5000, width)
    monkeypatch.setattr(coded_scan, "NARROW_FROM", 5000)
    scan = CodedScan.build(vectors)
    assert scan is not None
    assert scan.width == 64
    for query in [*vectors[:5], *unit(vectors[5:8] + 0.2 * noise(random, 3, width)), noise(random, 1, width)[0]]:
        found = scan.candidates(query, 10)
        assert found is None or set(plain_answer(vectors, query, 10)[0]) <= set(found.tolist())
    found = scan.candidates(vectors[0], 10)
    assert found is not None
    assert len(found) < 500


def test_noise_is_not_narrowed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coded_scan, "NARROW_FROM", 1)
    scan = CodedScan.build(noise(np.random.default_rng(0), 2000, 256))
    assert scan is not None
    assert scan.width in (128, 256)  # bytes: all numbers, in 4 or 8 bits


@given(st.sampled_from(GALLERIES), st.integers(0, 2**31), st.sampled_from([0.0, 0.1, 100.0]))
@settings(max_examples=60, deadline=None)
def test_narrowed_products_are_never_below_the_float64_product(make: Make, seed: int, aside: float) -> None:
    random = np.random.default_rng(seed)
    vectors = np.ascontiguousarray(make(random, 80, 96), dtype=np.float32)
    basis = np.linalg.qr(vectors[:9].astype(np.float64).T + 1e-9 * random.normal(size=(96, 9)))[0].astype(np.float32)
    directions = Directions(basis, float(np.linalg.norm(basis.T.astype(np.float64) @ basis - np.eye(9))))
    query = (vectors[20] + aside * random.normal(size=96)).astype(np.float32).astype(np.float64)
    bound = directions.rows(vectors).astype(np.float64) @ directions.query(query)
    lengths = np.linalg.norm(vectors.astype(np.float64), axis=1)
    slack = directions.rounding(float(np.linalg.norm(query)), float(lengths.max()))
    assert np.all(vectors.astype(np.float64) @ query <= bound + slack)
    assert slack <= 1e-3 * np.linalg.norm(query) * lengths.max()


def test_the_float64_product_gives_the_same_hits() -> None:
    random = np.random.default_rng(2)
    vectors = noise(random, 30_000, 256)
    index = ExactIndex(vectors)
    index.prepare()
    for query in noise(random, 3, 256):
        found, scores = index.nearest(query, 10)
        exact = vectors.astype(np.float64) @ query.astype(np.float64)
        assert found.tolist() == np.argsort(-exact)[:10].tolist()
        np.testing.assert_allclose(scores, np.sort(exact)[::-1][:10], atol=1e-6)


def test_groups_are_searched_through_the_scan(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(3)
    vectors, group = clusters(random, 3000, 64), np.arange(3000) // 100
    query = vectors[17]
    found, scores = nearest_per_group(prepared(vectors, monkeypatch), query, 7, group)
    monkeypatch.undo()
    plain = nearest_per_group(ExactIndex(vectors), query, 7, group)
    assert (found.tolist(), scores.tolist()) == (plain[0].tolist(), plain[1].tolist())


@pytest.mark.parametrize(("count", "asked_before"), [(CODED_FROM, 1), (CODED_LATE_FROM, 32)])
def test_an_index_is_coded_when_it_is_asked_often_enough(
    count: int, asked_before: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    built: list[int] = []
    monkeypatch.setattr(CodedScan, "build", lambda vectors, _: built.append(len(vectors)))
    index = ExactIndex(np.eye(count, 8, dtype=np.float32))
    for _ in range(asked_before):
        index.nearest(np.ones(8, dtype=np.float32), 1)
    assert built == []
    for _ in range(3):  # what could not be coded is not tried again
        index.nearest(np.ones(8, dtype=np.float32), 1)
    assert built == [count]


def test_a_small_index_is_never_coded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CodedScan, "build", lambda *_: pytest.fail("coded"))
    index = ExactIndex(np.eye(CODED_FROM - 1, 8, dtype=np.float32))
    index.prepare()
    for _ in range(40):
        index.nearest(np.ones(8, dtype=np.float32), 1)


@pytest.mark.parametrize("shape", [(0, 256), (10, 257), (0, 0)])
def test_what_the_scan_cannot_hold_is_left_to_float32(shape: tuple[int, int]) -> None:
    assert CodedScan.build(np.ones(shape, dtype=np.float32)) is None
    index = ExactIndex(np.ones(shape, dtype=np.float32))
    assert index.nearest(np.ones(shape[1], dtype=np.float32), 3)[0].tolist() == list(range(min(3, shape[0])))


def test_a_machine_whose_product_saturates_is_left_to_float32(monkeypatch: pytest.MonkeyPatch) -> None:
    run = coded_scan._run
    monkeypatch.setattr(coded_scan, "_run", lambda session, numbers: np.clip(run(session, numbers), -32768, 32767))
    assert CodedScan.build(np.eye(100, 64, dtype=np.float32)) is None


def test_a_session_that_reads_the_codes_themselves_keeps_them(monkeypatch: pytest.MonkeyPatch) -> None:
    vectors = noise(np.random.default_rng(4), 500, 64)

    class Reading:
        """Scores straight from the memory that it was given, as an onnxruntime without rearranged weights would."""

        def __init__(self, codes: np.ndarray, scales: np.ndarray, *_: object) -> None:
            self.codes, self.scales = codes, scales

        def run(self, _: None, feeds: dict[str, np.ndarray]) -> list[np.ndarray]:
            return [feeds["query"] @ (self.codes.astype(np.float32) - 128).T * self.scales]

    monkeypatch.setattr(coded_scan, "_open", Reading)
    scan = CodedScan.build(vectors)
    assert scan is not None
    found = scan.candidates(vectors[7], 3)
    assert found is not None
    assert 7 in found


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 3e38])
@pytest.mark.parametrize("count", [50, CODED_FROM])
def test_vectors_that_are_not_finite_are_refused(value: float, count: int) -> None:
    vectors = noise(np.random.default_rng(5), count, 16)
    vectors[23, 3] = value
    index = ExactIndex(vectors)
    index.prepare()
    with pytest.raises(InvalidInputError, match="vector 23 is not finite"), np.errstate(all="ignore"):
        index.nearest(np.full(16, 2, dtype=np.float32), 3)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_query_that_is_not_finite_is_refused(value: float) -> None:
    query = np.ones(16, dtype=np.float32)
    query[5] = value
    with pytest.raises(InvalidInputError, match="query is not finite"):
        ExactIndex(np.eye(30, 16, dtype=np.float32)).nearest(query, 3)


@pytest.mark.parametrize("query", [np.zeros(32), np.full(32, 1e-30), np.full(32, LONGEST * 2), np.eye(32)[0] * 1e-44])
def test_queries_of_extreme_size_are_answered_as_ever(query: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    vectors, query = noise(np.random.default_rng(6), 400, 32), query.astype(np.float32)
    found, scores = prepared(vectors, monkeypatch).nearest(query, 5)
    assert (found.tolist(), scores.tolist()) == plain_answer(vectors, query, 5)


def test_many_threads_ask_one_index_at_once_while_it_is_coded() -> None:
    random = np.random.default_rng(7)
    vectors, queries = clusters(random, CODED_FROM, 64), noise(random, 60, 64)
    index = ExactIndex(vectors)
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda query: index.nearest(query, 5), queries))
    for query, (found, scores) in zip(queries, answers, strict=True):
        assert (found.tolist(), scores.tolist()) == plain_answer(vectors, query, 5)


def test_memory_mapped_and_strided_vectors_are_scanned_alike(tmp_path: Path) -> None:
    vectors = noise(np.random.default_rng(8), CODED_FROM, 48)
    np.save(tmp_path / "vectors.npy", vectors)
    mapped = np.load(tmp_path / "vectors.npy", mmap_mode="r")
    for stored in (mapped, np.asfortranarray(vectors), np.repeat(vectors, 2, axis=0)[::2], vectors.astype(np.float64)):
        index = ExactIndex(stored)
        index.prepare()
        found, scores = index.nearest(vectors[9], 6)
        assert (found.tolist(), scores.tolist()) == plain_answer(vectors, vectors[9], 6)


def test_a_coded_index_can_be_copied_and_pickled(monkeypatch: pytest.MonkeyPatch) -> None:
    vectors = noise(np.random.default_rng(10), 300, 32)
    index = prepared(vectors, monkeypatch)
    for again in (copy.deepcopy(index), pickle.loads(pickle.dumps(index))):
        assert again.nearest(vectors[4], 3)[0].tolist() == index.nearest(vectors[4], 3)[0].tolist()
