"""Packed corpora as training reads them: features of every clip and of its mirror image, with texts."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from motionrt.errors import InvalidInputError
from motionrt.motion.features import guo263
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24

Floats = TypeVar("Floats", NDArray[np.float16], NDArray[np.float32])


@dataclass(frozen=True)
class Window:
    """Frames [first, first + frames) of a clip: the slots measured there, and what may be said of just these frames."""

    first: int
    frames: int
    slots: tuple[int, ...] = ()
    slots_mirror: tuple[int, ...] = ()
    texts: tuple[str, ...] = ()  # none: the clip's own
    texts_mirror: tuple[str, ...] = ()


@dataclass(frozen=True)
class PackedClip:
    """One clip: frames [start, start + length) of the packed features, and what is said of it.

    `windows`, where the corpus was packed with them, are the stretches that training looks at; clips of one `group`
    show the same recording and are never negatives of each other.
    """

    id: str
    split: str
    start: int
    length: int
    texts: tuple[str, ...]
    texts_mirror: tuple[str, ...]
    windows: tuple[Window, ...] = ()
    group: str = ""
    source: str = ""


@dataclass(frozen=True)
class PackedCorpus:
    """guo263 at 20 fps, raw, float16: `features` (sum of lengths, 263); mirror images are made on the way out."""

    features: NDArray[np.float16]
    clips: tuple[PackedClip, ...]
    mirror: Callable[[NDArray[np.float16]], NDArray[np.float16]] = guo263.mirror  # features of the mirror image

    def split(self, name: str) -> list[PackedClip]:
        """The clips of a split, in file order."""
        return [clip for clip in self.clips if clip.split == name]

    def motion(self, clip: PackedClip, *, mirror: bool = False) -> NDArray[np.float16]:
        """(F, 263) of a clip or of its mirror image."""
        frames = self.features[clip.start : clip.start + clip.length]
        return self.mirror(frames) if mirror else frames

    def texts(self) -> list[str]:
        """Every text once, mirrored ones too, in order of appearance."""
        spoken = (text for clip in self.clips for part in (clip, *clip.windows) for text in _said(part))
        return list(dict.fromkeys(spoken))


def load_packed(path: str | Path) -> PackedCorpus:
    """Read the `.npz` that the corpora write; ValueError when an array is missing or does not fit."""
    with np.load(path, allow_pickle=False) as file:
        missing = {"features", "start", "length", "meta"} - set(file.files)
        if missing:
            raise ValueError(f"{path}: no array {', '.join(sorted(missing))}; pack the corpus again")
        meta = json.loads(str(file["meta"]))
        starts, lengths = file["start"].tolist(), file["length"].tolist()
        features = file["features"]
    if not len(meta) == len(starts) == len(lengths) or sum(lengths) != len(features):
        raise ValueError(f"{path}: its arrays do not fit each other; pack the corpus again")
    clips = [_clip(row, start, length) for row, start, length in zip(meta, starts, lengths, strict=True)]
    return PackedCorpus(features, tuple(clips))


def without_source(corpus: PackedCorpus, source: str) -> PackedCorpus:
    """The corpus with nothing of a source in train and val; its test clips stay, to be searched by who never saw them.

    Clips that name no source, such as those that join two others, may hold some of it and go as well.

    Raises:
        InvalidInputError: no clip is of that source.
    """
    sources = sorted({clip.source for clip in corpus.clips if clip.source})
    if source not in sources:
        raise InvalidInputError(f"no clip is of the source '{source}'; the corpus has {', '.join(sources) or 'none'}")
    gone = {source, ""}
    clips = (replace(c, split="left out") if c.source in gone and c.split != "test" else c for c in corpus.clips)
    return replace(corpus, clips=tuple(clips))


def statistics(corpus: PackedCorpus, *, equalise: bool = True) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Mean and floored standard deviation (263,) of the training split, mirror images included.

    `equalise`: one deviation per kind of feature (Guo et al. 2022), so that still joints are not blown up.
    """
    parts = [corpus.motion(clip, mirror=mirror) for clip in corpus.split("train") for mirror in (False, True)]
    if not parts:
        raise ValueError("the corpus has no clip in its train split")
    frames = np.concatenate(parts).astype(np.float64)
    std = frames.std(axis=0)
    if equalise and frames.shape[1] == GUO263_GROUPS[-1].stop:
        for group in GUO263_GROUPS:
            std[group] = std[group].mean()
    return frames.mean(axis=0).astype(np.float32), np.maximum(std, 1e-3).astype(np.float32)


# yaw velocity, planar velocity, height, positions 21x3, rotations 21x6, velocities 22x3, contacts 4
_EDGES = (0, 1, 3, 4, 67, 193, 259, 263)
GUO263_GROUPS = tuple(slice(first, last) for first, last in pairwise(_EDGES))
GUO263_RATES = np.r_[0:3, 193:259]  # features per frame: they scale with the speed of the motion


def _clip(row: dict[str, object], start: int, length: int) -> PackedClip:
    texts, mirror = row["texts"], row["texts_mirror"]
    if not isinstance(texts, list) or not isinstance(mirror, list) or len(texts) != len(mirror) or not texts:
        raise ValueError(f"clip {row['id']}: needs texts and as many texts_mirror")
    windows = tuple(_window(part) for part in cast("list[list[Any]]", row.get("windows", [])))
    group, source = str(row.get("group", row["id"])), str(row.get("source", ""))
    return PackedClip(
        str(row["id"]), str(row["split"]), start, length, tuple(texts), tuple(mirror), windows, group, source
    )


def _window(part: list[Any]) -> Window:
    first, frames, *lists = part
    return Window(first, frames, *(tuple(values) for values in lists))


def _said(part: PackedClip | Window) -> tuple[str, ...]:
    return (*part.texts, *part.texts_mirror)


def mirror_columns(features: Floats) -> Floats:
    """`guo263` features (..., 263) of the mirror image, but for the rotations, which stay: columns change places.

    A thousand times as fast as `guo263.mirror`, and equal to it up to the millimetres by which the left bones of that
    skeleton differ from the right ones.
    """
    return np.asarray(features[..., _SOURCE] * _SIGN.astype(features.dtype))


def _mirror_table() -> tuple[NDArray[np.int64], NDArray[np.float32]]:
    """For every column, the one that it becomes in the mirror (x = 0), and its sign."""
    source, sign = np.arange(guo263.WIDTH), np.ones(guo263.WIDTH, np.float32)
    partners = np.array(SMPL24.mirrored_joints[:SMPL22_JOINTS])
    blocks = (
        (guo263.POSITIONS, partners[1:] - 1, [-1, 1, 1]),
        (guo263.VELOCITIES, partners, [-1, 1, 1]),
        (guo263.CONTACTS, np.array([2, 3, 0, 1]), [1]),
    )
    for columns, order, signs in blocks:
        source[columns] = source[columns].reshape(len(order), -1)[order].ravel()
        sign[columns] = np.tile(signs, len(order))
    sign[[guo263.YAW_STEP, guo263.PLANAR.start]] = -1
    return source, sign


_SOURCE, _SIGN = _mirror_table()
