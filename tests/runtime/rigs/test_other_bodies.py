"""Motions from the joint positions of bodies of other sizes and proportions."""

from __future__ import annotations

import numpy as np
import pytest
from retarget_rigs import person

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24
from motionrt.rigs.other_bodies import motion_of_body

PARENTS = list(SMPL24.parents[1:22])


def bones(places: np.ndarray) -> np.ndarray:
    """Unit vectors ``(F, 21, 3)``."""
    ways = places[:, 1:22].astype(float) - places[:, PARENTS]
    return ways / np.linalg.norm(ways, axis=-1, keepdims=True)


@pytest.mark.parametrize("size", [0.6, 1.0, 39.37])
@pytest.mark.parametrize("proportions", [False, True])
def test_all_bones_point_as_they_did_and_feet_stay_on_the_floor(size: float, proportions: bool) -> None:
    truth = person(40)
    given = truth.positions()[:, :22].astype(float)
    if proportions:
        longer = np.random.default_rng(3).uniform(0.8, 1.25, 22)
        longer[2] = longer[1]  # hips stay on both sides of the pelvis
        before = given.copy()
        for joint in range(1, 22):
            parent = SMPL24.parents[joint]
            given[:, joint] = given[:, parent] + longer[joint] * (before[:, joint] - before[:, parent])
    found = motion_of_body(size * given, 30.0)
    cosine = (bones(found.positions()) * bones(given)).sum(-1)
    assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 0.2
    assert abs(np.percentile(found.positions()[:, [10, 11], 1].min(axis=1), 20)) < 0.03
    if not proportions:
        assert np.abs(found.root - truth.root).max() < 0.03


def test_what_is_no_body_is_refused() -> None:
    for joints in (np.zeros((3, 21, 3)), np.zeros((0, 22, 3)), np.full((2, 22, 3), np.nan)):
        with pytest.raises(InvalidInputError, match="joint positions"):
            motion_of_body(joints, 30.0)
