"""Make the stride and the standing pose that performances begin with.

The stride is a steady walk of WalkNet's own, feet held; the pose is solved for over the pose prior.

    python -m motionrt_training.recipes.stride models --walks runs/walks-val.npz -o runtime/motionrt/_assets/stride.npz

The walk begins with a held-out recording and goes straight on until nothing of it is left.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from motionrt.locomotion import Goal
from motionrt.locomotion.poses import solved_standing, stride_of
from motionrt.locomotion.walking import Crowd, NextFrame, to_motion
from motionrt.models import PosePrior, Sessions, WalkModel
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.foot_lock import lock_feet
from motionrt.formats.motion_pack import MotionPack
from motionrt_training.networks.walknet import FRAMES
from motionrt_training.walk_pool import WalkPool, read_pool

STEPS, KEPT = 450, 60  # frames that are walked, and frames at the end that are kept
SPEED = 1.2  # m/s
AHEAD = 1.5  # metres from the walker to its goal


def steady_walk(model: NextFrame, history: np.ndarray[tuple[int, int], np.dtype[np.float32]]) -> Motion:
    """Walk straight along +Z from ``history`` (30, 219); the last frames, feet held."""
    crowd, made = Crowd(model, history[None]), []
    for _ in range(STEPS):
        x, z = crowd.positions[0]
        made.append(crowd.step(np.array([Goal(0.5 * x, z + AHEAD, 0.0).row()]), SPEED)[0])
    return lock_feet(to_motion(np.stack(made[-2 * KEPT :])))[-KEPT:]


def straight_start(pool: WalkPool) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    """A second of a held-out walk at the wanted speed, its last frame at the origin, heading +Z."""
    starts = pool.starts(FRAMES)
    plain = starts[pool.weight[starts] == 1.0]
    first = plain[np.argmin(np.abs(pool.speed[plain] - SPEED))]
    return ccf219.encode(stride_of(to_motion(pool.frames[first : first + FRAMES])))


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Make the stride of transitions out of a pose.")
    parser.add_argument("models", type=Path, help="folder of the models manifest")
    parser.add_argument("--walks", type=Path, required=True, help="pool of held-out walks (.npz)")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    sessions = Sessions(args.models)
    walk = steady_walk(WalkModel(sessions), straight_start(read_pool(args.walks)))
    with args.out.open("wb") as file:
        MotionPack.of([stride_of(walk), solved_standing(PosePrior(sessions))]).write(file)


if __name__ == "__main__":
    main()
