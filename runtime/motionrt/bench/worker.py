"""One benchmark process: everything at one thread count, printed as JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from typing import Any

from motionrt.bench.rivals import Rival, open_rival
from motionrt.bench.timing import interleaved
from motionrt.bench.workload import Workload, own_cases
from motionrt.errors import MotionRTError
from motionrt.runtime import Runtime

OURS = "motionrt"


def measure(models: str | None, threads: int, against: str | None, rounds: int, calls: int) -> dict[str, Any]:
    """p50 and p95 of every case, with the rival's beside them where it has the case."""
    work = Workload.standard()
    rival = open_rival(against, work, threads, models) if against else Rival({})
    cases = []
    for name, call in own_cases(Runtime(models, threads=threads), work).items():
        contenders = {OURS: call}
        if against and name in rival.cases:
            contenders[against] = rival.cases[name]
        timings = interleaved(contenders, rounds, calls)
        row: dict[str, Any] = {"case": name, **asdict(timings[OURS])}
        if against in timings:
            other = timings[against or ""]
            row["against"] = {"name": against, **asdict(other), "ratio": other.p50_ms / timings[OURS].p50_ms}
        cases.append(row)
    return {"cases": cases, "rival_cold_start": list(rival.cold_start) if rival.cold_start else None}


def main() -> int:
    """Read the arguments as JSON from the command line, print the result as JSON."""
    try:
        print(json.dumps(measure(**json.loads(sys.argv[1]))))
    except MotionRTError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
