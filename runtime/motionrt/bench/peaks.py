"""What the machine can do at best: matrix products through onnxruntime, and reading and copying memory."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from motionrt.bench.onnx_bytes import FLOAT, INT32, UINT8, product_model
from motionrt.models.engine import open_session
from motionrt.models.sessions import quiet_options

SHAPES: dict[str, tuple[int, int, int]] = {
    "large": (512, 1024, 1024),
    "a walk's tokens": (8, 512, 1024),
    "a sentence": (16, 384, 1536),
    "a motion": (52, 256, 1024),
}
"""Rows, depth and columns of products: one that shows the peak, and some that the models have."""

PLACES = {"cache": 8, "memory": 256}  # where so many MB lie after they were used
Rates = dict[str, float]


def machine_peaks(threads: int, seconds: float = 0.3) -> dict[str, Rates]:
    """The best that was seen in so many seconds for each: ``fp32_gmacs`` and ``int8_gmacs`` (10^9 multiply-adds a
    second by shape), ``read_gbs`` and ``copy_gbs`` (10^9 bytes a second, copies counted twice, in cache and in memory).
    """
    return {
        "fp32_gmacs": {name: _product(shape, threads, seconds, integer=False) for name, shape in SHAPES.items()},
        "int8_gmacs": {name: _product(shape, threads, seconds, integer=True) for name, shape in SHAPES.items()},
        "read_gbs": {name: _memory(mb, threads, seconds, copy=False) for name, mb in PLACES.items()},
        "copy_gbs": {name: _memory(mb, threads, seconds, copy=True) for name, mb in PLACES.items()},
    }


def _product(shape: tuple[int, int, int], threads: int, seconds: float, *, integer: bool) -> float:
    rows, depth, columns = shape
    chance = np.random.default_rng(0)
    if integer:
        weight = chance.integers(-64, 65, (depth, columns), np.int8)
        given = chance.integers(0, 256, (rows, depth), np.uint8)
        model = product_model("MatMulInteger", rows, weight, UINT8, INT32)
    else:
        weights = chance.standard_normal((depth, columns), np.float32)
        given = chance.standard_normal((rows, depth), np.float32)
        model = product_model("MatMul", rows, weights, FLOAT, FLOAT)
    session = open_session(model, quiet_options(threads))
    feeds = {"a": given}
    return rows * depth * columns / 1e9 / _best(lambda: session.run(None, feeds), seconds)


def _memory(mb: int, threads: int, seconds: float, *, copy: bool) -> float:
    """Every thread has a part of its own."""
    parts = [np.ones(mb * 1_000_000 // 8 // threads) for _ in range(threads)]
    others = [np.empty_like(part) for part in parts] if copy else parts
    with ThreadPoolExecutor(threads) as pool:

        def once() -> object:
            return list(pool.map(np.copyto, others, parts)) if copy else list(pool.map(np.max, parts))

        return (2 if copy else 1) * mb / 1000 / _best(once, seconds)


def _best(call: Callable[[], object], seconds: float) -> float:
    """The shortest time of a call, the first one apart."""
    call()
    best, end = float("inf"), time.perf_counter() + seconds
    while (started := time.perf_counter()) < end or best == float("inf"):
        call()
        best = min(best, time.perf_counter() - started)
    return best
