"""Ten walks of 150 to 200 m through maps and meshes, measured: arrival, path, feet, height, and whether they drift.

    python benchmarks/walks.py SCENES [--mocap FOLDER] [--json walks.json]

SCENES holds the scenes of ``ROUTES``. With ``--mocap``, a folder with CMU's ``index.csv`` and its trials, the plain
walks recorded there are measured by the same code, so that the reader sees what real feet do. Prints Markdown tables;
exit code 1 if a walk breaks one of the limits below.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from walk_rows import Recorded, Row, plain_walks, recorded, row_of
from walk_tables import drift_table, mocap_line, table

from motionrt import Runtime, Scene

WAYPOINTS_REACHED = 1.0  # share, at least
PATH_MEAN_M = 0.35
GOAL_M = 0.2
SKATE_CM = 0.92  # cm per frame
SKATE_OF_MOCAP = 1.3  # times what recorded walks have, locked against locked, unlocked against unlocked
HEIGHT_DRIFT_CM = 3.0
LAST_OF_FIRST = 1.25  # the last 30 s against the first, and what is too little to count:
SLACK_M, SLACK_CM = 0.03, 0.1


@dataclass(frozen=True)
class Route:
    """A random path of so many metres through a scene; ``options`` are those of ``Scene.open``."""

    file: str
    metres: float
    seed: int
    options: Mapping[str, Any] = field(default_factory=dict)


ROUTES = (
    Route("nav2_maps/warehouse.yaml", 200, 1),
    Route("nav2_maps/warehouse.yaml", 180, 2),
    Route("nav2_maps/depot.yaml", 160, 3),
    Route("willow/willow-full.pgm", 190, 4, {"resolution": 0.1}),
    Route("willow/willow-full-0.05.pgm", 175, 5, {"resolution": 0.05}),
    Route("recast/dungeon.obj", 200, 6),
    Route("recast/dungeon.obj", 165, 7),
    Route("recast/nav_test.obj", 185, 8),
    Route("recast/undulating.obj", 170, 9),
    Route("three_pathfinding/level.obj", 150, 10),
)


def main() -> int:
    """Walk, print, and say by the exit code whether all limits hold."""
    args = parser().parse_args()
    mocap = recorded(plain_walks(args.mocap)) if args.mocap else None
    runtime, rows = Runtime(args.models, threads=args.threads, variant=args.variant), []
    for route in ROUTES[: args.first]:
        rows.append(walked(runtime, route, args.scenes, args.metres))
        print(f"{rows[-1].scene}: {rows[-1].seconds:.0f} s", file=sys.stderr, flush=True)
    print(table(rows), drift_table(rows), sep="\n\n")
    if mocap:
        print(f"\n{mocap_line(mocap)}")
    faults = [f"{row.scene}: {fault}" for row in rows for fault in broken(row, mocap)]
    print("\n" + ("\n".join(faults) or "All limits hold."))
    if args.json:
        found = {"walks": [asdict(row) for row in rows], "mocap": mocap and asdict(mocap), "broken": faults}
        args.json.write_text(json.dumps(found, indent=1), encoding="utf-8")
    return 1 if faults else 0


def parser() -> argparse.ArgumentParser:
    """The options."""
    result = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("scenes", type=Path)
    result.add_argument("--mocap", type=Path, help="CMU's trials: a folder with index.csv, bvh/, amc/ and asf/")
    result.add_argument("--json", type=Path, help="write all figures here, too")
    result.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped models)")
    result.add_argument("--variant", help="which files of the models, as in fp32")
    result.add_argument("--threads", type=int, help="threads of every model")
    result.add_argument("--first", type=int, help="only so many of the routes")
    result.add_argument("--metres", type=float, help="walk only so far, for a trial")
    return result


def walked(runtime: Runtime, route: Route, scenes: Path, metres: float | None = None) -> Row:
    """Walk one route from a stand to a stand."""
    scene = Scene.open(scenes / route.file, **route.options)
    path = scene.random_path(metres or route.metres, route.seed)
    started = time.perf_counter()
    walk = runtime.walk(path=path, foot_lock=False)
    took = time.perf_counter() - started
    name = f"{Path(route.file).stem} ({route.seed})"
    return row_of(name, walk.motion, path.points, walk.waypoints.positions, walk.radius, walk.motion.duration / took)


def broken(row: Row, mocap: Recorded | None = None) -> list[str]:
    """Which limits a walk breaks, in words."""
    checks = [
        ("waypoints reached", row.waypoints, -1, WAYPOINTS_REACHED),
        ("mean distance from the path, m", row.off_path_m, 1, PATH_MEAN_M),
        ("distance from the goal, m", row.goal_m, 1, GOAL_M),
        ("foot skate, cm/frame", row.skate_cm, 1, SKATE_CM),
        ("foot skate with unlocked feet, cm/frame", row.skate_unlocked_cm, 1, SKATE_CM),
        ("drift in height, cm", abs(row.height_drift_cm), 1, HEIGHT_DRIFT_CM),
        ("last 30 s, distance from the path, m", row.last.off_path_m, 1, _later(row.first.off_path_m, SLACK_M)),
        ("last 30 s, foot skate, cm/frame", row.last.skate_cm, 1, _later(row.first.skate_cm, SLACK_CM)),
    ]
    if mocap is not None:
        pairs = (("locked", row.skate_cm, mocap.skate_locked_cm), ("unlocked", row.skate_unlocked_cm, mocap.skate_cm))
        checks += [
            (f"foot skate against recorded walks, {feet} feet, cm/frame", ours, 1, SKATE_OF_MOCAP * theirs)
            for feet, ours, theirs in pairs
        ]
    return [
        f"{name}: {value:.3f}, but the limit is {limit:.3f}"
        for name, value, sign, limit in checks
        if not sign * value <= sign * limit + 1e-9  # what is not a number breaks a limit, too
    ]


def _later(first: float, slack: float) -> float:
    return max(LAST_OF_FIRST * first, first + slack)


if __name__ == "__main__":
    sys.exit(main())
