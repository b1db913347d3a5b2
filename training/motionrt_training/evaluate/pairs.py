"""The captioned motions that are evaluated."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.windows import WINDOW_FRAMES
from motionrt_training.packed import load_packed


@dataclass(frozen=True)
class PairSet:
    """Captioned motions of one split: ``motions`` raw ``guo263`` at 20 fps, ``texts[i]`` the captions of motion i."""

    ids: tuple[str, ...]
    motions: tuple[FloatArray, ...]
    texts: tuple[tuple[str, ...], ...]

    def __len__(self) -> int:
        return len(self.ids)

    def captions(self, style: int) -> list[str]:
        """One caption for each motion: the one in place ``style`` (cyclic, where a motion has fewer)."""
        return [texts[style % len(texts)] for texts in self.texts]


def read_pairs(path: str | Path, split: str, source: str | None = None) -> PairSet:
    """The pairs of ``split`` in a packed corpus, all or those of one source; InvalidInputError when it has none."""
    corpus = load_packed(path)
    clips = [clip for clip in corpus.split(split) if source in (None, clip.source)]
    if not clips:
        raise InvalidInputError(f"{path} has no clips in split '{split}'" + (f" of {source}" if source else ""))
    motions = tuple(corpus.motion(clip)[:WINDOW_FRAMES].astype(np.float32) for clip in clips)
    return PairSet(tuple(clip.id for clip in clips), motions, tuple(clip.texts for clip in clips))


def sources_of(path: str | Path, split: str) -> list[str]:
    """The named sources of a split, where there are several; else none, as all of it is one."""
    found = sorted({clip.source for clip in load_packed(path).split(split) if clip.source})
    return found if len(found) > 1 else []
