"""How well inverse kinematics meets keypoints of held-out recordings.

    python -m motionrt_training.evaluate.poses runs/recordings.npz

Keypoints are taken from poses of the test split: a hand and both feet, or the pelvis and both feet. Times are wall
clock on whatever the machine is doing.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from motionrt.locomotion.posing import solve_pose
from motionrt.models import PosePrior
from motionrt.motion import SMPL24, Motion
from motionrt_training.corpora.recordings import Recordings, load_recordings

KEYPOINTS: dict[str, Callable[[int], tuple[str, ...]]] = {
    "hand + two feet": lambda index: (("left_hand", "right_hand")[index % 2], "left_foot", "right_foot"),
    "pelvis + two feet": lambda _: ("pelvis", "left_foot", "right_foot"),
}


@dataclass(frozen=True)
class Reached:
    """Errors over poses, centimetres; times, milliseconds."""

    poses: int
    mean_cm: float
    p95_cm: float
    worst_pose_cm: float
    worst_keypoint_cm: float
    p50_ms: float
    p95_ms: float


def sampled_poses(recordings: Recordings, count: int, seed: int = 0) -> list[Motion]:
    """One-frame motions drawn evenly over all frames of the test split."""
    motions = [motion for _, motion in recordings.split("test")]
    ends = np.cumsum([motion.frames for motion in motions])
    drawn = np.random.default_rng(seed).integers(ends[-1], size=count)
    owners = np.searchsorted(ends, drawn, side="right")
    frames = drawn - (ends - [motion.frames for motion in motions])[owners]
    return [motions[i][f : f + 1] for i, f in zip(owners.tolist(), frames.tolist(), strict=True)]


def reached(poses: list[Motion], joints: Callable[[int], tuple[str, ...]], prior: PosePrior) -> Reached:
    """Solve for the keypoints of every pose; a miss is measured, not raised."""
    solve_pose({"pelvis": (0.0, 0.9, 0.0)}, prior)  # opens the model
    means, worst, times = [], [], []
    for index, pose in enumerate(poses):
        places = pose.positions()[0]
        keypoints = {name: places[SMPL24.index(name)] for name in joints(index)}
        start = time.perf_counter()
        solution = solve_pose(keypoints, prior, tolerance_cm=1e9)
        times.append(1000 * (time.perf_counter() - start))
        means.append(solution.mean_error_cm)
        worst.append(solution.max_error_cm)
    p50, p95 = np.percentile(times, [50, 95])
    figures = np.mean(means), np.percentile(means, 95), max(means), max(worst), p50, p95
    return Reached(len(poses), *(round(float(figure), 3) for figure in figures))


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Keypoint errors of inverse kinematics on held-out poses.")
    parser.add_argument("corpus", type=Path, help="packed recordings (.npz)")
    parser.add_argument("--models", type=Path, help="models manifest or folder (default: shipped)")
    parser.add_argument("-n", type=int, default=200, help="poses of each kind (default: 200)")
    args = parser.parse_args()
    poses = sampled_poses(load_recordings(args.corpus), args.n)
    prior = PosePrior.open(args.models, threads=1)
    print(json.dumps({name: asdict(reached(poses, joints, prior)) for name, joints in KEYPOINTS.items()}, indent=2))


if __name__ == "__main__":
    main()
