"""The same recording through two file formats: how alike are their embeddings?"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.formats import load_motion
from motionrt.retrieval.windows import WINDOW_FRAMES, motion_features
from motionrt_training.evaluate.embedders import Embedder


@dataclass(frozen=True)
class FilesRow:
    """Cosines of the first 10 s of both files of each recording, trimmed to the shorter."""

    mean: float
    least: float
    recordings: int


def compare_files(embedder: Embedder, cmu: str | Path) -> FilesRow:
    """Every recording of ``cmu/pairs`` (``.amc``, 60 fps, skeletons in ``cmu/asf``) beside its ``cmu/bvh``."""
    folder, cosines = Path(cmu), []
    for second in sorted((folder / "pairs").glob("*.amc")):
        first = folder / "bvh" / f"{second.stem}.bvh"
        skeleton = folder / "asf" / f"{second.stem.split('_')[0]}.asf"
        motions = [load_motion(first), load_motion(second, asf=skeleton, fps=60.0)]
        shorter = min(motion.duration for motion in motions)
        features = [motion_features(motion.between(0.0, shorter))[:WINDOW_FRAMES] for motion in motions]
        one, other = embedder.embed_motion(features)
        cosines.append(float(one @ other))
    return FilesRow(float(np.mean(cosines)), float(np.min(cosines)), len(cosines))
