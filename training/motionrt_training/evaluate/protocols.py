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


@dataclass(frozen=True)
class Protocols:
    """How they are run.

    Attributes:
        styles: captions of so many styles are evaluated, each as a set of its own; 1 is the first caption, as in TMR.
        subset: how protocol (c) chooses, ``"farthest"`` (:func:`motionrt.metrics.most_dissimilar`) or ``"knapsack"``
            (:func:`motionrt.metrics.least_similar_sum`, as published).
    """

    styles: int = 4
    subset: str = "farthest"


SUBSETS = ("farthest", "knapsack")


def evaluate(
    embedder: Embedder, pairs: PairSet, sentences: SentenceEmbedding, how: Protocols | None = None
) -> list[ProtocolRow]:
    """All protocols: every motion against one caption of each style, results averaged over the styles."""
    how = how or Protocols()
    motions = embedder.embed_motion(pairs.motions)
    runs = []
    for style in range(how.styles):
        captions = pairs.captions(style)
        similarity = embedder.embed_text(captions) @ motions.T
        runs.append(_protocols(similarity, metrics.text_scores(sentences(captions)), how.subset))
    return [_average(name, pairs, [run[index][2] for run in runs]) for index, (name, pairs, _) in enumerate(runs[0])]


def by_style(embedder: Embedder, pairs: PairSet) -> list[ProtocolRow]:
    """Protocol (a) for each place in the lists of captions that all pairs have."""
    motions, styles = embedder.embed_motion(pairs.motions), min(map(len, pairs.texts))
    rows = []
    for style in range(styles):
        found = metrics.all_pairs(embedder.embed_text(pairs.captions(style)) @ motions.T)
        rows.append(ProtocolRow(f"caption {style + 1}", len(pairs), found.text_to_motion, found.motion_to_text))
    return rows


def _protocols(
    similarity: FloatArray, text_similarity: metrics.Floats, choice: str
) -> list[tuple[str, int, metrics.Retrieval]]:
    size = len(similarity)
    subset = max(1, min(100, size // 2))
    choose = metrics.least_similar_sum if choice == "knapsack" else metrics.most_dissimilar
    return [
        ("(a) all", size, metrics.all_pairs(similarity)),
        ("(b) all, threshold 0.95", size, metrics.all_with_threshold(similarity, text_similarity, 0.95)),
        ("(c) dissimilar subset", subset, metrics.dissimilar_subset(similarity, text_similarity, subset, choose)),
        ("(d) batches of 32", min(32, size), metrics.small_batches(similarity, 32)),
    ]


def _average(name: str, pairs: int, runs: list[metrics.Retrieval]) -> ProtocolRow:
    return ProtocolRow(
        name, pairs, _mean([run.text_to_motion for run in runs]), _mean([run.motion_to_text for run in runs])
    )


def _mean(rows: list[metrics.Scores]) -> metrics.Scores:
    recall = {k: float(np.mean([row.recall[k] for row in rows])) for k in rows[0].recall}
    return metrics.Scores(recall, float(np.mean([row.median_rank for row in rows])), rows[0].queries)
