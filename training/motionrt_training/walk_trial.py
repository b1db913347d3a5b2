"""Walking tests that run during training: free walks at stride 1 along paths with turns, and by a stick."""

from __future__ import annotations

import numpy as np
import torch
from numpy.typing import NDArray

from motionrt.locomotion.crowd import Crowd, NextFrame, to_motion
from motionrt.locomotion.waypoints import WaypointTargets
from motionrt.locomotion.wishes import Wish
from motionrt.metrics.locomotion import foot_skate, path_distances
from motionrt.motion.rotations import wrapped
from motionrt_training.networks.walknet import FRAMES, WalkNet
from motionrt_training.walk_pool import WalkPool

SPACING = 1.0  # metres between waypoints
STEPS = 300  # frames that are walked
SPEEDS = (0.9, 1.2, 1.2, 1.2, 1.2, 1.5)  # m/s of the characters

PHASES = (
    (1.2, 0.0, 0.0),
    (0.0, 0.0, 0.0),
    (0.0, 0.0, 2.0),
    (-0.7, 0.0, 0.0),
    (0.0, 0.6, 0.0),
    (2.5, 0.0, 0.0),
    (0.0, 0.0, 0.0),
)
"""What a stick says one after the other: m/s ahead and to the left, and radians turned."""
PHASE = 60  # frames of each


class Trial:
    """Characters that start from held-out walks and follow winding paths."""

    def __init__(self, pool: WalkPool, seed: int = 5) -> None:
        rng = np.random.default_rng(seed)
        starts = pool.starts(FRAMES)
        walking = starts[(pool.speed[starts] > 0.8) & (pool.weight[starts] == 1.0)]
        if not len(walking):
            walking = starts[pool.speed[starts] >= np.median(pool.speed[starts])]  # a corpus of slow walks
        first = rng.choice(walking, len(SPEEDS), replace=len(walking) < len(SPEEDS))
        self.history = pool.frames[first[:, None] + np.arange(FRAMES)]
        self.height = float(np.median(pool.frames[walking, 217]))
        headings = pool.heading[first + FRAMES - 1]
        self.paths = [winding(rows[-1, [216, 218]], way, rng) for rows, way in zip(self.history, headings, strict=True)]

    def measures(self, model: WalkNet) -> dict[str, float]:
        """Distance from the path (m), foot skate (cm/frame), errors of height (cm) and pace, waypoints passed."""
        made, routes = self.walk(model)
        steered = self.steered(model) if model.wishes else {}
        away = [
            path_distances(walk[:, [216, 218]], path[:, :2]).mean() for path, walk in zip(self.paths, made, strict=True)
        ]
        skate = [foot_skate(to_motion(walk).positions()) for walk in made]
        height = 100 * np.mean([abs(np.median(walk[-90:, 217]) - self.height) for walk in made])
        length = [np.linalg.norm(np.diff(walk[:, [216, 218]], axis=0), axis=1).sum() * 30 / len(walk) for walk in made]
        pace = float(np.mean(np.abs(np.array(length) / SPEEDS - 1)))
        passed = float(np.mean(routes.index))
        off, slid = float(np.mean(away)), float(np.mean(skate))
        score = -(off + 0.3 * slid + 0.05 * height + pace + sum(steered.values()))
        return {
            "off_path": off,
            "skate": slid,
            "height_cm": float(height),
            "pace": pace,
            "passed": passed,
            **steered,
            "score": score,
        }

    @torch.no_grad()
    def steered(self, model: WalkNet) -> dict[str, float]:
        """By a stick: errors of velocity (m/s) and facing (rad), foot skate (m per second of motion)."""
        crowd, made = Crowd(next_frames(model), self.history), []
        start = np.arctan2(self.history[:, -1, 2], self.history[:, -1, 8])
        facing, slow, turned, before = start.copy(), [], [], crowd.positions.copy()
        for ahead, left, turn in PHASES:
            for step in range(PHASE):
                facing = facing + turn / PHASE
                velocity = ahead * np.stack([np.sin(facing), np.cos(facing)], 1)
                velocity += left * np.stack([np.cos(facing), -np.sin(facing)], 1)
                wishes = [
                    Wish((x, z), yaw).row() for (x, z), yaw in zip(velocity.tolist(), facing.tolist(), strict=True)
                ]
                goals = np.column_stack([crowd.positions, facing])
                made.append(crowd.step(goals, 1.0, np.array(wishes)))
                if step == PHASE // 2:
                    before = crowd.positions.copy()
            moved = (crowd.positions - before) / (PHASE - 1 - PHASE // 2) * 30
            slow.append(np.hypot(*(moved - velocity).T).mean())
            looks = np.arctan2(made[-1][:, 2], made[-1][:, 8])
            turned.append(np.abs(wrapped(looks - facing)).mean())
        walks = np.stack(made, axis=1)
        slid = np.mean([foot_skate(to_motion(walk).positions()) for walk in walks])
        return {
            "steer_speed": float(np.mean(slow)),
            "steer_facing": float(np.mean(turned)),
            "steer_skate": 0.3 * float(slid),
        }

    @torch.no_grad()
    def walk(self, model: WalkNet, steps: int = STEPS) -> tuple[list[NDArray[np.float64]], WaypointTargets]:
        """Each character's walked frames (steps, 219), and the routes as they stand at the end."""
        crowd, routes = Crowd(next_frames(model), self.history), WaypointTargets(self.paths)
        made = [crowd.step(routes.goals(crowd.positions), np.array(SPEEDS)) for _ in range(steps)]
        return list(np.stack(made, axis=1)), routes


def next_frames(model: WalkNet) -> NextFrame:
    """The network as a crowd wants it."""

    def predict(*told: NDArray[np.float32]) -> NDArray[np.float32]:
        made = model(*(torch.from_numpy(np.array(values)).to(model.pose_mean.device) for values in told))
        return np.asarray(made[:, 0].float().cpu().numpy())

    return predict


def winding(start: NDArray[np.float32], heading: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Waypoints (N, 3) of a path that goes on from `start`: straight parts and turns, 40 m."""
    turns = np.concatenate([np.r_[np.zeros(3), np.full(3, rng.choice([-0.5, -0.3, 0.3, 0.5]))] for _ in range(7)])
    way = heading + np.cumsum(turns)
    steps = SPACING * np.stack([np.sin(way), np.cos(way)], axis=1)
    points = np.asarray(start, dtype=np.float64) + np.cumsum(steps, axis=0)
    return np.column_stack([points, way])
