"""Ways to make a motion of two actions, the rows of SINC's tables."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from motionrt.motion import Motion
from motionrt.synthesis.composing import combination
from motionrt.synthesis.generating import Generator
from motionrt.synthesis.sampling import Sampling
from motionrt_training.evaluate.latents import Latents, drawn
from motionrt_training.evaluate.simultaneous import ActionPair

Way = Callable[[ActionPair, int], list[Motion]]  # the motion of the mean latent, then so many samples
Labeller = Callable[[str], Iterable[str]]


def said(model: Latents) -> Way:
    """Both actions in one sentence: "label 1 and label 2"."""
    return lambda pair, samples: _spoken(model, pair, [pair.sentence], samples)


def separate(model: Latents) -> Way:
    """Two texts that are encoded separately, for networks that were trained so (STE)."""
    return lambda pair, samples: _spoken(model, pair, [pair.first.text, pair.second.text], samples)


def composed(model: Latents, labeller: Labeller | None = None) -> Way:
    """Each action alone, and the two motions composed; body parts are those of the labels, or a labeller's."""

    def make(pair: ActionPair, samples: int) -> list[Motion]:
        actions = (pair.first, pair.second)
        motions = [_spoken(model, pair, [action.text], samples, stream) for stream, action in enumerate(actions)]
        parts = [action.parts if labeller is None else labeller(action.text) for action in actions]
        return [together(first, second, *parts) for first, second in zip(*motions, strict=True)]

    return make


def together(first: Motion, second: Motion, parts_first: Iterable[str], parts_second: Iterable[str]) -> Motion:
    """Two motions composed as SINC does at test time: where both want a part, the one with fewer parts gets it."""
    which = combination(parts_first, parts_second, override=True)
    rotations, root = which.apply((first.rotations, first.root), (second.rotations, second.root))
    return dataclasses.replace(first, rotations=rotations, root=root)


def first_pose(pair: ActionPair, samples: int) -> list[Motion]:
    """A floor: the recording's first pose, held."""
    still = [0] * pair.truth.frames
    held = dataclasses.replace(pair.truth, rotations=pair.truth.rotations[still], root=pair.truth.root[still])
    return [held] * (samples + 1)


def diffused(generator: Generator) -> Way:
    """Both actions in one sentence, by latent diffusion; in place of the mean latent's motion one without noise."""

    def make(pair: ActionPair, samples: int) -> list[Motion]:
        how = Sampling(pair.truth.duration, seed=0, temperature=0.0, sampler="diffusion")
        draws = [how, *([dataclasses.replace(how, n=samples, temperature=1.0)] if samples else [])]
        latents = [latent for draw in draws for latent in generator.latents(pair.sentence, draw)]
        return [generator.decode(latent[None], pair.truth.frames)[0] for latent in latents]

    return make


WAYS: dict[str, Callable[[Latents], Way]] = {"text": said, "compose": composed, "separate": separate}


def _spoken(model: Latents, pair: ActionPair, texts: Sequence[str], samples: int, stream: int = 0) -> list[Motion]:
    """As long as the truth; the noise of a pair is the same in every row of a table."""
    rng = np.random.default_rng([stream, *pair.id.encode("utf-8")])
    return [model.decode(latent, pair.truth.frames) for latent in drawn(model, texts, samples, rng)]
