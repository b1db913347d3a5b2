"""The papers' measures, NumPy only: retrieval ranks and recall, protocols, temporal overlap, locomotion."""

from motionrt.metrics.locomotion import (
    EndError,
    PathDeviation,
    drift,
    end_error,
    foot_skate,
    jerk,
    keypoint_error,
    path_deviation,
    standing_height,
    waypoint_distances,
    waypoints_reached,
)
from motionrt.metrics.protocols import (
    all_pairs,
    all_with_threshold,
    dissimilar_subset,
    most_dissimilar,
    small_batches,
)
from motionrt.metrics.ranking import RECALL_AT, Retrieval, Scores, ranks, retrieval, scores, text_scores
from motionrt.metrics.temporal import localisation_accuracy, temporal_iou
from motionrt.metrics.walk_report import LocomotionMeasures

__all__ = [
    "RECALL_AT",
    "EndError",
    "LocomotionMeasures",
    "PathDeviation",
    "Retrieval",
    "Scores",
    "all_pairs",
    "all_with_threshold",
    "dissimilar_subset",
    "drift",
    "end_error",
    "foot_skate",
    "jerk",
    "keypoint_error",
    "localisation_accuracy",
    "most_dissimilar",
    "path_deviation",
    "ranks",
    "retrieval",
    "scores",
    "small_batches",
    "standing_height",
    "temporal_iou",
    "text_scores",
    "waypoint_distances",
    "waypoints_reached",
]
