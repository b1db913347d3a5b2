"""Measures of walking and acting, as the commands print them."""

from __future__ import annotations

from collections.abc import Mapping

from motionrt.cli.console import print_table

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
    ("transition_end_cm", "off the ends of transitions", 1, "cm"),
)


def print_measures(measures: Mapping[str, float | int | None]) -> None:
    """A short table of those that there are."""
    found = [(label, measures.get(name), factor, unit) for name, label, factor, unit in _ROWS]
    rows = [[label, f"{factor * value:.2f}", unit] for label, value, factor, unit in found if value is not None]
    print_table(["measure", "value", "unit"], rows, "<><")


def rounded(measures: Mapping[str, float | int | None]) -> dict[str, float | int | None]:
    """For ``--json``: six digits behind the point."""
    return {name: round(value, 6) if isinstance(value, float) else value for name, value in measures.items()}
