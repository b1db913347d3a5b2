"""Stand-ins for the models that move a character: instant, exact, and with nothing learned."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from motions import standing, walking
from scipy.spatial.transform import Rotation, Slerp

from motionrt.errors import ReachError
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.holding import hold
from motionrt.locomotion.starting_poses import stride_of
from motionrt.locomotion.transitions import placed
from motionrt.motion import SMPL24, Motion

FPS = 30.0
REACH = 3.0  # metres from the ground: what is higher is out of reach


def towards_goal(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """The last frame, moved straight towards the goal and turned that way."""
    out = frames[:, -1].astype(np.float64)
    place = out[:, [216, 218]]
    away = np.linalg.norm(place, axis=1)
    way = np.where(away[:, None] > 1e-6, -place / np.maximum(away, 1e-6)[:, None], [0.0, 1.0])
    out[:, [216, 218]] += way * (np.asarray(speed) / FPS)[:, None]
    out[:, 0:9] = Rotation.from_euler("y", np.arctan2(way[:, :1], way[:, 1:])).as_matrix().reshape(-1, 9)
    return out.astype(np.float32)


def turns_gently(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """The last frame, turned towards the goal by at most 6 degrees, and moved ahead."""
    out = frames[:, -1].astype(np.float64)
    facing = np.arctan2(out[:, 2], out[:, 8])
    off = np.arctan2(-out[:, 216], -out[:, 218]) - facing
    facing = facing + np.clip((off + np.pi) % (2 * np.pi) - np.pi, -0.1, 0.1)
    out[:, 0:9] = Rotation.from_euler("y", facing[:, None]).as_matrix().reshape(-1, 9)
    out[:, [216, 218]] += np.stack([np.sin(facing), np.cos(facing)], axis=1) * (np.asarray(speed) / FPS)[:, None]
    return out.astype(np.float32)


class Strafes:
    """As `turns_gently`; where a velocity and a facing are wished, moved and turned exactly so."""

    wishes = True

    def __call__(self, frames: np.ndarray, speed: np.ndarray, wish: np.ndarray | None = None) -> np.ndarray:
        if wish is None:
            return turns_gently(frames, speed)
        out = frames[:, -1].astype(np.float64)
        facing = np.arctan2(out[:, 2], out[:, 8])
        off = np.arctan2(wish[:, 4], wish[:, 5]) - facing
        facing = facing + np.clip((off + np.pi) % (2 * np.pi) - np.pi, -0.1, 0.1)
        out[:, 0:9] = Rotation.from_euler("y", facing[:, None]).as_matrix().reshape(-1, 9)
        out[:, [216, 218]] += wish[:, 1:3] / FPS
        return out.astype(np.float32)


def stays(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """The last frame again: a character that is stuck."""
    return frames[:, -1]


class FakeCharacterModels:
    """Walks straight to goals; transitions are slerps; a pose is the rest pose moved so that its pelvis or feet fit."""

    def __init__(self, walk: Any = towards_goal) -> None:
        self.walk = walk
        self.standing = stride_of(standing(1, FPS))
        self.stride = stride_of(walking(60, FPS))

    def transition(self, seed: Motion, target: Motion, goal: Goal | None = None, *, held: bool = False) -> Motion:
        aim = target if goal is None else placed(target, goal)
        share = np.linspace(0, 1, 61)[1:]
        ends = zip(seed.rotations[-1], aim.rotations[-1], strict=True)
        turns = [Slerp([0, 1], Rotation.from_matrix(np.stack(pair)))(share).as_matrix() for pair in ends]
        root = seed.root[-1] + share[:, None] * (aim.root[-1] - seed.root[-1])
        rotations = np.stack(turns, axis=1).astype(np.float32)
        rotations[-1], root[-1] = aim.rotations[-1], aim.root[-1]
        return Motion(rotations, root.astype(np.float32), FPS)

    def hold(self, pose: Motion, seconds: float, seed: int) -> Motion:
        return hold(pose, seconds, seed)

    def pose(
        self,
        keypoints: Mapping[str, Sequence[float]],
        heading: float | None = None,
        *,
        floor: float | None = 0.0,
        tolerance_cm: float = 5.0,
        surfaces: Any = None,
    ) -> Any:
        if max(point[1] for point in keypoints.values()) > REACH:
            raise ReachError("no plausible pose meets the keypoints", dict.fromkeys(keypoints, 99.0))
        body = placed(standing(1, FPS), Goal(0.0, 0.0, heading or 0.0))
        joint, point = next(iter(keypoints.items()))
        root = body.root + (np.asarray(point, np.float32) - body.positions()[0, SMPL24.index(joint)])
        return SimpleNamespace(motion=Motion(body.rotations, root, FPS))
