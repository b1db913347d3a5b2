"""The denoiser of motions: the clean ``ego77`` motion in a noisy one, told by a text and by what is to be kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Arrays, Sessions
from motionrt.models.temos import checked_tokens
from motionrt.models.text import FloatArray, IntArray
from motionrt.motion.features import ego77

MODEL = "motion_denoiser"
OUTPUTS = ("clean", "motion")

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Told:
    """What the denoiser is told about motions of ``F`` frames, ``B`` rows each.

    Attributes:
        token_features, attention_mask: ``(B, T, 384)`` and ``(B, T)`` int64; see :class:`SentenceEncoder`.
        slots: ``(B, S)`` int64 classes of :data:`motionrt.text.SLOTS`, 0 where unknown.
        numbers, known: ``(B, A)`` of :data:`motionrt.text.TARGETS`, and which of them are given.
        held, holding: raw features ``(B, F, 77)`` to be kept, and ``(B, F, 6)`` which of
            :data:`motionrt.PARTS` of which frames: the joints of a part, or, for ``global``, the root's way and height.
    """

    token_features: FloatArray
    attention_mask: IntArray
    slots: IntArray
    numbers: FloatArray
    known: BoolArray
    held: FloatArray
    holding: BoolArray


class MotionDenoiser:
    """Estimates clean motions. Rows of one call share the scale of their activations in the shipped int8 file.

    Args:
        sessions: open models.
        variant: which file, e.g. ``fp32``; by default what the manifest says.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    def __call__(
        self, noisy: FloatArray, level: FloatArray, told: Told, guidance: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Estimates of the clean motions ``(B, F, 77)`` float32: normalised, and in the units of ``ego77``.

        Args:
            noisy: ``(B, F, 77)`` normalised motions with noise, F from 1 to 200.
            level: ``(B,)`` standard deviations of the noise.
            told: what they should be.
            guidance: ``(B, 2)`` weights of classifier-free guidance, for the way of the root and for the rest.

        Raises:
            InvalidInputError: another shape, or a motion that is not finite.
        """
        rows = np.ascontiguousarray(noisy, np.float32)
        if rows.ndim != 3 or rows.shape[2] != ego77.WIDTH or not 1 <= rows.shape[1] <= 200:
            raise InvalidInputError(f"expected ego77 motions (B, 1 to 200, {ego77.WIDTH}), found shape {rows.shape}")
        if not np.isfinite(rows).all():
            raise InvalidInputError("the motion holds a value that is not finite")
        tokens, words = checked_tokens(told.token_features, told.attention_mask)
        feeds: Arrays = {
            "noisy": rows, "level": np.asarray(level, np.float32), "mask": np.ones(rows.shape[:2], bool),
            "token_features": tokens, "attention_mask": words, "slots": told.slots, "numbers": told.numbers,
            "known": told.known, "held": told.held, "holding": told.holding,
            "guidance": np.asarray(guidance, np.float32),
        }  # fmt: skip
        clean, motion = self.sessions.run(MODEL, list(OUTPUTS), feeds, self.variant)
        return clean, motion
