"""Gaps to fill, made by the networks themselves: somebody walks, and shall come into a pose of the prior."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import torch

from motionrt.locomotion.crowd import to_motion
from motionrt.locomotion.goal_frame import frames_to_goal
from motionrt.motion.features.ccf219 import WIDTH
from motionrt_export.examples import Array, Feeds
from motionrt_export.walks import Walks
from motionrt_training.networks.pose_prior import PosePrior
from motionrt_training.networks.transnet import FRAMES, SEED

AHEAD = (0.3, 1.2)  # metres from the last seed frame to the target
ASIDE = 0.4  # metres
TURN = 1.5  # radians between the two headings
VISIBLE = 6  # most frames in which the target is held

Floats = npt.NDArray[np.float64]


class Transitions:
    """Seed frames of a walk, a hidden gap, and a pose at the origin."""

    def __init__(self, walks: Walks, prior: PosePrior) -> None:
        self._walks, self._prior = walks, prior

    def __call__(self, batch: int, length: int, seed: int) -> Feeds:  # noqa: ARG002  # the length is fixed
        """Inputs of TransNet; hidden frames hold noise."""
        rng = np.random.default_rng(seed)
        walked, _, _ = self._walks.histories(batch, seed, SEED)
        frames = rng.standard_normal((batch, FRAMES, WIDTH))
        frames[:, :SEED] = frames_to_goal(walked, self._goals(walked[:, -1], rng))
        first_seen = FRAMES - 1 - np.arange(batch) % VISIBLE
        hidden = (np.arange(FRAMES) >= SEED) & (np.arange(FRAMES) < first_seen[:, None])
        targets = np.broadcast_to(self._targets(batch, seed)[:, None], frames.shape)
        frames = np.where((np.arange(FRAMES) >= first_seen[:, None])[..., None], targets, frames)
        return {"frames": frames.astype(np.float32), "hidden": hidden}

    def _goals(self, last: Array, rng: np.random.Generator) -> Floats:
        """(B, 3) where the targets stand in the world."""
        heading = np.arctan2(last[:, 2], last[:, 8])
        ahead, aside = rng.uniform(*AHEAD, len(last)), rng.uniform(-ASIDE, ASIDE, len(last))
        x = last[:, 216] + ahead * np.sin(heading) + aside * np.cos(heading)
        z = last[:, 218] + ahead * np.cos(heading) - aside * np.sin(heading)
        return np.stack([x, z, heading + rng.uniform(-TURN, TURN, len(last))], axis=1)

    @torch.no_grad()
    def _targets(self, count: int, seed: int) -> Array:
        """(B, 219) poses of the prior that touch the ground at the origin."""
        latents = np.random.default_rng(seed).standard_normal((count, self._prior.config["latent"])).astype(np.float32)
        frames = np.zeros((count, WIDTH), np.float32)
        frames[:, :216] = self._prior.decode(torch.from_numpy(latents)).flatten(1).numpy()
        frames[:, 217] = -to_motion(frames).positions()[..., 1].min(axis=1)
        return frames
