"""Fair timing: contenders take turns, so that a busy moment of the machine hits them all."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

Call = Callable[[], object]
PAUSE_S = 0.005  # lets threads that spin after their work go to sleep before the next contender runs


@dataclass(frozen=True)
class Timing:
    """Times of one call in milliseconds: median, 95th percentile, and how many calls were timed."""

    p50_ms: float
    p95_ms: float
    runs: int

    @classmethod
    def of(cls, seconds: list[float]) -> Timing:
        """Summarise times of single calls."""
        p50, p95 = np.percentile(np.array(seconds) * 1000, [50, 95])
        return cls(float(p50), float(p95), len(seconds))


def interleaved(contenders: Mapping[str, Call], rounds: int, calls: int) -> dict[str, Timing]:
    """Time contenders in turn: ``rounds`` times, each makes one call to warm up and then ``calls`` timed
    ones.
    """
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    for _ in range(rounds):
        for name, call in contenders.items():
            time.sleep(PAUSE_S)
            call()
            seconds[name] += [_timed(call) for _ in range(calls)]
    return {name: Timing.of(values) for name, values in seconds.items()}


def _timed(call: Call) -> float:
    started = time.perf_counter()
    call()
    return time.perf_counter() - started
