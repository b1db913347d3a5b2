"""Fair timing: contenders take turns and cases are shuffled, so that a busy moment of the machine hits them all."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

Call = Callable[[], object]
TURN_S, WARM_S = 0.5, 0.25  # after which no further call of a turn, or of its warming up, is begun
SLOW_ROUNDS = 3
PAUSE_S = 0.005  # lets threads that spin after their work go to sleep before the next contender runs


@dataclass(frozen=True)
class Case:
    """A call that is timed.

    Attributes:
        call: what is timed.
        units: how many characters, clips or frames one call serves; times are given for one of them.
        slow: takes a good part of a second or more, and is called less often.
    """

    call: Call
    units: int = 1
    slow: bool = False


@dataclass(frozen=True)
class Contest:
    """A case and everybody who does it, by name."""

    contenders: Mapping[str, Call]
    units: int = 1
    slow: bool = False


@dataclass(frozen=True)
class Turns:
    """How contenders take turns.

    Attributes:
        rounds: how often all cases come round, in another order every time.
        calls: timed calls of a turn, fewer where they take long.
        warm: untimed calls before them, which fill the caches with the contender's own weights again.
        seed: of the order of the cases.
    """

    rounds: int = 10
    calls: int = 10
    warm: int = 2
    seed: int = 0

    def strict(self) -> Turns:
        """Call by call instead of turn by turn: every call finds the caches as the others left them."""
        return Turns(self.rounds * self.calls, 1, 0, self.seed)


@dataclass(frozen=True)
class Timing:
    """Times in milliseconds of a call or a unit of it: the median over turns of their medians, the 95th percentile
    of all calls, and how many calls were timed.
    """

    p50_ms: float
    p95_ms: float
    runs: int

    @classmethod
    def of(cls, turns: Sequence[Sequence[float]], units: int = 1) -> Timing:
        """Summarise the seconds of every turn's calls, which serve so many units each."""
        every = np.concatenate([np.asarray(turn, float) for turn in turns])
        middle = np.median([np.median(turn) for turn in turns])
        scale = 1000 / units
        return cls(float(middle * scale), float(np.percentile(every, 95) * scale), len(every))


def timed(contests: Mapping[str, Contest], turns: Turns) -> dict[str, dict[str, Timing]]:
    """Times of every case and contender.

    Every round goes through all cases in random order; in each the contenders make their turns one after the other,
    beginning with another one every round. Slow cases take part in the first three rounds.
    """
    shuffled = random.Random(turns.seed)
    found: dict[str, dict[str, list[list[float]]]] = {
        case: {name: [] for name in contest.contenders} for case, contest in contests.items()
    }
    for number in range(turns.rounds):
        for case in shuffled.sample(list(contests), len(contests)):
            contest = contests[case]
            if contest.slow and number >= SLOW_ROUNDS:
                continue
            for name in _from(list(contest.contenders), number):
                warm, calls = (min(turns.warm, 1), 1) if contest.slow else (turns.warm, turns.calls)
                found[case][name].append(_turn(contest.contenders[name], warm, calls))
    return {
        case: {name: Timing.of(lists, contests[case].units) for name, lists in of_case.items()}
        for case, of_case in found.items()
    }


def _from(names: list[str], number: int) -> list[str]:
    first = number % len(names)
    return names[first:] + names[:first]


def _turn(call: Call, warm: int, calls: int) -> list[float]:
    time.sleep(PAUSE_S)
    _repeated(call, warm, WARM_S)
    return _repeated(call, calls, TURN_S)


def _repeated(call: Call, times: int, limit_s: float) -> list[float]:
    seconds: list[float] = []
    while len(seconds) < times and sum(seconds) < limit_s:
        started = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - started)
    return seconds
