"""Anchor poses: from a few keypoints to a plausible pose that meets them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.posing.body import Prior
from motionrt.locomotion.posing.objective import Objective
from motionrt.locomotion.posing.reach import reach_error
from motionrt.locomotion.posing.search import Found, Search
from motionrt.locomotion.posing.solution import PoseSolution, hover_cm, solution_of
from motionrt.locomotion.posing.starting import best_starts
from motionrt.locomotion.posing.targets import Targets, targets_of
from motionrt.metrics.penetration import Surfaces, checked_surfaces
from motionrt.untrusted.arguments import real
from motionrt.untrusted.words import shown

TOLERANCE_CM = 5.0
CLOSE_CM = 1.5  # a search that ends nearer than this is not repeated from another start
IN_REACH = 1.5  # metres from the middle of the keypoints beyond which surfaces are too far away to matter


def solve_pose(
    keypoints: Mapping[str, Sequence[float] | npt.ArrayLike],
    prior: Prior,
    *,
    heading: float | None = None,
    floor: float | None = 0.0,
    tolerance_cm: float = TOLERANCE_CM,
    surfaces: npt.ArrayLike | None = None,
    starts: int = 3,
    evaluations: int = 40,
) -> PoseSolution:
    """The most plausible pose whose joints lie at the keypoints (eq. 1 of "Continual").

    The search begins at those typical poses that come nearest, and ends early when one meets the keypoints. What the
    keypoints leave open is settled mildly: feet stand flat on the ground, the mass is above them, legs are straight,
    arms hang. Without ``heading`` the body faces as the keypoints suggest, two feet above all; one alone suggests
    nothing, and the body begins at +Z.

    Args:
        keypoints: ``{joint of smpl24: (x, y, z) metres}``, 1 to 24 of them; typical are pelvis + two feet or
            hand + two feet, where ``left_foot`` is the ball of the foot, at height 0 when it stands.
        prior: the pose prior.
        heading: yaw that the pelvis should have, radians from +Z towards +X; met within some degrees.
        floor: height of the ground, metres; None for none (a jump, a ladder).
        tolerance_cm: how far any keypoint may be missed.
        surfaces: ``(N, 3)`` points on everything that limbs shall keep out of, metres, at most about 10 cm apart,
            without the ground; what the keypoints ask for comes first. See :func:`motionrt.metrics.penetration`.
        starts: most typical poses that a search is begun at.
        evaluations: most evaluations of the objective for each of them.

    Raises:
        InvalidInputError: no keypoint, an unknown joint, numbers that are not finite, a tolerance below 0, surfaces
            that are no points.
        ReachError: a keypoint is missed by more than ``tolerance_cm``; says by how many centimetres each is.
    """
    if not real(tolerance_cm) >= 0:
        raise InvalidInputError(f"tolerance_cm must be 0 or more, not {shown(tolerance_cm)}")
    if starts < 1 or evaluations < 1:
        raise InvalidInputError("starts and evaluations must be 1 or more")
    targets = targets_of(keypoints, heading, floor)
    solid = None if surfaces is None else checked_surfaces(surfaces)
    solution = _solved(prior, targets, solid, starts, evaluations)
    hover = hover_cm(solution.motion, targets)
    if solution.max_error_cm > tolerance_cm or hover:
        raise reach_error(solution.errors_cm, targets.mapping(), tolerance_cm, hover)
    return solution


def _solved(
    prior: Prior, targets: Targets, solid: npt.NDArray[np.float64] | None, starts: int, evaluations: int
) -> PoseSolution:
    """The best end of the searches from the best starts.

    The search runs about the middle of the keypoints, so that it goes the same way everywhere in the world.
    """
    local = targets.moved(-targets.middle)
    search = Search(prior, Objective(local, surfaces=_near(solid, targets)))
    found: list[Found] = []
    for start in best_starts(prior, local, starts):
        found.append(search.run(start, evaluations))
        solution = solution_of(prior, found[-1], local, 0)
        if solution.max_error_cm < CLOSE_CM and not hover_cm(solution.motion, local):
            break
    best = min(found, key=lambda end: end.cost)
    in_world = replace(best, root=best.root + targets.middle)
    return solution_of(prior, in_world, targets, sum(end.iterations for end in found))


def _near(solid: npt.NDArray[np.float64] | None, targets: Targets) -> Surfaces | None:
    """The surfaces in reach, seen from the middle of the keypoints."""
    if solid is None:
        return None
    away = solid - targets.points.mean(axis=0)
    near = solid[(away**2).sum(axis=1) < IN_REACH**2] - targets.middle
    return Surfaces(near) if len(near) else None
