"""What is measured of making motion: texts to motions, latents to frames, two motions to one, a text to body parts."""

from __future__ import annotations

from itertools import cycle

import numpy as np

from motionrt.bench.timing import Call
from motionrt.bench.workload import TEXTS
from motionrt.locomotion.starting_poses import plain_stride
from motionrt.models.temos import LATENT
from motionrt.motion.features import sinc135
from motionrt.runtime import Runtime
from motionrt.synthesis.generating import Generator
from motionrt.synthesis.sampling import SAMPLERS, Sampling

FRAMES = 120
DECODE = f"decoder, {FRAMES} frames"
COMPOSE, BODY_PARTS = f"compose, 2 motions of {FRAMES} frames", "body parts of a text"


def generate_case(sampler: str) -> str:
    """Name of making a motion of a text with that sampler."""
    return f"text to {FRAMES} frames, {sampler}"


def generate_calls(generator: Generator) -> dict[str, Call]:
    """One motion of a text with every sampler, feet locked, as :meth:`motionrt.Runtime.generate` makes it."""
    return {generate_case(sampler): _generate_call(generator, sampler) for sampler in SAMPLERS}


def _generate_call(generator: Generator, sampler: str) -> Call:
    texts, how = cycle(TEXTS), Sampling(FRAMES / sinc135.FPS, seed=0, sampler=sampler)
    return lambda: generator.generate(next(texts), how)[0]


def decode_call(generator: Generator) -> Call:
    """The decoder alone: raw features of one latent."""
    latent = np.random.default_rng(0).standard_normal((1, LATENT), np.float32)
    mask = np.ones((1, FRAMES), bool)
    return lambda: generator.temos.decode(latent, mask)


def compose_call(runtime: Runtime) -> Call:
    """A walk whose right arm is that of another walk."""
    walk = plain_stride(FRAMES / sinc135.FPS)
    return lambda: runtime.compose([walk, walk], [None, "right arm"])


def parts_call(runtime: Runtime) -> Call:
    """The body parts that a text needs."""
    texts = cycle(TEXTS)
    return lambda: runtime.body_parts(next(texts))
