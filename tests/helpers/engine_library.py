"""A library of random clips for the tests of engines."""

from __future__ import annotations

import numpy as np
from engine_servers import STAMP

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval import Caption, Clip, Gallery
from motionrt.retrieval.records import window_table

CLIPS = 300


def library(count: int = CLIPS, seed: int = 0) -> Gallery:
    """Clips of one to three windows in folders, with attributes and tags."""
    draw = np.random.default_rng(seed)
    counts = draw.integers(1, 4, count)
    spans = [[(5.0 * k, 5.0 * k + 10) for k in range(n)] for n in counts]
    vectors = draw.normal(size=(int(counts.sum()), 256))
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    ids = sorted(f"{'abc'[n % 3]}/{'ä' * (n % 2)}clip'{n:05d}.bvh" for n in range(count))
    clips = tuple(Clip(name, part[-1][1], text=f"text {name}") for name, part in zip(ids, spans, strict=True))
    captions = tuple(
        Caption(name, "", tags=("Slow",) if n % 5 == 0 else ("quick", "loop")) for n, name in enumerate(ids)
    )
    attributes = draw.normal(0, 40, (len(vectors), len(ATTRIBUTES))).astype(np.float32)
    return Gallery(
        clips, vectors.astype(np.float32), window_table(spans), STAMP, attributes=attributes, captions=captions
    )
