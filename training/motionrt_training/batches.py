"""Batches as a pure function of (seed, step): a resumed training sees what an uninterrupted one sees."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from motionrt_training.augment import Augmentation, View, draw_view
from motionrt_training.packed import PackedClip


class EpochPlan:
    """Which clips, and which views of them, form the batches of each epoch.

    Clips are shuffled; inside every `bucket` batches they are sorted by length, so that a batch pads little
    while its composition stays random from epoch to epoch.
    """

    def __init__(
        self, clips: Sequence[PackedClip], batch: int, rules: Augmentation, seed: int, bucket: int = 4
    ) -> None:
        if not clips:
            raise ValueError("no clips to train on")
        self.clips, self.rules, self.seed, self.bucket = clips, rules, seed, max(1, bucket)
        self.batch = min(batch, len(clips))
        self.per_epoch = len(clips) // self.batch
        self._epoch, self._plan = -1, list[list[tuple[int, View]]]()

    def at(self, step: int) -> list[tuple[int, View]]:
        """The (clip, view) pairs of a step's batch."""
        epoch, index = divmod(step, self.per_epoch)
        if epoch != self._epoch:
            self._epoch, self._plan = epoch, self._draw(epoch)
        return self._plan[index]

    def _draw(self, epoch: int) -> list[list[tuple[int, View]]]:
        rng = np.random.default_rng((self.seed, epoch))
        order = rng.permutation(len(self.clips))[: self.per_epoch * self.batch]
        views = [(int(clip), draw_view(self.clips[clip], self.rules, rng)) for clip in order]
        size = self.batch * self.bucket
        chunks = [views[i : i + size] for i in range(0, len(views), size)]
        flat = [item for chunk in chunks for item in sorted(chunk, key=lambda item: item[1].frames)]
        batches = [flat[i : i + self.batch] for i in range(0, len(flat), self.batch)]
        return [batches[i] for i in rng.permutation(len(batches))]


def padded(parts: Sequence[NDArray[np.floating]]) -> tuple[Tensor, Tensor]:
    """Ragged (T_i, D) arrays -> (B, max T, D) float32 with zeros behind, mask (B, max T) bool."""
    lengths = np.array([len(part) for part in parts])
    values = np.zeros((len(parts), int(lengths.max()), parts[0].shape[1]), dtype=np.float32)
    for row, part in zip(values, parts, strict=True):
        row[: len(part)] = part
    mask = np.arange(values.shape[1])[None] < lengths[:, None]
    return torch.from_numpy(values), torch.from_numpy(mask)
