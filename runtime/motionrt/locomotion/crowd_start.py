"""Many walking characters at once, from nothing but where they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.limits import limits
from motionrt.locomotion.arguments import as_goal
from motionrt.locomotion.character_models import CharacterModels
from motionrt.locomotion.crowd import Crowd, history_of
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.untrusted.arguments import checked_whole, listed

ABREAST = 1.2  # metres between neighbours


def crowd(models: CharacterModels, starts: int | Sequence[Goal | Sequence[float]]) -> Crowd:
    """Characters in mid-stride.

    Args:
        models: the models.
        starts: where each is and which way it walks, (x, z, heading); or how many, who then walk abreast along +Z.

    Raises:
        InvalidInputError: nobody at all, or something else than places.
    """
    places = _abreast(starts) if isinstance(starts, int) else listed(starts, "starts", "places, or a number")
    goals = [as_goal(start) for start in places]
    if not goals:
        raise InvalidInputError("a crowd needs at least one character")
    return Crowd(models.walk, np.stack([history_of(uncanonicalise(models.stride, goal)) for goal in goals]))


def _abreast(count: int) -> list[Sequence[float]]:
    count = checked_whole(count, "starts", 0, limits().motions)
    return [(ABREAST * (i - (count - 1) / 2), 0.0, 0.0) for i in range(count)]
