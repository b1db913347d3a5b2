"""How far every benchmark is from what the machine can do: its multiply-adds and weights against the measured peaks."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from contextlib import closing
from typing import Any

from motionrt.bench.answering import answered
from motionrt.bench.cases import chosen
from motionrt.bench.nodes import Work
from motionrt.bench.peaks import machine_peaks
from motionrt.bench.profiling import BenchmarkWork, benchmark_work
from motionrt.bench.search import search_case
from motionrt.bench.setting import Setting
from motionrt.bench.workload import SIZES, Workload
from motionrt.models.tmr import DIMENSION

WITHOUT = ("cold", "models", "gallery")  # not one thing, or mostly files
CACHED_MB = 16.0  # what stays in the caches of a small server between two calls
Row = dict[str, Any]


def limits(
    models: str | None,
    threads: int,
    variant: str | None = None,
    only: Sequence[str] | None = None,
    sizes: Sequence[int] = SIZES,
    seconds: float = 1.0,
) -> dict[str, Any]:
    """The machine's peaks; for every benchmark that multiplies in a model its multiply-adds (10^6), the bytes of its
    weights (10^6) and the least milliseconds that both could take, of one unit of the first case.

    Weights are read once for every call of a model: from memory where one call reads more than ``CACHED_MB``, else
    from the cache. A benchmark cannot be faster than the slower of the two, even if they overlap completely.
    """
    peaks = machine_peaks(threads, 0.3 * seconds)
    with closing(Setting(models, threads, Workload.standard((10_000,)))) as setting:
        benchmarks = [
            name
            for name, benchmark in chosen(only).items()
            if benchmark.models and not setting.missing(benchmark.models)
        ]
    rows = [
        limit_row(benchmark_work(name, models, threads, variant, seconds), peaks, name)
        for name in benchmarks
        if name not in WITHOUT
    ]
    searches = [search_row(size, peaks) for size in sizes] if "search" in chosen(only) else []
    return {"peaks": peaks, "benchmarks": rows + searches}


def limit_row(work: BenchmarkWork, peaks: Mapping[str, Mapping[str, float]], benchmark: str = "") -> Row:
    """One benchmark against the peaks; times are those of one unit of its case."""
    total = work.all
    sums_s = total.macs_fp32 / 1e9 / max(peaks["fp32_gmacs"].values())
    sums_s += total.macs_int8 / 1e9 / max(peaks["int8_gmacs"].values())
    reads_s = sum(_read_s(each, peaks["read_gbs"]) for each in work.models.values())
    scale = 1000 / work.units
    return {
        "benchmark": benchmark,
        "case": work.case,
        "macs_fp32_m": total.macs_fp32 / 1e6 / work.units,
        "macs_int8_m": total.macs_int8 / 1e6 / work.units,
        "weights_mb": total.weight_bytes / 1e6 / work.units,
        "sums_ms": sums_s * scale,
        "reads_ms": reads_s * scale,
        "limit_ms": max(sums_s, reads_s) * scale,
        "models_ms": total.run_seconds * scale,
    }


def search_row(size: int, peaks: Mapping[str, Mapping[str, float]]) -> Row:
    """A search of so many vectors, as if a byte for each of their numbers were enough to find the nearest."""
    numbers = float(size * DIMENSION)
    found = Work(macs_int8=numbers, weight_bytes=numbers, runs=1)
    return limit_row(BenchmarkWork(search_case(size), 1, 0.0, {"search": found}), peaks, "search")


def _read_s(work: Work, read_gbs: Mapping[str, float]) -> float:
    """Seconds to read a model's weights, as often as it was called."""
    cached = work.weight_bytes <= CACHED_MB * 1e6 * work.runs
    return work.weight_bytes / 1e9 / read_gbs["cache" if cached else "memory"]


def against_times(rows: Sequence[Row], cases: Sequence[Mapping[str, Any]]) -> list[Row]:
    """The rows whose case was timed, too: with ``p50_ms``, and ``times_limit``, how many times the limit that is."""
    p50 = {case["case"]: case["p50_ms"] for case in cases}
    return [
        {**row, "p50_ms": p50[row["case"]], "times_limit": p50[row["case"]] / row["limit_ms"]}
        for row in rows
        if row["case"] in p50 and row["limit_ms"] > 0
    ]


def main(arguments: Sequence[str] = tuple(sys.argv[1:])) -> int:
    """Limits for the arguments of the command line."""
    return answered(limits, arguments)


if __name__ == "__main__":
    sys.exit(main())
