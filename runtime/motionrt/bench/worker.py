"""One benchmark process: everything at one thread count, printed as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from motionrt.bench.rivals import Rival, open_rival
from motionrt.bench.roads import COLD, Setting, chosen
from motionrt.bench.timing import Case, interleaved
from motionrt.bench.workload import Workload
from motionrt.errors import MotionRTError, ReachError, WalkError

OURS = "motionrt"
SLOW_ROUNDS = 3


def measure(
    models: str | None, threads: int, against: str | None, rounds: int, calls: int, only: Sequence[str] | None = None
) -> dict[str, Any]:
    """p50 and p95 of every case of the roads, with the rival's beside them where it has the case.

    Roads whose models the manifest does not hold are left out, and so are those whose models cannot do it.
    """
    setting = Setting(models, threads, Workload.standard())
    rival = open_rival(against, setting.work, threads, models) if against else Rival({})
    cases: list[dict[str, Any]] = []
    left_out: dict[str, str] = {}
    for name, road in chosen(only).items():
        if missing := setting.missing(road.models):
            left_out[name] = f"no model {', '.join(missing)}"
            continue
        try:
            found = road.cases(setting)
        except (WalkError, ReachError) as error:
            left_out[name] = str(error)
            continue
        cases += [_timed(label, case, against, rival, rounds, calls) for label, case in found.items()]
    cold = rival.cold_start if COLD in chosen(only) and COLD not in left_out else None
    return {"cases": cases, "left_out": left_out, "rival_cold_start": list(cold) if cold else None}


def _timed(name: str, case: Case, against: str | None, rival: Rival, rounds: int, calls: int) -> dict[str, Any]:
    contenders = {OURS: case.call}
    if against and name in rival.cases:
        contenders[against] = rival.cases[name]
    if case.slow:
        rounds, calls = min(rounds, SLOW_ROUNDS), 1
    timings = interleaved(contenders, rounds, calls, case.units)
    row: dict[str, Any] = {"case": name, "units": case.units, **asdict(timings[OURS])}
    if against in timings:
        other = timings[against or ""]
        row["against"] = {"name": against, **asdict(other), "ratio": other.p50_ms / timings[OURS].p50_ms}
    return row


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
