"""What a generator's checkpoints are chosen by: whether motions of own prompts do what these say, and how they look."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from motionrt.motion.attributes import measure
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.canvas import GUIDED
from motionrt.synthesis.motion_diffusion import solve
from motionrt.synthesis.sampling import MOTION_STEPS, POSE_GUIDANCE, TURN_GUIDANCE
from motionrt.text import SLOTS, agreement, parse_query, slots_of_text, targets_of_text
from motionrt_training.networks.motion_denoiser import Condition, MotionDenoiser

PROMPTS = Path(__file__).parent / "evaluate" / "validation_prompts.txt"
PASSED = 0.7  # agreement from which on a motion does what its text says
FRAMES = 80
_BONES = (
    ("left_hip", "left_knee"),
    ("left_knee", "left_ankle"),
    ("left_shoulder", "left_elbow"),
    ("left_elbow", "left_wrist"),
)

Features = NDArray[np.float32]


def read_prompts(path: Path = PROMPTS) -> list[str]:
    """The texts of a file, one a line; lines that begin with # are left out."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line.strip() for line in lines if line.strip() and not line.startswith("#")]


FLUNG = 1e3  # metres, or radians a frame


@dataclass(frozen=True)
class Trial:
    """Prompts with their token features (T, 384), and what recordings' `looks` are."""

    texts: Sequence[str]
    tokens: Sequence[NDArray[np.floating]]
    recorded: dict[str, float]
    seed: int = 0

    def run(self, model: MotionDenoiser) -> dict[str, float]:
        """Share of motions that pass, mean agreement, and what they look like beside recordings."""
        motions = sample(model, self.texts, self.tokens, FRAMES, self.seed)
        scores = [obeys(text, motion) for text, motion in zip(self.texts, motions, strict=True)]
        whole = [motion for motion in motions if is_whole(motion)]
        if not whole:
            return {"passed": 0.0, "agreement": 0.0, "score": 0.0}
        found = looks(whole)
        own = {name: found[name] / max(self.recorded[name], 1e-6) for name in ("energy", "jerk", "skate")}
        own |= {name: found[name] for name in ("floating", "bones")}
        passed = float(np.mean([score >= PASSED for score in scores]))
        return {"passed": passed, "agreement": float(np.mean(scores)), **own, "score": float(np.mean(scores))}


def is_whole(motion: Features) -> bool:
    """Whether features are finite and no joint is flung away, as networks do that have hardly been trained."""
    return bool(np.isfinite(motion).all() and np.abs(motion).max() < FLUNG)


def obeys(text: str, motion: Features) -> float:
    """How well ``ego77`` features (F, 77) do what a text says, 0 to 1; 0 for what is no motion at all."""
    if not is_whole(motion):
        return 0.0
    return float(agreement(parse_query(text), measure(ego77.decode(motion), ego77.FPS)))


@torch.no_grad()
def sample(
    model: MotionDenoiser,
    texts: Sequence[str],
    tokens: Sequence[NDArray[np.floating]],
    frames: int,
    seed: int,
    *,
    steps: int = MOTION_STEPS,
    turn: float = TURN_GUIDANCE,
    pose: float = POSE_GUIDANCE,
) -> list[Features]:
    """Raw ``ego77`` features (frames, 77) of every text."""
    model.eval()
    count, length = len(texts), -(-frames // model.patch) * model.patch
    told = _told(texts, tokens, frames, length)
    weight = torch.tensor([[turn, pose]]).expand(count, 2)

    def denoise(state: Features, level: float) -> Features:
        weights = weight if level >= GUIDED else torch.ones_like(weight)
        found = model.guided(torch.from_numpy(state), torch.full((count,), level), told, weights)
        return np.asarray(found.numpy())

    noise = np.random.default_rng(seed).standard_normal((count, length, ego77.WIDTH), dtype=np.float32)
    clean = model.denormalise(torch.from_numpy(solve(denoise, noise, steps))).numpy()
    return [row[:frames] for row in clean]


def looks(motions: Sequence[Features]) -> dict[str, float]:
    """Means of what is seen in motions (F, 77).

    "energy": standard deviation over time of joints in the body's axes, m; "jerk": third difference of joints, m/s^3;
    "skate": speed of the lower foot where it is within 5 cm of its lowest, m/s; "floating": height of the lowest
    joint, m; "bones": standard deviation over time of the lengths of left arm and leg, m.
    """
    rows = [_looks(motion) for motion in motions]
    return {name: float(np.mean([row[name] for row in rows])) for name in rows[0]}


def _looks(motion: Features) -> dict[str, float]:
    joints = ego77.decode(motion)
    own = motion[:, ego77.JOINTS].reshape(len(motion), -1, 3)
    feet = joints[:, [SMPL24.index("left_foot"), SMPL24.index("right_foot")]]
    speed = np.linalg.norm(np.diff(feet, axis=0)[..., [0, 2]], axis=-1) * ego77.FPS
    height = feet[1:, :, 1]
    lower = height.argmin(axis=1)
    rows = np.arange(len(lower))
    standing = height[rows, lower] < np.percentile(feet[..., 1], 5) + 0.05
    pairs = [(SMPL24.index(a), SMPL24.index(b)) for a, b in _BONES]
    bones = [np.linalg.norm(joints[:, a] - joints[:, b], axis=1).std() for a, b in pairs]
    return {
        "energy": float(own.std(axis=0).mean()),
        "jerk": float(np.linalg.norm(np.diff(joints, n=3, axis=0), axis=-1).mean() * ego77.FPS**3),
        "skate": float(speed[rows, lower][standing].mean()) if standing.any() else 0.0,
        "floating": float(joints[..., 1].min(axis=1).mean()),
        "bones": float(np.mean(bones)),
    }


def _told(texts: Sequence[str], tokens: Sequence[NDArray[np.floating]], frames: int, length: int) -> Condition:
    count, longest = len(texts), max(len(rows) for rows in tokens)
    words = np.zeros((count, longest, tokens[0].shape[1]), np.float32)
    seen = np.zeros((count, longest), bool)
    for number, rows in enumerate(tokens):
        words[number, : len(rows)], seen[number, : len(rows)] = rows, True
    slots = np.stack([slots_of_text(parse_query(text)) for text in texts]).reshape(count, len(SLOTS))
    numbers = [targets_of_text(parse_query(text), frames / ego77.FPS) for text in texts]
    there = torch.zeros(count, length, dtype=torch.bool)
    there[:, :frames] = True
    return Condition(
        there, torch.from_numpy(words), torch.from_numpy(seen), torch.from_numpy(slots),
        torch.from_numpy(np.stack([values for values, _ in numbers])),
        torch.from_numpy(np.stack([known for _, known in numbers])),
        torch.zeros(count, length, ego77.WIDTH), torch.zeros(count, length, len(PARTS), dtype=torch.bool),
    )  # fmt: skip
