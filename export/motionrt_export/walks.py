"""What WalkNet makes of its own mean pose: inputs for validation and calibration that need no recording."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.crowd import FPS, HISTORY, Crowd
from motionrt.locomotion.goal_frame import frames_to_goal
from motionrt.locomotion.waypoints import WaypointTargets
from motionrt.motion.features.ccf219 import ROOT, ROTATIONS, WIDTH
from motionrt.motion.rotations import project_to_so3
from motionrt_export.examples import Array, Feeds
from motionrt_export.references import Reference, step_reference
from motionrt_training.networks.walknet import WISHES, WalkNet

Floats = npt.NDArray[np.float64]
SPACING = 1.0  # metres between waypoints
SPEEDS = (0.8, 1.5)  # slowest and fastest, m/s
STRAIGHT, CURVED = 3, 3  # waypoints of a straight and of a curved part
TURN = 0.5  # radians from one waypoint to the next where a path curves


@dataclass(frozen=True)
class Walked:
    """Characters in the world: frames (C, S, 219), goals (C, S, 3), speeds (C,), and their paths (N, 3) each."""

    frames: Floats
    goals: Floats
    speeds: Array
    paths: tuple[Floats, ...]


class Walks:
    """A crowd that sets off from the mean pose and follows winding paths, moved by the network's step in torch."""

    def __init__(self, model: WalkNet, *, characters: int = 8, steps: int = 120, settle: int = 60) -> None:
        self._model, self._characters, self._steps, self._settle = model, characters, steps, settle

    def walk(self, graph: Reference, history: Array, steps: int, seed: int) -> Walked:
        """``steps`` frames after ``history`` (C, 30, 219) along paths that are drawn anew."""
        rng = np.random.default_rng(seed)
        speeds = rng.uniform(*SPEEDS, len(history))
        metres = steps / FPS * SPEEDS[1] + 2.0
        paths = tuple(winding(rows, metres, rng) for rows in history)
        crowd, routes = Crowd(self._next(graph), history), WaypointTargets(paths)
        frames, goals = [], []
        for _ in range(steps):
            goals.append(routes.goals(crowd.positions))
            frames.append(crowd.step(goals[-1], speeds))
        return Walked(np.stack(frames, axis=1), np.stack(goals, axis=1), speeds, paths)

    def asked(self, history: Array, walked: Walked, every: int) -> Iterator[Feeds]:
        """What a network was asked at every ``every``-th step of a walk, all characters together."""
        frames = np.concatenate([history, walked.frames], axis=1)
        for step in range(0, walked.frames.shape[1], every):
            seen = frames_to_goal(frames[:, step : step + HISTORY], walked.goals[:, step])
            yield self.told(seen, walked.speeds)

    @cached_property
    def walked(self) -> Walked:
        """A crowd that has found its gait; its first seconds are left out."""
        start = np.repeat(standing_start(self._model)[None], self._characters, axis=0)
        walked = self.walk(step_reference(self._model), start, self._settle + self._steps, seed=0)
        return Walked(walked.frames[:, self._settle :], walked.goals[:, self._settle :], walked.speeds, walked.paths)

    def histories(self, count: int, seed: int, length: int = HISTORY) -> tuple[Floats, Floats, Array]:
        """Windows (count, length, 219) in the world, the goals (count, 3) and speeds (count,) of their last frames."""
        rng, walked = np.random.default_rng(seed), self.walked
        who = rng.integers(len(walked.frames), size=count)
        first = rng.integers(walked.frames.shape[1] - length + 1, size=count)
        frames = walked.frames[who[:, None], first[:, None] + np.arange(length)]
        return frames, walked.goals[who, first + length - 1], walked.speeds[who]

    def __call__(self, batch: int, length: int, seed: int) -> Feeds:  # noqa: ARG002  # the length is fixed
        """Inputs of WalkNet; where it knows wishes, every other character has some."""
        frames, goals, speeds = self.histories(batch, seed)
        wish = random_wishes(batch, np.random.default_rng(seed)) * (np.arange(batch) % 2)[:, None]
        return self.told(frames_to_goal(frames, goals), speeds, wish)

    def told(self, frames: Array, speeds: Array, wish: Array | None = None) -> Feeds:
        """Frames (B, 30, 219) seen from goals, speeds (B,) and wishes (B, 8), none by default, as inputs."""
        told = {"frames": frames.astype(np.float32), "speed": speeds.astype(np.float32)}
        if self._model.wishes:
            told["wish"] = (np.zeros((len(frames), WISHES)) if wish is None else wish).astype(np.float32)
        return told

    def _next(self, graph: Reference) -> Callable[[Array, Array], Array]:
        return lambda frames, speed: np.asarray(graph(self.told(frames, speed))["next"])


def random_wishes(count: int, rng: np.random.Generator) -> Array:
    """Rows (count, 8): a velocity that leads any way, a facing, a speed to arrive with."""
    way, facing = rng.uniform(-np.pi, np.pi, (2, count))
    speed, ones = rng.uniform(0.0, SPEEDS[1], count), np.ones(count)
    columns = (ones, speed * np.sin(way), speed * np.cos(way), ones, np.sin(facing), np.cos(facing), ones, speed)
    return np.stack(columns, axis=1)


def standing_start(model: WalkNet) -> Floats:
    """(30, 219): the mean pose, gliding along +Z at 1 m/s to the origin."""
    mean = model.pose_mean.numpy().astype(np.float64)
    mean[ROTATIONS] = project_to_so3(mean[ROTATIONS].reshape(-1, 3, 3)).ravel()
    frames = np.tile(mean, (HISTORY, 1))
    frames[:, ROOT.start] = 0.0
    frames[:, WIDTH - 1] = np.arange(1 - HISTORY, 1) / FPS
    return frames


def winding(history: Array, metres: float, rng: np.random.Generator) -> Floats:
    """Waypoints (N, 3), x, z, heading, of a path on from the last frame: straight parts and turns in turn."""
    forward = history[-1, [2, 8]]  # x and z of the pelvis' forward axis
    parts = int(np.ceil(metres / SPACING / (STRAIGHT + CURVED)))
    turns = [np.r_[np.zeros(STRAIGHT), np.full(CURVED, rng.uniform(-TURN, TURN))] for _ in range(parts)]
    heading = np.arctan2(*forward) + np.cumsum(np.concatenate(turns))
    steps = SPACING * np.stack([np.sin(heading), np.cos(heading)], axis=1)
    return np.column_stack([history[-1, [216, 218]] + np.cumsum(steps, axis=0), heading])
