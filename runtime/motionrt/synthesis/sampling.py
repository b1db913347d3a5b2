"""How to generate: length, chance and sampler, checked once."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.limits import limits
from motionrt.models.text import FloatArray
from motionrt.motion.features import sinc135
from motionrt.untrusted.arguments import check_flags, checked_number, checked_whole
from motionrt.untrusted.words import shown

SAMPLERS = ("motion", "diffusion", "vae")
DEFAULT_SAMPLER = "motion"
SECONDS = 4.0
SHORTEST_S = 0.5
LONGEST_S = {"motion": 10.0, "diffusion": 8.0, "vae": 8.0}  # what the models were trained on
GUIDANCE, STEPS = 4.0, 10  # of latent diffusion
POSE_GUIDANCE, TURN_GUIDANCE, MOTION_STEPS = 5.0, 1.3, 12  # of diffusion in motion space; turns want little of it
MOST_STEPS = 1000
MOST_TEMPERATURE, MOST_GUIDANCE = 10.0, 100.0  # far beyond all that still looks like a motion


@dataclass(frozen=True)
class Sampling:
    """What :meth:`Generator.generate` should do with a text.

    Attributes:
        seconds: length, 0.5 to 10; the samplers "diffusion" and "vae" know 8 at most.
        seed: 0 or more; None draws one, which is then found here.
        n: how many motions.
        temperature: how far samples stray: 1 as trained, 0 not at all, at most 10.
        sampler: ``"motion"``, diffusion in motion space; ``"diffusion"``, latent diffusion; or ``"vae"``: straight from
            the text encoder's distribution.
        guidance: how much more the text counts than in training, for diffusion: 0 to 100; 1 is as trained. None takes
            that of the sampler.
        steps: calls of the denoiser, 1 to 1000, for diffusion; None takes those of the sampler.
        foot_lock: let standing feet stand still.

    Raises:
        InvalidInputError: any of them out of range; the message says what is possible.
    """

    seconds: float = SECONDS
    seed: int | None = None
    n: int = 1
    temperature: float = 1.0
    sampler: str = DEFAULT_SAMPLER
    guidance: float | None = None
    steps: int | None = None
    foot_lock: bool = True
    frames: int = field(init=False)

    def __post_init__(self) -> None:
        if not isinstance(self.sampler, str) or self.sampler not in SAMPLERS:
            raise InvalidInputError(f"unknown sampler {shown(self.sampler)}; choose one of: {', '.join(SAMPLERS)}")
        _set(self, "seconds", checked_number(self.seconds, "seconds", SHORTEST_S, LONGEST_S[self.sampler]))
        _set(self, "frames", round(self.seconds * sinc135.FPS))
        _set(self, "temperature", checked_number(self.temperature, "temperature", 0.0, MOST_TEMPERATURE))
        weight, steps = (POSE_GUIDANCE, MOTION_STEPS) if self.sampler == "motion" else (GUIDANCE, STEPS)
        _set(self, "guidance", checked_number(_or(self.guidance, weight), "guidance", 0.0, MOST_GUIDANCE))
        _set(self, "n", checked_whole(self.n, "n", 1, limits().motions))
        _set(self, "steps", checked_whole(_or(self.steps, steps), "steps", 1, MOST_STEPS))
        _set(self, "seed", fresh_seed() if self.seed is None else checked_whole(self.seed, "seed", 0))
        check_flags(foot_lock=self.foot_lock)

    @property
    def weight(self) -> float:
        """The guidance, checked."""
        return float(self.guidance or 0.0)

    @property
    def turn_weight(self) -> float:
        """The guidance of the turn in motion space: as much as is meant is learnt already, more would turn too far."""
        return 1 + (self.weight - 1) * (TURN_GUIDANCE - 1) / (POSE_GUIDANCE - 1)

    @property
    def calls(self) -> int:
        """The steps, checked."""
        return int(self.steps or 1)

    def noise(self, sample: int, width: int) -> FloatArray:
        """``(width,)`` float32 for sample number ``sample``: the same however many samples there are."""
        stream = np.random.default_rng([self.seed or 0, sample])
        return np.float32(self.temperature) * stream.standard_normal(width, dtype=np.float32)

    def with_seconds(self, seconds: float) -> Sampling:
        """The same, of another length."""
        return replace(self, seconds=seconds)


def fresh_seed() -> int:
    """A seed that nobody chose."""
    return int(np.random.SeedSequence().generate_state(1)[0])


def _or(value: Any, default: float) -> Any:
    return default if value is None else value


def _set(sampling: Sampling, name: str, value: float) -> None:
    object.__setattr__(sampling, name, value)
