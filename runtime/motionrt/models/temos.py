"""TEMOS: texts and motions as distributions of one latent, and motions out of latents."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Arrays, Sessions
from motionrt.models.text import FloatArray, IntArray, SentenceFeatures
from motionrt.motion.features import sinc135

TEXT, MOTION, DECODER = "temos_text", "temos_motion", "temos_decoder"
LATENT = 256
TOKEN_WIDTH = 384


@dataclass(frozen=True, eq=False)
class LatentDistribution:
    """Normal distributions with diagonal covariance, one per row.

    Attributes:
        mu: ``(B, 256)`` float32, means.
        logvar: ``(B, 256)`` float32, logarithms of the variances.
    """

    mu: FloatArray
    logvar: FloatArray

    def at(self, noise: FloatArray) -> FloatArray:
        """``mu + exp(logvar / 2) * noise``: latents ``(B, 256)`` float32 of standard normal noise ``(B, 256)``."""
        return np.asarray(self.mu + np.exp(self.logvar / 2) * noise, np.float32)


class TemosModel:
    """The encoders and the decoder; each opens when it is first needed. Any number of rows in one call.

    The shipped int8 files scale their activations by the whole batch, so a row of several comes out a little different
    than alone: what has to be the same every time goes in one by one.

    Args:
        sessions: open models.
        variant: which files, e.g. ``fp32``; by default what the manifest says of every model.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    def encode_text(self, text: SentenceFeatures) -> LatentDistribution:
        """The distribution of the motions that texts ``(B, T)`` describe; see :class:`SentenceEncoder`.

        Raises:
            InvalidInputError: features that are not ``(B, T, 384)`` with a mask ``(B, T)``.
        """
        features, mask = checked_tokens(text.token_features, text.attention_mask)
        return self._encoded(TEXT, {"token_features": features, "attention_mask": mask})

    def encode_motion(self, features: FloatArray, mask: npt.NDArray[np.bool_] | None = None) -> LatentDistribution:
        """The distribution of motions.

        Args:
            features: ``(B, F, 135)`` raw ``sinc135`` at 30 fps, frame 0 above the origin and facing +Z.
            mask: ``(B, F)``, false for padding; by default there is none.

        Raises:
            InvalidInputError: another shape, a motion without frames, or a value that is not finite.
        """
        motion = np.ascontiguousarray(features, np.float32)
        if motion.ndim != 3 or motion.shape[2] != sinc135.WIDTH:
            raise InvalidInputError(f"expected sinc135 features (B, F, {sinc135.WIDTH}), found shape {motion.shape}")
        valid = np.ones(motion.shape[:2], bool) if mask is None else np.asarray(mask, bool)
        _check_mask(valid, motion.shape[:2])
        if not np.isfinite(motion[valid]).all():
            raise InvalidInputError("the features hold a value that is not finite")
        return self._encoded(MOTION, {"motion": motion, "mask": valid})

    def decode(self, latent: FloatArray, mask: npt.NDArray[np.bool_]) -> FloatArray:
        """Raw ``sinc135`` features ``(B, F, 135)`` float32 at 30 fps, zeros where ``mask`` is false.

        Args:
            latent: ``(B, 256)``.
            mask: ``(B, F)``, true for the frames wanted, which come first.

        Raises:
            InvalidInputError: another shape, a row without frames, or a latent that is not finite.
        """
        rows = checked_latents(latent)
        valid = np.asarray(mask, bool)
        _check_mask(valid, (len(rows), *valid.shape[1:]))
        return self.sessions.run(DECODER, ["motion"], {"latent": rows, "mask": valid}, self.variant)[0]

    def _encoded(self, model: str, feeds: Arrays) -> LatentDistribution:
        mu, logvar = self.sessions.run(model, ["mu", "logvar"], feeds, self.variant)
        return LatentDistribution(mu, logvar)


def checked_tokens(features: FloatArray, mask: IntArray) -> tuple[FloatArray, IntArray]:
    """Token features ``(B, T, 384)`` and their mask ``(B, T)`` as the graphs want them; InvalidInputError otherwise."""
    tokens, valid = np.ascontiguousarray(features, np.float32), np.asarray(mask, np.int64)
    if tokens.ndim != 3 or tokens.shape[2] != TOKEN_WIDTH or valid.shape != tokens.shape[:2]:
        expected = f"(B, T, {TOKEN_WIDTH}) and (B, T)"
        raise InvalidInputError(
            f"token features and mask must have the shapes {expected}, not {tokens.shape} and {valid.shape}"
        )
    return tokens, valid


def checked_latents(latent: FloatArray) -> FloatArray:
    """Latents ``(B, 256)`` as float32; InvalidInputError for another shape, or one that is not finite."""
    rows = np.ascontiguousarray(latent, np.float32)
    if rows.ndim != 2 or rows.shape[1] != LATENT:
        raise InvalidInputError(f"expected latents (B, {LATENT}), found shape {rows.shape}")
    if not np.isfinite(rows).all():
        raise InvalidInputError("a latent holds a number that is not finite")
    return rows


def _check_mask(mask: npt.NDArray[np.bool_], shape: tuple[int, ...]) -> None:
    if mask.ndim != 2 or mask.shape != shape:
        raise InvalidInputError(f"the mask must have one row of frames for each of {shape[0]}, not shape {mask.shape}")
    if not mask.any(axis=1).all():
        raise InvalidInputError("a motion needs at least one frame: a row of the mask is all false")
