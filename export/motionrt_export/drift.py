"""What small errors add up to: a file and the torch module walk the same paths, or fill the same gaps."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.metrics.locomotion import foot_skate, keypoint_error
from motionrt.metrics.walk_report import LocomotionMeasures
from motionrt.motion.features import ccf219
from motionrt_export.examples import Array
from motionrt_export.measures import Figures
from motionrt_export.references import Reference
from motionrt_export.transitions import Transitions
from motionrt_export.walks import Walked, Walks

SECOND = 30  # frames after which two walks are compared joint by joint
EVERY = 20  # steps of a walk from one single step that is compared to the next
LEAST_M, LEAST_CM = 0.02, 0.05  # smaller deviations from a path and smaller slides do not count as different

Floats = npt.NDArray[np.float64]


class WalkDrift:
    """N steps at stride 1. Errors move a footfall; how somebody walks must stay the same.

    A moved footfall changes all that follows, so two walks of equal quality differ by chance: the deviation from the
    path of 16 characters has a standard error of 9 % after 1,000 steps, as much for a rounding in the last bit as for
    int8. A single ratio beyond 5 % therefore says nothing, and what is held against the tolerance is the part of a
    difference that is beyond two standard errors, over twice as many characters. That alone would overlook a file that
    walks a little worse, so both also take single steps from the same frames, all along the walk that torch made:
    there nothing is left to chance, and what pulls a character aside shows in the mean of many steps.
    """

    def __init__(self, walks: Walks, *, steps: int = 1000, characters: int = 32) -> None:
        self._walks, self._steps, self._characters = walks, steps, characters

    def __call__(self, found: Reference, expected: Reference) -> Figures:
        """Figures of ``walk``; a ratio is ours to torch's less two standard errors, so 1 is as good, less is better."""
        history, _, _ = self._walks.histories(self._characters, seed=1)
        walked = [self._walks.walk(graph, history, self._steps, seed=2) for graph in (found, expected)]
        ours, theirs = (measures(walk) for walk in walked)
        soon = min(SECOND, self._steps) - 1
        return {
            "walk": {
                "joints_cm_after_1_s": keypoint_error(*(joints(walk.frames[:, soon]) for walk in walked)),
                "joints_cm_at_the_end": keypoint_error(*(joints(walk.frames[:, -1]) for walk in walked)),
                "path_deviation_ratio": beyond_chance(ours["path_m"], theirs["path_m"], LEAST_M),
                "foot_skate_ratio": beyond_chance(ours["skate_cm"], theirs["skate_cm"], LEAST_CM),
                "height_cm": 100.0 * abs(float(np.mean(ours["height_m"] - theirs["height_m"]))),
                "waypoints_missed": max(0.0, least_mean(theirs["reached"] - ours["reached"])),
                **self._steps_apart(found, expected, history, walked[1]),
            }
        }

    def _steps_apart(self, found: Reference, expected: Reference, history: Array, walked: Walked) -> dict[str, float]:
        """Distances of joints after single steps from the same frames, and the mean that their pelvises are apart."""
        asked = list(self._walks.asked(history, walked, EVERY))
        ours, theirs = (
            joints(np.concatenate([graph(feeds)["next"] for feeds in asked])) for graph in (found, expected)
        )
        pull = (ours - theirs)[:, 0, [0, 2]].mean(axis=0)  # of the pelvis over the ground, seen from the goal
        return {
            "step_cm": 100.0 * float(np.sqrt(((ours - theirs) ** 2).sum(axis=-1).mean())),
            "worst_step_cm": 100.0 * float(np.linalg.norm(ours - theirs, axis=-1).max()),
            "pull_cm_per_s": 100.0 * ccf219.FPS * float(np.linalg.norm(pull)),
        }


class TransitionDrift:
    """Gaps that both fill."""

    def __init__(self, transitions: Transitions, *, count: int = 32) -> None:
        self._transitions, self._count = transitions, count

    def __call__(self, found: Reference, expected: Reference) -> Figures:
        """Figures of ``transition``: distances of joints in the gap and in its last frame, ratio of the slides."""
        feeds = self._transitions(self._count, 0, seed=3)
        ours, theirs = (joints(graph(feeds)["motion"]) for graph in (found, expected))
        hidden = feeds["hidden"]
        rows, last = np.arange(len(hidden)), hidden.shape[1] - 1 - hidden[:, ::-1].argmax(axis=1)
        slides = [float(np.mean([foot_skate(motion) for motion in made])) for made in (ours, theirs)]
        return {
            "transition": {
                "joints_cm": keypoint_error(ours[hidden], theirs[hidden]),
                "end_cm": keypoint_error(ours[rows, last], theirs[rows, last]),
                "foot_skate_ratio": ratio(slides[0], slides[1], LEAST_CM),
            }
        }


def measures(walked: Walked) -> dict[str, Floats]:
    """Measures ``(C,)`` of the characters, each along its path as far as it has come."""
    reports = []
    for frames, goals, path in zip(walked.frames, walked.goals, walked.paths, strict=True):
        behind = path[: int((path == goals[-1]).all(axis=1).argmax()), :2]  # waypoints that were reached or passed
        line = np.concatenate([frames[:1, [216, 218]], behind, goals[-1:, :2]])
        reports.append(LocomotionMeasures.of(joints(frames), ccf219.FPS, line, behind if len(behind) else None))
    return {
        "path_m": np.array([report.path_deviation_m for report in reports]),
        "skate_cm": np.array([report.foot_skate_cm for report in reports]),
        "height_m": np.array([report.standing_height_m for report in reports]),
        "reached": np.array([report.waypoints_reached or 0.0 for report in reports]),
    }


def beyond_chance(ours: Floats, theirs: Floats, least: float) -> float:
    """The ratio of two means less two standard errors of its own (delta method, rows in pairs)."""
    whole = ratio(float(ours.mean()), float(theirs.mean()), least)
    shares = (ours + least - whole * (theirs + least)) / (float(theirs.mean()) + least)
    return whole + least_mean(shares)  # their mean is 0


def least_mean(values: Floats) -> float:
    """The mean of ``(C,)`` values less two standard errors; of a single one the value itself."""
    error = float(values.std(ddof=1)) / np.sqrt(len(values)) if len(values) > 1 else 0.0
    return float(values.mean()) - 2.0 * error


def ratio(ours: float, theirs: float, least: float) -> float:
    """Ours to theirs, where differences far below ``least`` are none."""
    return (ours + least) / (theirs + least)


def joints(frames: Array) -> Floats:
    """Joint positions (..., 24, 3), metres, of frames (..., 219) with the nearest proper rotations."""
    rows = ccf219.decode(np.asarray(frames, dtype=np.float32).reshape(-1, ccf219.WIDTH)).positions()
    return np.asarray(rows.reshape(*frames.shape[:-1], *rows.shape[1:]), dtype=np.float64)
