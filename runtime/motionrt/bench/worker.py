"""One benchmark process: everything at one thread count, printed as JSON."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import asdict
from typing import Any

from motionrt.bench.answering import answered
from motionrt.bench.cases import COLD, chosen
from motionrt.bench.graphs import called_with, graph_case
from motionrt.bench.rivals import Rival, open_rival
from motionrt.bench.setting import Setting
from motionrt.bench.timing import Case, Contest, Timing, Turns, timed
from motionrt.bench.workload import SIZES, Workload
from motionrt.errors import MissingDependencyError, ReachError, WalkError

OURS = "motionrt"

Rivals = Mapping[str, Rival]


def measure(
    models: str | None,
    threads: int,
    against: Sequence[str] = (),
    *,
    turns: Turns | None = None,
    strict: bool = False,
    only: Sequence[str] | None = None,
    sizes: Sequence[int] = SIZES,
    variant: str | None = None,
) -> dict[str, Any]:
    """p50 and p95 of every case of the benchmarks, with those of the rivals beside them where they have the case.

    Benchmarks whose models the manifest does not hold are left out, and so are those whose models cannot do it. With
    ``strict`` everything is timed again, call by call in turn.
    """
    how = turns or Turns()
    with closing(Setting(models, threads, Workload.standard(sizes), variant=variant)) as setting:
        rivals = {name: open_rival(name, setting.work, threads, models) for name in against}
        cases, left_out = prepared(setting, only)
        contests = {label: _contest(label, case, rivals) for label, case in cases.items()}
        timings, again = timed(contests, how), timed(contests, how.strict()) if strict else {}
        rows = [_row(label, case, timings[label], again.get(label)) for label, case in cases.items()]
        described = _graphs(setting, {row["case"] for row in rows})
    cold = {name: list(rival.cold_start) for name, rival in rivals.items() if rival.cold_start}
    asked = COLD in chosen(only) and COLD not in left_out
    return {"cases": rows, "left_out": left_out, "models": described, "rival_cold_starts": cold if asked else {}}


def prepared(setting: Setting, only: Sequence[str] | None) -> tuple[dict[str, Case], dict[str, str]]:
    """The cases of the benchmarks; and of the benchmarks that cannot run, why."""
    cases: dict[str, Case] = {}
    left_out: dict[str, str] = {}
    for name, benchmark in chosen(only).items():
        if missing := setting.missing(benchmark.models):
            left_out[name] = f"no model {', '.join(missing)}"
            continue
        try:
            cases |= benchmark.cases(setting)
        except (WalkError, ReachError, MissingDependencyError) as error:
            left_out[name] = str(error)
    return cases, left_out


def _contest(label: str, case: Case, rivals: Rivals) -> Contest:
    others = {name: rival.cases[label] for name, rival in rivals.items() if label in rival.cases}
    return Contest({OURS: case.call, **others}, case.units, case.slow)


def _row(
    label: str, case: Case, timings: Mapping[str, Timing], strict: Mapping[str, Timing] | None = None
) -> dict[str, Any]:
    row: dict[str, Any] = {"case": label, "units": case.units, **asdict(timings[OURS])}
    row["against"] = {
        name: {**asdict(timing), "ratio": timing.p50_ms / timings[OURS].p50_ms}
        for name, timing in timings.items()
        if name != OURS
    }
    if strict is not None:
        row["strict"] = _row(label, case, strict)
    return row


def _graphs(setting: Setting, measured: set[str]) -> dict[str, str]:
    """The models that were measured alone, with what they were called with."""
    models = setting.manifest.models
    return {name: called_with(model) for name, model in models.items() if graph_case(name) in measured}


def main(arguments: Sequence[str] = tuple(sys.argv[1:])) -> int:
    """The measurements for the arguments of the command line."""
    return answered(_measure, arguments)


def _measure(turns: Mapping[str, Any], **rest: Any) -> dict[str, Any]:
    return measure(turns=Turns(**turns), **rest)


if __name__ == "__main__":
    sys.exit(main())
