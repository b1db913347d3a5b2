"""What no skeleton can do: keypoints further apart than the bones between them are long."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from motionrt.errors import ReachError
from motionrt.motion import SMPL24, Skeleton
from motionrt.motion.skeleton import FloatArray

Keypoints = Mapping[str, FloatArray]


def longest_reach(first: str, second: str, skeleton: Skeleton = SMPL24) -> float:
    """Metres of bone between two joints: no pose brings them further apart."""
    chains = [_to_root(skeleton.index(name), skeleton) for name in (first, second)]
    apart = set(chains[0]) ^ set(chains[1])  # the joints whose bones lie between the two
    return float(sum(np.linalg.norm(skeleton.offsets[joint]) for joint in apart))


def overstretched(keypoints: Keypoints, skeleton: Skeleton = SMPL24) -> list[tuple[str, str, float, float]]:
    """(joint, joint, metres apart, metres of reach) of every pair of keypoints that is too far apart."""
    found = []
    for first, second in combinations(keypoints, 2):
        distance = float(np.linalg.norm(np.subtract(keypoints[first], keypoints[second])))
        reach = longest_reach(first, second, skeleton)
        if distance > reach:
            found.append((first, second, distance, reach))
    return found


def reach_error(
    miss_cm: Mapping[str, float], keypoints: Keypoints, tolerance_cm: float, hover_cm: float = 0.0
) -> ReachError:
    """The error that says by how much each keypoint is missed, why if a bone is too short, and what to do."""
    missed = ", ".join(f"{name} by {miss:.1f} cm" for name, miss in miss_cm.items())
    reasons = [
        f"{first} and {second} are {100 * distance:.0f} cm apart but the skeleton spans at most {100 * reach:.0f} cm, "
        f"move them {100 * (distance - reach):.1f} cm closer"
        for first, second, distance, reach in overstretched(keypoints)
    ]
    if hover_cm:
        reasons.append(
            f"the feet would hang {hover_cm:.1f} cm above the ground, lower the keypoints or pass floor=None"
        )
    remedy = "; ".join(reasons) or "move the keypoints towards each other, give fewer, or raise tolerance_cm"
    return ReachError(
        f"no plausible pose meets the keypoints within {tolerance_cm:g} cm: missed {missed}; {remedy}", miss_cm
    )


def _to_root(joint: int, skeleton: Skeleton) -> list[int]:
    chain = []
    while joint >= 0:
        chain.append(joint)
        joint = skeleton.parents[joint]
    return chain
