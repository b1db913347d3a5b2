"""A walking test that runs during training: free walks at stride 1 along paths with turns."""

from __future__ import annotations

import numpy as np
import torch
from numpy.typing import NDArray

from motionrt.locomotion.crowd import Crowd, to_motion
from motionrt.locomotion.waypoints import WaypointTargets
from motionrt.metrics.locomotion import foot_skate, path_distances
from motionrt_training.networks.walknet import FRAMES, WalkNet
from motionrt_training.walk_pool import WalkPool

SPACING = 1.0  # metres between waypoints
STEPS = 300  # frames that are walked
SPEEDS = (0.9, 1.2, 1.2, 1.2, 1.2, 1.5)  # m/s of the characters


class Trial:
    """Characters that start from held-out walks and follow winding paths."""

    def __init__(self, pool: WalkPool, seed: int = 5) -> None:
        rng = np.random.default_rng(seed)
        starts = pool.starts(FRAMES)
        walking = starts[(pool.speed[starts] > 0.8) & (pool.weight[starts] == 1.0)]
        first = rng.choice(walking, len(SPEEDS), replace=False)
        self.history = pool.frames[first[:, None] + np.arange(FRAMES)]
        self.height = float(np.median(pool.frames[walking, 217]))
        headings = pool.heading[first + FRAMES - 1]
        self.paths = [winding(rows[-1, [216, 218]], way, rng) for rows, way in zip(self.history, headings, strict=True)]

    def measures(self, model: WalkNet) -> dict[str, float]:
        """Distance from the path (m), foot skate (cm/frame), errors of height (cm) and pace, waypoints passed."""
        made, routes = self.walk(model)
        away = [
            path_distances(walk[:, [216, 218]], path[:, :2]).mean() for path, walk in zip(self.paths, made, strict=True)
        ]
        skate = [foot_skate(to_motion(walk).positions()) for walk in made]
        height = 100 * np.mean([abs(np.median(walk[-90:, 217]) - self.height) for walk in made])
        length = [np.linalg.norm(np.diff(walk[:, [216, 218]], axis=0), axis=1).sum() * 30 / len(walk) for walk in made]
        pace = float(np.mean(np.abs(np.array(length) / SPEEDS - 1)))
        passed = float(np.mean(routes.index))
        off, slid = float(np.mean(away)), float(np.mean(skate))
        score = -(off + 0.3 * slid + 0.05 * height + pace)
        return {
            "off_path": off,
            "skate": slid,
            "height_cm": float(height),
            "pace": pace,
            "passed": passed,
            "score": score,
        }

    @torch.no_grad()
    def walk(self, model: WalkNet, steps: int = STEPS) -> tuple[list[NDArray[np.float64]], WaypointTargets]:
        """Each character's walked frames (steps, 219), and the routes as they stand at the end."""

        def predict(frames: NDArray[np.float32], speed: NDArray[np.float32]) -> NDArray[np.float32]:
            device = model.pose_mean.device
            out = model(torch.from_numpy(frames).to(device), torch.from_numpy(speed.copy()).to(device))
            return out[:, 0].float().cpu().numpy()

        crowd, routes = Crowd(predict, self.history), WaypointTargets(self.paths)
        made = [crowd.step(routes.goals(crowd.positions), np.array(SPEEDS)) for _ in range(steps)]
        return list(np.stack(made, axis=1)), routes


def winding(start: NDArray[np.float32], heading: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Waypoints (N, 3) of a path that goes on from `start`: straight parts and turns, 40 m."""
    turns = np.concatenate([np.r_[np.zeros(3), np.full(3, rng.choice([-0.5, -0.3, 0.3, 0.5]))] for _ in range(7)])
    way = heading + np.cumsum(turns)
    steps = SPACING * np.stack([np.sin(way), np.cos(way)], axis=1)
    points = np.asarray(start, dtype=np.float64) + np.cumsum(steps, axis=0)
    return np.column_stack([points, way])
