"""How far motions of a file are from those of torch: whole motions of latents, and latents drawn in many steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from motionrt.metrics.locomotion import foot_skate, keypoint_error
from motionrt.motion.features import ego77, sinc135
from motionrt.synthesis.diffusion import ddim
from motionrt.synthesis.motion_diffusion import solve
from motionrt.synthesis.sampling import GUIDANCE, MOTION_STEPS, POSE_GUIDANCE, STEPS, WAY_GUIDANCE
from motionrt_export.drift import LEAST_CM, ratio
from motionrt_export.examples import Array, Feeds, Motions
from motionrt_export.measures import Figures
from motionrt_export.noising import NoisyMotions
from motionrt_export.references import Reference

FRAMES = 120
MOTION_FRAMES = 80
TOKENS = 14  # of a text

Floats = npt.NDArray[np.float64]


class DecoderDrift:
    """Motions that both make of the latents of sentences, one by one as at run time."""

    def __init__(self, motions: Motions, *, count: int = 64) -> None:
        self._motions, self._count = motions, count

    def __call__(self, found: Reference, expected: Reference) -> Figures:
        """Figures of ``generation``."""
        latents = self._motions.decoder(self._count, 1, seed=1)["latent"]
        return {"generation": compared(*(decoded(decode, latents) for decode in (found, expected)))}


class DenoiserDrift:
    """Latents that both draw for sentences from the same noise, and what one decoder makes of them."""

    def __init__(self, motions: Motions, decode: Reference, *, count: int = 64) -> None:
        self._motions, self._decode, self._count = motions, decode, count

    def __call__(self, found: Reference, expected: Reference) -> Figures:
        """Figures of ``generation``, with those of the latents."""
        text = {"text_latent": self._motions.latents(self._motions.text(self._count, TOKENS, seed=1))}
        ours, theirs = (self._drawn(step, text) for step in (found, expected))
        figures = compared(*(decoded(self._decode, latents) for latents in (ours, theirs)))
        return {"generation": {**figures, "latent_rms_error": float(np.sqrt(np.square(ours - theirs).mean()))}}

    def _drawn(self, graph: Reference, text: Feeds) -> Array:
        noise = np.random.default_rng(2).standard_normal((self._count, 256), dtype=np.float32)
        rows = ({name: value[row : row + 1] for name, value in text.items()} for row in range(self._count))
        return np.concatenate([drawn(graph, row, start[None]) for row, start in zip(rows, noise, strict=True)])


class MotionDenoiserDrift:
    """Motions that both draw for sentences from the same noise, one by one as at run time."""

    def __init__(self, examples: NoisyMotions, *, count: int = 64) -> None:
        self._examples, self._count = examples, count

    def __call__(self, found: Reference, expected: Reference) -> Figures:
        """Figures of ``generation``."""
        told = [self._told(seed) for seed in range(self._count)]
        return {"generation": compared(*([solved(graph, feeds) for feeds in told] for graph in (found, expected)))}

    def _told(self, seed: int) -> Feeds:
        feeds = self._examples(1, MOTION_FRAMES, seed)
        guidance = np.array([[WAY_GUIDANCE, POSE_GUIDANCE]], np.float32)
        nothing = {"holding": np.zeros_like(feeds["holding"]), "known": np.zeros_like(feeds["known"])}
        return {**feeds, **nothing, "guidance": guidance, "noisy": feeds["noisy"] / (1 + feeds["level"])}


def solved(graph: Reference, feeds: Feeds) -> Floats:
    """Joints (F, 24, 3), metres, that the denoiser makes of its inputs, whose "noisy" is standard normal noise."""
    made: dict[str, Array] = {}

    def denoise(state: Array, level: float) -> Array:
        made.update(graph({**feeds, "noisy": state, "level": np.array([level], np.float32)}))
        return made["clean"]

    solve(denoise, feeds["noisy"], MOTION_STEPS)
    return ego77.decode(made["motion"][0])


def drawn(graph: Reference, text: Mapping[str, Array], noise: Array) -> Array:
    """Raw latents (B, 256) of texts, by DDIM from standard normal noise (B, 256)."""
    guidance = np.full(len(noise), GUIDANCE, np.float32)

    def denoise(latent: Array, timestep: Array) -> tuple[Array, Array]:
        made = graph({"latent": latent, "timestep": timestep, **text, "guidance": guidance})
        return made["clean"], made["latent_out"]

    return ddim(denoise, noise, STEPS)


def decoded(graph: Reference, latents: Array) -> list[Floats]:
    """Joints (F, 24, 3), metres, of the motion of every latent."""
    mask = np.ones((1, FRAMES), bool)
    motions = (graph({"latent": row[None], "mask": mask})["motion"][0] for row in latents)
    return [np.asarray(sinc135.decode(motion).positions(), np.float64) for motion in motions]


def compared(ours: Sequence[Floats], theirs: Sequence[Floats]) -> dict[str, float]:
    """Mean distance of the joints about the pelvis, of the pelvis on the ground at the end, and how far feet slide."""
    slides = [float(np.mean([foot_skate(joints) for joints in made])) for made in (ours, theirs)]
    first, second = np.stack(ours), np.stack(theirs)
    ends = first[:, -1, :1] - second[:, -1, :1]
    return {
        "joints_cm": keypoint_error(about_pelvis(first), about_pelvis(second)),
        "end_cm": 100.0 * float(np.linalg.norm(ends[..., [0, 2]], axis=-1).mean()),
        "foot_skate_ratio": ratio(slides[0], slides[1], LEAST_CM),
    }


def about_pelvis(joints: Floats) -> Floats:
    """Joints (..., 24, 3) with the pelvis at x = z = 0."""
    return joints - joints[..., :1, :] * np.array([1.0, 0.0, 1.0])
