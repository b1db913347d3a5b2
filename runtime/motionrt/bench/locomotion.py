"""What is measured of walking and acting: the same inputs for motionrt and for whatever it is compared with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import cycle

import numpy as np
import numpy.typing as npt

from motionrt.bench.timing import Call
from motionrt.locomotion.crowd import Crowd, NextFrame
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.posing.body import Prior
from motionrt.locomotion.starting_poses import plain_stride
from motionrt.locomotion.transitions import Infill, transition
from motionrt.models.walknet import HISTORY
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.rotations import Array

CROWDS = (1, 2, 4, 8, 16, 32, 64)  # characters that walk together
TRANSITION, POSE, PERFORM = "transition, 60 frames", "pose, a hand and two feet", "perform, per frame"
Keypoints = Mapping[str, tuple[float, float, float]]

_FEET: Keypoints = {"left_foot": (0.11, 0.0, 0.05), "right_foot": (-0.12, 0.0, -0.04)}
POSES: tuple[Keypoints, ...] = (
    {"right_hand": (-0.25, 1.2, 0.45), **_FEET},
    {"left_hand": (0.3, 0.6, 0.4), **_FEET},
    {"right_hand": (-0.1, 1.6, 0.35), **_FEET},
    {"left_hand": (0.45, 1.0, 0.2), **_FEET},
)
"""Places that a standing person can reach, metres."""


@dataclass(frozen=True, eq=False)
class Moves:
    """Inputs of walks, transitions and poses.

    Attributes:
        histories: ``(64, 30, 219)`` ``ccf219``, the last second of each character.
        goals: ``(64, 3)`` a goal a metre ahead of each.
        seed: two seconds of a walk.
        target: a pose, one frame.
        place: where the target shall stand.
        poses: keypoints of poses.
    """

    histories: npt.NDArray[np.float64]
    goals: Array
    seed: Motion
    target: Motion
    place: Goal
    poses: tuple[Keypoints, ...]

    @classmethod
    def standard(cls) -> Moves:
        """The inputs of ``motionrt bench``: a walk of pendulums, each character in another phase of it."""
        walk = ccf219.encode(plain_stride(4.0)).astype(np.float64)
        first = (7 * np.arange(max(CROWDS))) % (len(walk) - HISTORY)
        histories = walk[first[:, None] + np.arange(HISTORY)]
        aside = 1.2 * np.arange(max(CROWDS))
        histories[:, :, 216] += aside[:, None]
        goals = np.stack([aside, histories[:, -1, 218] + 1.0, np.zeros(max(CROWDS))], axis=1)
        seed = plain_stride(2.0)
        return cls(histories, goals, seed, seed[:1], Goal(0.0, float(seed.root[-1, 2]) + 1.2), POSES)


def walk_case(characters: int, *, spread: bool = False) -> str:
    """Name of a step of so many characters; spread over threads, or in one call of the model."""
    return f"walk, {characters} character{'s' if characters > 1 else ''}{', spread' if spread else ''}"


def walk_call(model: NextFrame, moves: Moves, characters: int) -> Call:
    """One step of so many characters: seen from the goals, predicted, projected, put back into the world."""
    histories, goals = moves.histories[:characters], moves.goals[:characters]
    crowd = Crowd(model, histories)

    def step() -> Array:
        crowd.history = histories  # the same step every time
        return crowd.step(goals)

    return step


def transition_call(model: Infill, moves: Moves) -> Call:
    """One transition of 60 frames from a walk into a pose that is held."""
    return lambda: transition(model, moves.seed, moves.target, moves.place, held=True)


def pose_call(prior: Prior, moves: Moves) -> Call:
    """One pose from keypoints, however well it meets them."""
    from motionrt.locomotion.posing import solve_pose

    poses = cycle(moves.poses)
    return lambda: solve_pose(next(poses), prior, tolerance_cm=np.inf)
