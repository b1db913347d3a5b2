"""Retrieval by TMR's four protocols, averaged over the caption styles of the corpus."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from motionrt import metrics
from motionrt.motion.skeleton import FloatArray
from motionrt_training.evaluate.embedders import Embedder
from motionrt_training.evaluate.pairs import PairSet

SentenceEmbedding = Callable[[list[str]], FloatArray]  # texts -> unit sentence embeddings (N, 384)


@dataclass(frozen=True)
class ProtocolRow:
    """One protocol: how many pairs compete, recalls in percent and median ranks, both directions."""

    protocol: str
    pairs: int
    text_to_motion: metrics.Scores
    motion_to_text: metrics.Scores


def evaluate(embedder: Embedder, pairs: PairSet, sentences: SentenceEmbedding, styles: int = 4) -> list[ProtocolRow]:
    """All protocols: every motion against one caption of each of ``styles`` kinds, results averaged over the kinds."""
    motions = embedder.embed_motion(pairs.motions)
    runs = []
    for style in range(styles):
        captions = pairs.captions(style)
        similarity = embedder.embed_text(captions) @ motions.T
        runs.append(_protocols(similarity, metrics.text_scores(sentences(captions))))
    return [_average(name, pairs, [run[index][2] for run in runs]) for index, (name, pairs, _) in enumerate(runs[0])]


def by_style(embedder: Embedder, pairs: PairSet) -> list[ProtocolRow]:
    """Protocol (a) for each place in the lists of captions that all pairs have."""
    motions, styles = embedder.embed_motion(pairs.motions), min(map(len, pairs.texts))
    rows = []
    for style in range(styles):
        found = metrics.all_pairs(embedder.embed_text(pairs.captions(style)) @ motions.T)
        rows.append(ProtocolRow(f"caption {style + 1}", len(pairs), found.text_to_motion, found.motion_to_text))
    return rows


def _protocols(similarity: FloatArray, text_similarity: metrics.Floats) -> list[tuple[str, int, metrics.Retrieval]]:
    size = len(similarity)
    subset = min(100, size // 2)
    return [
        ("(a) all", size, metrics.all_pairs(similarity)),
        ("(b) all, threshold 0.95", size, metrics.all_with_threshold(similarity, text_similarity, 0.95)),
        ("(c) dissimilar subset", subset, metrics.dissimilar_subset(similarity, text_similarity, subset)),
        ("(d) batches of 32", min(32, size), metrics.small_batches(similarity, 32)),
    ]


def _average(name: str, pairs: int, runs: list[metrics.Retrieval]) -> ProtocolRow:
    return ProtocolRow(
        name, pairs, _mean([run.text_to_motion for run in runs]), _mean([run.motion_to_text for run in runs])
    )


def _mean(rows: list[metrics.Scores]) -> metrics.Scores:
    recall = {k: float(np.mean([row.recall[k] for row in rows])) for k in rows[0].recall}
    return metrics.Scores(recall, float(np.mean([row.median_rank for row in rows])), rows[0].queries)
