"""Text and motion in one space, and motion out of it: the TMR encoders and the decoder."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.engine import Providers
from motionrt.models.sessions import Arrays, Sessions
from motionrt.models.text import MODEL, SentenceEncoder, checked_texts

if TYPE_CHECKING:
    from onnxruntime import SessionOptions

FloatArray = npt.NDArray[np.float32]

TEXT, MOTION, DECODER = MODEL, "tmr_motion", "tmr_decoder"
DIMENSION = 256
FEATURES = 263


class TextMotionModel:
    """Embeds texts and motions into one space of unit vectors, and decodes its latents.

    Every model opens when it is first needed. Texts and motions go in one by one, so that an embedding never
    depends on what else was asked for.

    Args:
        models: the manifest or its folder, or open `Sessions`; None takes the models that came with motionrt.
        variant: which files, e.g. ``fp32``; by default what the manifest says of every model.
        threads: threads of every model, by default at most 2 of those that the process may use.
        session_options: options for every onnxruntime session, instead of ``threads``.
        providers: onnxruntime's execution providers, the preferred one first; by default the CPU.
        sentences: the sentence encoder, where there is one already.

    Raises:
        ModelFileError, ManifestError: no manifest, or a bad one.
    """

    name = "tmr"

    def __init__(
        self,
        models: str | Path | Sessions | None = None,
        *,
        variant: str | None = None,
        threads: int | None = None,
        session_options: SessionOptions | None = None,
        providers: Providers | None = None,
        sentences: SentenceEncoder | None = None,
    ) -> None:
        self.sessions = (
            models
            if isinstance(models, Sessions)
            else Sessions(models, threads=threads, session_options=session_options, providers=providers)
        )
        self.variant = variant
        self.sentences = sentences or SentenceEncoder(self.sessions, variant)
        self._prepared = False

    @cached_property
    def fingerprint(self) -> str:
        """sha256 over the checksums of the encoders: embeddings of equal fingerprints may be compared."""
        manifest = self.sessions.manifest
        chosen = {name: manifest.variant(name, self.variant) for name in (TEXT, MOTION)}
        lines = [f"{name} {variant.sha256}\n" for name, variant in chosen.items()]
        return hashlib.sha256("".join(lines).encode("ascii")).hexdigest()

    def embed_text(self, texts: Sequence[str]) -> FloatArray:
        """Unit embeddings ``(N, 256)`` float32.

        Raises:
            InvalidInputError: one string instead of a list, or a text that is no string or empty.
        """
        return _stacked([self._text(text, "embedding") for text in checked_texts(texts)])

    def text_latents(self, texts: Sequence[str]) -> FloatArray:
        """Latents ``(N, 256)`` float32, for `decode`; raises as `embed_text` does."""
        return _stacked([self._text(text, "latent") for text in checked_texts(texts)])

    def embed_motion(self, features: Sequence[FloatArray]) -> FloatArray:
        """Unit embeddings ``(N, 256)`` float32.

        Args:
            features: for every motion ``(F, 263)`` raw ``guo263`` features at 20 fps, any ``F`` from 1.

        Raises:
            InvalidInputError: another shape, or a value that is not finite.
        """
        return _stacked([self._motion(x, "embedding") for x in _checked_motions(features)])

    def motion_latents(self, features: Sequence[FloatArray]) -> FloatArray:
        """Latents ``(N, 256)`` float32, for `decode`; raises as `embed_motion` does."""
        return _stacked([self._motion(x, "latent") for x in _checked_motions(features)])

    def decode(self, latent: FloatArray, frames: int) -> FloatArray:
        """Raw ``guo263`` features ``(N, frames, 263)`` float32 at 20 fps of latents ``(N, 256)``.

        Raises:
            InvalidInputError: latents of another shape, or ``frames`` below 1.
        """
        rows = _checked_latents(latent)
        if isinstance(frames, bool) or not isinstance(frames, int) or frames < 1:
            raise InvalidInputError(f"frames must be a whole number from 1, not {frames!r}")
        if not len(rows):
            return np.zeros((0, frames, FEATURES), np.float32)
        mask = np.ones((1, frames), dtype=bool)
        return np.concatenate([self._decoded(row[None], mask) for row in rows])

    def prepare(self) -> None:
        """Start to open what texts need, beside whatever else is done meanwhile; what goes wrong is raised later."""
        if not self._prepared:
            self._prepared = True
            self.sessions.prepare(TEXT, variant=self.variant)

    def _text(self, text: str, output: str) -> FloatArray:
        self.prepare()  # the model opens while the tokenizer is read
        return self.sessions.run(TEXT, [output], self.sentences.feeds(text), self.variant)[0]

    def _motion(self, features: FloatArray, output: str) -> FloatArray:
        mask = np.ones((1, len(features)), dtype=bool)
        feeds: Arrays = {"motion": features[None], "mask": mask}
        return self.sessions.run(MOTION, [output], feeds, self.variant)[0]

    def _decoded(self, latent: FloatArray, mask: npt.NDArray[np.bool_]) -> FloatArray:
        feeds: Arrays = {"latent": latent, "mask": mask}
        return self.sessions.run(DECODER, ["motion"], feeds, self.variant)[0]


def _stacked(rows: list[FloatArray]) -> FloatArray:
    return np.concatenate(rows) if rows else np.zeros((0, DIMENSION), np.float32)


def _checked_motions(motions: Sequence[FloatArray]) -> list[FloatArray]:
    return [_checked_motion(motion, index) for index, motion in enumerate(motions)]


def _checked_motion(motion: FloatArray, index: int) -> FloatArray:
    array = np.ascontiguousarray(motion, dtype=np.float32)
    if array.ndim != 2 or array.shape[1] != FEATURES or not len(array):
        raise InvalidInputError(f"motion {index}: expected guo263 features (F, {FEATURES}), found shape {array.shape}")
    if not np.isfinite(array).all():
        raise InvalidInputError(f"motion {index}: its features hold a value that is not finite")
    return array


def _checked_latents(latent: FloatArray) -> FloatArray:
    array = np.ascontiguousarray(latent, dtype=np.float32)
    if array.ndim != 2 or array.shape[1] != DIMENSION:
        raise InvalidInputError(f"expected latents (N, {DIMENSION}), found shape {array.shape}")
    return array
