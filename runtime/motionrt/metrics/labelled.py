"""Measures of walking and acting under names and in units for people."""

from __future__ import annotations

from collections.abc import Mapping

HEADER = ("measure", "value", "unit")
_ROWS: tuple[tuple[str, str, float, str], ...] = (  # name, label, factor, unit
    ("seconds", "duration", 1, "s"),
    ("distance_m", "distance", 1, "m"),
    ("path_deviation_m", "off the path, mean", 100, "cm"),
    ("path_deviation_max_m", "off the path, most", 100, "cm"),
    ("off_path_m", "off the paths, mean", 100, "cm"),
    ("goal_distance_m", "off the goal", 100, "cm"),
    ("waypoints_reached", "waypoints reached", 100, "%"),
    ("foot_skate_cm", "foot skate", 1, "cm/frame"),
    ("height_drift_cm", "drift in height", 1, "cm"),
    ("keypoint_cm", "off the keypoints, mean", 1, "cm"),
    ("keypoint_max_cm", "off the keypoints, most", 1, "cm"),
    ("penetration_share", "frames with limbs in surfaces", 100, "%"),
    ("penetration_max_cm", "limbs in surfaces, most", 1, "cm"),
    ("transition_end_cm", "off the ends of transitions", 1, "cm"),
)


def labelled(measures: Mapping[str, float | int | None]) -> list[list[str]]:
    """Rows under :data:`HEADER` of those measures that there are."""
    found = [(label, measures.get(name), factor, unit) for name, label, factor, unit in _ROWS]
    return [[label, f"{factor * value:.2f}", unit] for label, value, factor, unit in found if value is not None]
