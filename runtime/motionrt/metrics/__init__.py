"""The papers' measures, NumPy only: retrieval ranks and recall, protocols, temporal overlap, locomotion, generation."""

from motionrt.metrics.footing import Footing, footing
from motionrt.metrics.generation import Body, PositionErrors, ape, ave, temos_scores
from motionrt.metrics.locomotion import (
    EndError,
    PathDeviation,
    drift,
    end_error,
    foot_skate,
    jerk,
    keypoint_error,
    motion_energy,
    path_deviation,
    standing_height,
    waypoint_distances,
    waypoints_reached,
)
from motionrt.metrics.matching import chance, matching, matching_ranks
from motionrt.metrics.part_labels import PartAccuracy, part_accuracy
from motionrt.metrics.penetration import Penetration, penetration, penetration_depths
from motionrt.metrics.protocols import (
    all_pairs,
    all_with_threshold,
    dissimilar_subset,
    least_similar_sum,
    most_dissimilar,
    small_batches,
)
from motionrt.metrics.ranking import RECALL_AT, Retrieval, Scores, ranks, retrieval, scores, text_scores
from motionrt.metrics.temporal import localisation_accuracy, temporal_iou
from motionrt.metrics.variety import diversity, frechet_distance, multimodality
from motionrt.metrics.walk_report import LocomotionMeasures

__all__ = [
    "RECALL_AT",
    "Body",
    "EndError",
    "Footing",
    "LocomotionMeasures",
    "PartAccuracy",
    "PathDeviation",
    "Penetration",
    "PositionErrors",
    "Retrieval",
    "Scores",
    "all_pairs",
    "all_with_threshold",
    "ape",
    "ave",
    "chance",
    "dissimilar_subset",
    "diversity",
    "drift",
    "end_error",
    "foot_skate",
    "footing",
    "frechet_distance",
    "jerk",
    "keypoint_error",
    "least_similar_sum",
    "localisation_accuracy",
    "matching",
    "matching_ranks",
    "most_dissimilar",
    "motion_energy",
    "multimodality",
    "part_accuracy",
    "path_deviation",
    "penetration",
    "penetration_depths",
    "ranks",
    "retrieval",
    "scores",
    "small_batches",
    "standing_height",
    "temos_scores",
    "temporal_iou",
    "text_scores",
    "waypoint_distances",
    "waypoints_reached",
]
