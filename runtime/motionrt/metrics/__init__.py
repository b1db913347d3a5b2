"""The papers' measures, NumPy only: retrieval ranks, recall and median rank, protocols, temporal overlap."""

from motionrt.metrics.protocols import (
    all_pairs,
    all_with_threshold,
    dissimilar_subset,
    most_dissimilar,
    small_batches,
)
from motionrt.metrics.ranking import RECALL_AT, Retrieval, Scores, ranks, retrieval, scores, text_scores
from motionrt.metrics.temporal import localisation_accuracy, temporal_iou

__all__ = [
    "RECALL_AT",
    "Retrieval",
    "Scores",
    "all_pairs",
    "all_with_threshold",
    "dissimilar_subset",
    "localisation_accuracy",
    "most_dissimilar",
    "ranks",
    "retrieval",
    "scores",
    "small_batches",
    "temporal_iou",
    "text_scores",
]
