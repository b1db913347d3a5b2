"""Fair timing: contenders take turns, so that a busy moment of the machine hits them all."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

Call = Callable[[], object]
TURN_S = 1.0  # after which no further call of a turn is begun
PAUSE_S = 0.005  # lets threads that spin after their work go to sleep before the next contender runs


@dataclass(frozen=True)
class Case:
    """A call that is timed.

    Attributes:
        call: what is timed.
        units: how many characters or frames one call serves; times are given for one of them.
        slow: takes a second or more, and is called less often.
    """

    call: Call
    units: int = 1
    slow: bool = False


@dataclass(frozen=True)
class Timing:
    """Times in milliseconds, of a call or a unit of it: median, 95th percentile, and how many calls were timed."""

    p50_ms: float
    p95_ms: float
    runs: int

    @classmethod
    def of(cls, seconds: list[float], units: int = 1) -> Timing:
        """Summarise times of calls that serve so many units each."""
        p50, p95 = np.percentile(np.array(seconds) * 1000 / units, [50, 95])
        return cls(float(p50), float(p95), len(seconds))


def interleaved(contenders: Mapping[str, Call], rounds: int, calls: int, units: int = 1) -> dict[str, Timing]:
    """Time contenders in turn: ``rounds`` times, each makes one call to warm up and then ``calls`` timed
    ones, of which each serves ``units``; a turn that takes long is over after a second.
    """
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    for _ in range(rounds):
        for name, call in contenders.items():
            time.sleep(PAUSE_S)
            call()
            seconds[name] += _turn(call, calls)
    return {name: Timing.of(values, units) for name, values in seconds.items()}


def _turn(call: Call, calls: int) -> list[float]:
    seconds = [_timed(call)]
    while len(seconds) < calls and sum(seconds) < TURN_S:
        seconds.append(_timed(call))
    return seconds


def _timed(call: Call) -> float:
    started = time.perf_counter()
    call()
    return time.perf_counter() - started
