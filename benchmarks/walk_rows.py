"""One walk measured, and recorded walks by the same code."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt import Motion, load_motion
from motionrt.metrics import LocomotionMeasures, foot_skate, jerk, standing_height
from motionrt.metrics.locomotion import foot_skates, path_distances
from motionrt.motion.feet.flat_ground import flat_ground
from motionrt.motion.feet.lock import lock_feet

WINDOW_S = 30.0  # seconds at the beginning and at the end that are compared
FPS = 30.0


@dataclass(frozen=True)
class Spell:
    """Thirty seconds of a walk: distance from the path (m), foot skate (cm/frame), height of the pelvis (m)."""

    off_path_m: float
    skate_cm: float
    height_m: float


@dataclass(frozen=True)
class Row:
    """A walk: where, and how well; feet are locked but for ``skate_unlocked_cm``."""

    scene: str
    length_m: float
    seconds: float
    waypoints: float
    off_path_m: float
    off_path_max_m: float
    goal_m: float
    skate_cm: float
    skate_unlocked_cm: float
    jerk: float
    height_m: float
    height_drift_cm: float
    first: Spell
    last: Spell
    times_real_time: float


@dataclass(frozen=True)
class Recorded:
    """Recorded walks, measured by the same code."""

    trials: int
    seconds: float
    skate_cm: float
    skate_locked_cm: float
    jerk: float
    height_m: float


def row_of(
    name: str,
    motion: Motion,
    path: npt.ArrayLike,
    waypoints: npt.ArrayLike,
    radius: float,
    times_real_time: float = 0.0,
) -> Row:
    """Measure a walk along ``path`` ``(N, 2)`` whose feet are not locked yet."""
    positions = lock_feet(motion).positions()
    found = LocomotionMeasures.of(positions, motion.fps, path, waypoints, radius=radius, window_s=WINDOW_S)
    first, last = spells(positions, path, motion.fps)
    return Row(
        scene=name,
        length_m=float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum()),
        seconds=found.seconds,
        waypoints=found.waypoints_reached or 0.0,
        off_path_m=found.path_deviation_m or 0.0,
        off_path_max_m=found.path_deviation_max_m or 0.0,
        goal_m=found.goal_distance_m or 0.0,
        skate_cm=found.foot_skate_cm,
        skate_unlocked_cm=foot_skate(motion.positions()),
        jerk=found.jerk,
        height_m=found.standing_height_m,
        height_drift_cm=found.height_drift_cm,
        first=first,
        last=last,
        times_real_time=times_real_time,
    )


def spells(positions: npt.NDArray[np.floating], path: npt.ArrayLike, fps: float) -> tuple[Spell, Spell]:
    """The first and the last 30 s, or halves of a shorter walk."""
    frames = max(2, min(round(WINDOW_S * fps), len(positions) // 2))
    return tuple(  # type: ignore[return-value]
        Spell(
            float(path_distances(part[:, 0, [0, 2]], path).mean()),
            float(foot_skates(part).mean()),
            float(part[:, 0, 1].mean()),
        )
        for part in (positions[:frames], positions[-frames:])
    )


def recorded(walks: Sequence[Motion]) -> Recorded:
    """Measure recorded walks; means are weighted with time."""
    ground = [flat_ground(walk.resample(FPS)) for walk in walks]
    positions = [walk.positions() for walk in ground]
    weights = [len(joints) for joints in positions]

    def mean(values: list[float]) -> float:
        return float(np.average(values, weights=weights))

    return Recorded(
        trials=len(walks),
        seconds=sum(weights) / FPS,
        skate_cm=mean([foot_skate(joints) for joints in positions]),
        skate_locked_cm=mean([foot_skate(lock_feet(walk).positions()) for walk in ground]),
        jerk=mean([jerk(joints, FPS) for joints in positions]),
        height_m=mean([standing_height(joints) for joints in positions]),
    )


def plain_walks(folder: Path) -> list[Motion]:
    """The trials that CMU describes as "walk" and nothing else."""
    with (folder / "index.csv").open(encoding="utf-8", newline="") as file:
        names = [(row["trial"], row["format"]) for row in csv.DictReader(file) if row["description"] == "walk"]
    return [load_motion(folder / kind / f"{trial}.{kind}") for trial, kind in names]
