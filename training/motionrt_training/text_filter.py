"""Which captions are too alike to be negatives of each other (TMR 3.3), sides and directions respected."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

# Words of sides, turns and directions, by what they tell: sentences that differ here differ in motion.
_GROUPS = {
    "left": "left lefts leftward leftwards left-hand lefthand left-handed",
    "right": "right rightward rightwards right-hand righthand right-handed",
    "clockwise": "clockwise",
    "counterclockwise": "counterclockwise anticlockwise counter-clockwise anti-clockwise",
    "forward": "forward forwards ahead onward onwards frontward frontwards",
    "backward": "backward backwards rearward rearwards reverse reversing backpedal backpedals backpedaling",
    "up": "up upward upwards upstairs ascend ascends ascending uphill climb climbs climbing",
    "down": "down downward downwards downstairs descend descends descending downhill",
    "sideways": "sideways sideward sidewards sidestep sidesteps sidestepping laterally",
    "both": "both",
    "inward": "inward inwards",
    "outward": "outward outwards",
}
_MEANING = {word: meaning for meaning, words in _GROUPS.items() for word in words.split()}
_WORD = re.compile(r"[a-z]+(?:-[a-z]+)*")


def directions(text: str) -> frozenset[str]:
    """The sides and directions that a sentence names, e.g. {"left", "forward"}."""
    found = set()
    for word in _WORD.findall(text.lower()):
        parts = [word] if word in _MEANING else word.split("-")
        found.update(_MEANING[part] for part in parts if part in _MEANING)
    return frozenset(found)


_PATH = re.compile(
    r"\b(?:turn|pivot|spin|rotat|circl|circular|curv|spiral|arc|loop|veer|swerv|twirl|revers|about[- ]face|u-turn)"
)


def names_path(text: str) -> bool:
    """Whether a sentence names a turn, a circle or a curve."""
    return _PATH.search(text.lower()) is not None


def direction_differs(first: Sequence[frozenset[str]], second: Sequence[frozenset[str]]) -> NDArray[np.bool_]:
    """(N,), (M,) sets of `directions` -> (N, M) True where they are not the same."""
    codes = {group: index for index, group in enumerate({*first, *second})}
    rows = np.array([codes[group] for group in first])
    columns = np.array([codes[group] for group in second])
    return rows[:, None] != columns[None]


def keep_negatives(
    embeddings: NDArray[np.floating],
    groups: Sequence[frozenset[str]],
    threshold: float | None = 0.8,
    *,
    respect_directions: bool = True,
) -> NDArray[np.bool_]:
    """Which pairs stay in the denominator of InfoNCE.

    embeddings (N, D) unit norm, groups (N,) from `directions`, threshold on the [0, 1] scale (1 + cosine) / 2
    (0.8 is cosine 0.6; None keeps everything) -> (N, N) bool, diagonal True.
    """
    count = len(embeddings)
    if threshold is None:
        return np.ones((count, count), dtype=np.bool_)
    scores = (1.0 + embeddings.astype(np.float32) @ embeddings.astype(np.float32).T) / 2.0
    keep = scores <= threshold
    if respect_directions:
        keep |= direction_differs(groups, groups)
    return keep | np.eye(count, dtype=np.bool_)
