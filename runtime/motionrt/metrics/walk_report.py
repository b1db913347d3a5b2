"""All measures of one walk in one record, as ``--json`` prints them."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from motionrt.metrics.locomotion import (
    drift,
    foot_skate,
    foot_skates,
    jerk,
    path_distances,
    standing_height,
    waypoint_distances,
)

ARRIVAL_RADIUS = 0.35  # metres


@dataclass(frozen=True)
class LocomotionMeasures:
    """Measures of a walk; those of a path or of waypoints are ``None`` where there was none.

    Drifts are the mean of the last seconds minus the mean of the first (:func:`motionrt.metrics.locomotion.drift`).

    Attributes:
        frames: number of frames.
        seconds: their duration.
        distance_m: length of the root's way in the ground plane.
        foot_skate_cm: cm per frame.
        foot_skate_drift_cm: cm per frame.
        jerk: m/s^3, mean over the joints.
        standing_height_m: median height of the pelvis.
        height_drift_cm: of the pelvis.
        path_deviation_m: mean distance of the root from the path.
        path_deviation_max_m: the largest.
        path_deviation_drift_m: its drift.
        goal_distance_m: from the root in the last frame to the end of the path.
        waypoints_reached: share, 0 to 1, that the root passed within the radius.
        waypoint_distance_max_m: the worst of the closest distances to the waypoints.
    """

    frames: int
    seconds: float
    distance_m: float
    foot_skate_cm: float
    foot_skate_drift_cm: float
    jerk: float
    standing_height_m: float
    height_drift_cm: float
    path_deviation_m: float | None = None
    path_deviation_max_m: float | None = None
    path_deviation_drift_m: float | None = None
    goal_distance_m: float | None = None
    waypoints_reached: float | None = None
    waypoint_distance_max_m: float | None = None

    @classmethod
    def of(
        cls,
        positions: npt.ArrayLike,
        fps: float,
        path: npt.ArrayLike | None = None,
        waypoints: npt.ArrayLike | None = None,
        *,
        radius: float = ARRIVAL_RADIUS,
        window_s: float = 30.0,
        floor: float = 0.0,
    ) -> LocomotionMeasures:
        """Measure a walk of at least four frames.

        Args:
            positions: ``(F, 24, 3)`` global joints of ``smpl24``, metres.
            fps: frames per second.
            path: ``(N, 2)`` (x, z) corners of the polyline that the root should follow, metres.
            waypoints: ``(M, 2)`` (x, z) points that it should pass, metres.
            radius: how near counts as passed, metres.
            window_s: seconds at the beginning and at the end that drifts compare.
            floor: height in metres of the toe joint of a standing foot.
        """
        joints = np.asarray(positions, dtype=np.float64)
        skate, walk_jerk = foot_skate(joints, floor), jerk(joints, fps)
        root = joints[:, 0, [0, 2]]
        return cls(
            frames=len(joints),
            seconds=len(joints) / fps,
            distance_m=float(np.linalg.norm(np.diff(root, axis=0), axis=1).sum()),
            foot_skate_cm=skate,
            foot_skate_drift_cm=drift(foot_skates(joints, floor), fps, window_s),
            jerk=walk_jerk,
            standing_height_m=standing_height(joints),
            height_drift_cm=100 * drift(joints[:, 0, 1], fps, window_s),
            **({} if path is None else _along(root, path, fps, window_s)),
            **({} if waypoints is None else _past(root, waypoints, radius)),
        )

    def as_dict(self) -> dict[str, float | int | None]:
        """Plain numbers by name, for JSON."""
        return asdict(self)


def _along(root: npt.NDArray[np.float64], path: npt.ArrayLike, fps: float, window_s: float) -> dict[str, float]:
    distances = path_distances(root, path)
    return {
        "path_deviation_m": float(distances.mean()),
        "path_deviation_max_m": float(distances.max()),
        "path_deviation_drift_m": drift(distances, fps, window_s),
        "goal_distance_m": float(np.linalg.norm(root[-1] - np.asarray(path, dtype=np.float64)[-1])),
    }


def _past(root: npt.NDArray[np.float64], waypoints: npt.ArrayLike, radius: float) -> dict[str, float]:
    closest = waypoint_distances(root, waypoints)
    return {
        "waypoints_reached": float((closest <= radius).mean()),
        "waypoint_distance_max_m": float(closest.max()),
    }
