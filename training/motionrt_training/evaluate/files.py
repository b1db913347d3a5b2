"""The same recording through two file formats: how alike are their embeddings?"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt import Motion
from motionrt.formats import load_motion
from motionrt.retrieval.windows import WINDOW_FRAMES, motion_features
from motionrt_training.evaluate.embedders import Embedder

_MOST = 6  # frames at 60 fps


@dataclass(frozen=True)
class FilesRow:
    """Cosines of the first 10 s of both files of each recording, trimmed to the shorter.

    Attributes:
        mean, least: as the files begin.
        least_aligned: after the later start of one of the two is cut from the other.
        recordings: how many.
    """

    mean: float
    least: float
    least_aligned: float
    recordings: int


def compare_files(embedder: Embedder, cmu: str | Path) -> FilesRow:
    """Every recording of ``cmu/pairs`` (``.amc``, 60 fps, skeletons in ``cmu/asf``) beside its ``cmu/bvh``."""
    folder, cosines = Path(cmu), []
    for second in sorted((folder / "pairs").glob("*.amc")):
        first = folder / "bvh" / f"{second.stem}.bvh"
        skeleton = folder / "asf" / f"{second.stem.split('_')[0]}.asf"
        one, other = load_motion(first), load_motion(second, asf=skeleton, fps=60.0)
        late = later_start(one, other)
        cosines.append((_cosine(embedder, one, other), _cosine(embedder, _from(one, late), _from(other, -late))))
    begun, aligned = np.array(cosines).T
    return FilesRow(float(begun.mean()), float(begun.min()), float(aligned.min()), len(cosines))


def later_start(one: Motion, other: Motion) -> float:
    """Seconds of ``one``, at most 0.1, before ``other`` begins; negative where ``one`` begins later.

    Joints about the pelvis lie nearest to each other there.
    """
    step = 1 / 60
    near = {}
    for late in range(-_MOST, _MOST + 1):
        begun = _from(one, late * step), _from(other, -late * step)
        joints = [motion.resample(60).positions() for motion in begun]
        frames = min(map(len, joints))
        about = [each[:frames] - each[:frames, :1] for each in joints]
        near[late] = float(np.linalg.norm(about[0] - about[1], axis=-1).mean())
    return min(near, key=near.__getitem__) * step


def _from(motion: Motion, seconds: float) -> Motion:
    return motion.between(max(seconds, 0.0), motion.duration)


def _cosine(embedder: Embedder, *motions: Motion) -> float:
    shorter = min(motion.duration for motion in motions)
    features = [motion_features(motion.between(0.0, shorter))[:WINDOW_FRAMES] for motion in motions]
    one, other = embedder.embed_motion(features)
    return float(one @ other)
