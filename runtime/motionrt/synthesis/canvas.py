"""A canvas of frames on which several texts hold at their times and for their parts of the body, denoised as one.

At every step of the sampling each text's piece is denoised by itself; where pieces overlap in time they pass into each
other, and every part of the body belongs to the piece that needs fewest parts (SINC 3.1). So transitions and seams are
generated and not cut (spatio-temporal stitching, Petrovich et al. 2024).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from motionrt.models.motion_denoiser import MotionDenoiser, Told
from motionrt.models.text import FloatArray, SentenceFeatures
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.synthesis.motion_diffusion import held_columns, solve
from motionrt.synthesis.smoothing import smoothed
from motionrt.text import TARGETS, TextAttributes

BoolArray = npt.NDArray[np.bool_]
OWNERS = held_columns()
LATE = 2.5
"""Noise level from which on corrections are made: before it, the estimate is still a mean of many motions."""
GUIDED = 2.0
"""Noise level down to which texts are guided: what is done is settled by then, and guidance would only stiffen it
(Kynkaanniemi et al. 2024)."""
PLAIN = (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Words:
    """A text as the denoiser is told it.

    Attributes:
        features: of the sentence encoder.
        slots: ``(S,)`` classes of what it says.
        numbers, known: ``(A,)`` what it stands for in numbers, and which of them it says.
        said: what it says.
    """

    features: SentenceFeatures
    slots: npt.NDArray[np.int64]
    numbers: FloatArray = field(default_factory=lambda: np.zeros(len(TARGETS), np.float32))
    known: BoolArray = field(default_factory=lambda: np.zeros(len(TARGETS), bool))
    said: TextAttributes = field(default_factory=lambda: TextAttributes(""))


@dataclass(frozen=True, eq=False)
class Piece:
    """A text on a stretch of the canvas.

    Attributes:
        words: the text.
        first: its first frame.
        weight: ``(F, 6)`` how much of every part of the body it owns in each of its frames.
    """

    words: Words
    first: int
    weight: FloatArray


@dataclass(frozen=True, eq=False)
class Held:
    """What is kept of a motion: raw ``ego77`` ``(F, 77)``, and ``(F, 6)`` which parts of which frames."""

    motion: FloatArray
    parts: BoolArray

    @classmethod
    def nothing(cls, frames: int) -> Held:
        """Nothing is kept."""
        return cls(np.zeros((frames, ego77.WIDTH), np.float32), np.zeros((frames, len(PARTS)), bool))

    def over(self, other: Held) -> Held:
        """Both; where both keep something, this one counts."""
        columns = self.parts[:, OWNERS]
        return Held(np.where(columns, self.motion, other.motion), self.parts | other.parts)


Correct = Callable[[FloatArray], Held]
"""A motion (F, 77), raw -> what must be different about it."""


@dataclass(frozen=True, eq=False)
class Canvas:
    """What is to be drawn.

    Attributes:
        pieces: texts and where they hold; every frame and part belongs to one at least.
        held: what is kept.
        ring: whether the last frame is followed by the first.
        correct: what is corrected at the late steps, so that targets are met.
    """

    pieces: Sequence[Piece]
    held: Held
    ring: bool = False
    correct: Correct | None = field(default=None)

    @property
    def frames(self) -> int:
        """Frames of the canvas."""
        return len(self.held.motion)


def draw(
    denoiser: MotionDenoiser, canvas: Canvas, noise: FloatArray, steps: int, guidance: tuple[float, float]
) -> FloatArray:
    """Raw ``ego77`` ``(F, 77)`` float32 of standard normal noise ``(F, 77)``."""
    held, raw = canvas.held, np.zeros_like(noise)

    def denoise(state: FloatArray, level: float) -> FloatArray:
        nonlocal held, raw
        weights = guidance if level >= GUIDED else PLAIN
        clean, raw = _estimate(denoiser, replace(canvas, held=held), state, level, weights)
        if canvas.correct is not None and level < LATE:
            held = canvas.correct(raw).over(canvas.held)
        return clean

    solve(denoise, noise, steps)
    raw = _calmed(raw, canvas.ring)
    last = canvas.held if canvas.correct is None else canvas.correct(raw).over(canvas.held)
    return np.asarray(np.where(last.parts[:, OWNERS], last.motion, raw), np.float32)


def _calmed(motion: FloatArray, ring: bool) -> FloatArray:
    """Without the small jumps between tokens, round the ring where it is one."""
    if not ring:
        return smoothed(motion)
    more = 4
    return smoothed(np.concatenate([motion[-more:], motion, motion[:more]]))[more:-more]


def _estimate(
    denoiser: MotionDenoiser, canvas: Canvas, state: FloatArray, level: float, guidance: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Estimates of the whole canvas, normalised and raw, put together of those of its pieces."""
    totals, share = [np.zeros_like(state) for _ in range(2)], np.zeros_like(state)
    for piece in canvas.pieces:
        places = piece.first + np.arange(len(piece.weight))
        places = places % canvas.frames if canvas.ring else places
        found = denoiser(
            state[None, places], np.array([level], np.float32), _told(piece.words, canvas.held, places),
            np.array([guidance], np.float32),
        )  # fmt: skip
        weight = piece.weight[:, OWNERS]
        for total, more in ((share, weight), *zip(totals, (weight * one[0] for one in found), strict=True)):
            if canvas.ring:  # a ring's piece laps over itself
                np.add.at(total, places, more)
            else:
                total[places[0] : places[-1] + 1] += more
    return totals[0] / share, totals[1] / share


def _told(words: Words, held: Held, places: npt.NDArray[np.intp]) -> Told:
    return Told(
        words.features.token_features, words.features.attention_mask, words.slots[None],
        words.numbers[None], words.known[None],
        held.motion[None, places], held.parts[None, places],
    )  # fmt: skip
