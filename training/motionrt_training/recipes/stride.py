"""Make the stride and the standing pose that performances begin with.

The stride is a steady walk of WalkNet's own, feet held; the pose is solved for over the pose prior.

    python -m motionrt_training.recipes.stride . --walks runs/walks-val.npz -o runtime/motionrt/_assets/stride.npz

The walk begins with a held-out recording and goes straight on until nothing of it is left; of several, the one whose
feet slide least is taken: how somebody sets off is how he walks for a long time.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from motionrt.formats.motion_pack import MotionPack
from motionrt.locomotion.crowd import Crowd, NextFrame, to_motion
from motionrt.locomotion.starting_poses import solved_standing, stride_of
from motionrt.metrics.locomotion import foot_skate
from motionrt.models import PosePrior, Sessions, WalkModel
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.lock import lock_feet
from motionrt_training.networks.walknet import FRAMES
from motionrt_training.walk_pool import WalkPool, read_pool

STEPS, KEPT = 900, 60  # frames that are walked, and frames at the end that are kept
SPEED = 1.2  # m/s
AHEAD = 1.5  # metres from the walker to its goal
CANDIDATES = 12

Frames = np.ndarray[tuple[int, ...], np.dtype[np.float32]]


def steady_walk(model: NextFrame, histories: Frames) -> Motion:
    """Walk straight along +Z from ``histories`` (B, 30, 219): the end of the walk whose feet slide least, locked."""
    crowd, made = Crowd(model, histories), []
    for _ in range(STEPS):
        x, z = crowd.positions.T
        made.append(crowd.step(np.stack([0.5 * x, z + AHEAD, np.zeros_like(x)], axis=1), SPEED))
    walks = [to_motion(walk[STEPS // 2 :]) for walk in np.stack(made, axis=1)]
    best = min(walks, key=lambda walk: foot_skate(walk.positions()))
    return lock_feet(best)[-KEPT:]


def straight_starts(pool: WalkPool) -> Frames:
    """The first second of held-out walks near the wanted speed, each ending at the origin, heading +Z."""
    starts = pool.starts(FRAMES)
    plain = starts[pool.weight[starts] == 1.0]
    near = plain[np.argsort(np.abs(pool.speed[plain] - SPEED), kind="stable")[: 20 * CANDIDATES : 20]]
    return np.stack([ccf219.encode(stride_of(to_motion(pool.frames[first : first + FRAMES]))) for first in near])


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Make the stride of transitions out of a pose.")
    parser.add_argument("models", type=Path, help="folder of the models manifest")
    parser.add_argument("--walks", type=Path, required=True, help="pool of held-out walks (.npz)")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    sessions = Sessions(args.models)
    walk = steady_walk(WalkModel(sessions), straight_starts(read_pool(args.walks)))
    pack = MotionPack.of([stride_of(walk), solved_standing(PosePrior.open(sessions))])
    with args.out.open("wb") as file:
        pack.write(file)


if __name__ == "__main__":
    main()
