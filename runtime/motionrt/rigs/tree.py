"""Questions about a rig's joint tree: ancestors, paths, bone lengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from motionrt.motion.rotations import Array
from motionrt.rigs.clip import RigClip
from motionrt.rigs.joint_names import is_attachment

_COINCIDENT = 0.08
"""A bone shorter than this share of the median bone counts as none: its two joints stand in one place."""


_SAMPLES = 24
_RIDES = 0.1


class RigTree:
    """The joint tree of a rig, with the typical (median over the clip) length of every bone in file units."""

    def __init__(self, clip: RigClip) -> None:
        self._clip = clip
        self.names: Sequence[str] = clip.names
        self.parents: Sequence[int] = clip.parents
        lengths = np.linalg.norm(np.asarray(clip.translations, dtype=np.float64), axis=-1)
        self.lengths: Array = np.median(lengths, axis=0) if len(lengths) else np.linalg.norm(clip.offsets, axis=-1)
        self.lengths[[joint for joint, parent in enumerate(self.parents) if parent < 0]] = 0

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def children(self) -> list[list[int]]:
        """Child indices of every joint."""
        out: list[list[int]] = [[] for _ in self.parents]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                out[parent].append(joint)
        return out

    @cached_property
    def places(self) -> Array:
        """``(S, J, 3)`` global positions at a few frames of the clip, file units."""
        some = slice(None, None, max(1, self._clip.frames // _SAMPLES))
        clip = self._clip
        part = replace(clip, rotations=clip.rotations[some], translations=clip.translations[some])
        return np.asarray(part.global_pose()[0], dtype=np.float64)

    @cached_property
    def negligible(self) -> float:
        """Bone length in file units below which two joints count as one place."""
        bones = self.lengths[self.lengths > 0]
        return _COINCIDENT * float(np.median(bones)) if len(bones) else 0.0

    def ancestors(self, joint: int) -> list[int]:
        """``joint`` and everything above it, nearest first."""
        out = []
        while joint >= 0:
            out.append(joint)
            joint = self.parents[joint]
        return out

    def is_last(self, joint: int) -> bool:
        """Whether nothing but an end site is below ``joint``."""
        return all(self.names[child].endswith("_end") for child in self.children[joint])

    def is_above(self, upper: int, lower: int) -> bool:
        """Whether ``upper`` is a proper ancestor of ``lower``."""
        return upper != lower and upper in self.ancestors(lower)

    def from_middle(self, joint: int, siblings: Sequence[int]) -> float:
        """Distance of ``joint`` from the middle of ``siblings``, which hang on the same joint; file units."""
        places = np.median(np.asarray(self._clip.translations, dtype=np.float64), axis=0)
        return float(np.linalg.norm(places[joint] - places[list(siblings)].mean(axis=0)))

    def rides(self, upper: int, lower: int) -> bool:
        """Whether ``lower``, on a branch of its own (a control), keeps its distance from ``upper`` as if it hung there.

        Only joints that do not hang on each other ride, and only where the clip moves them.
        """
        if self.is_above(upper, lower) or self.is_above(lower, upper):
            return False
        bones = np.linalg.norm(self.places[:, lower] - self.places[:, upper], axis=-1)
        reach = float(np.median(bones))
        return reach > self.negligible and float(np.ptp(bones)) < _RIDES * reach

    def meeting(self, joints: Sequence[int]) -> int | None:
        """The lowest common ancestor of ``joints`` (each counts as its own ancestor); ``None`` in separate
        trees.
        """
        shared = self.ancestors(joints[0])
        for joint in joints[1:]:
            others = set(self.ancestors(joint))
            shared = [candidate for candidate in shared if candidate in others]
        return shared[0] if shared else None

    def path(self, upper: int, lower: int) -> list[int]:
        """Joints from ``upper`` (exclusive) down to ``lower`` (inclusive); empty if ``upper`` is not above
        it.
        """
        line = self.ancestors(lower)
        return line[: line.index(upper)][::-1] if upper in line else []

    def descendants(self, joint: int) -> list[int]:
        """Everything below ``joint``, parents before children."""
        below = {joint}
        for other in range(joint + 1, len(self)):
            if self.parents[other] in below:
                below.add(other)
        return sorted(below - {joint})

    def span(self, upper: int, lower: int) -> float:
        """Summed bone length from ``upper`` down to ``lower``."""
        return float(sum(self.lengths[joint] for joint in self.path(upper, lower)))

    def next_away(self, joint: int) -> int | None:
        """The nearest descendant that stands in another place than ``joint``; of siblings the farthest.

        What is held or steers, by its name, is none.
        """
        here = [joint]
        while here:
            below = [child for upper in here for child in self.children[upper] if not is_attachment(self.names[child])]
            away = [child for child in below if self.span(joint, child) > self.negligible]
            if away:
                return max(away, key=lambda child: float(self.lengths[child]))
            here = below
        return None

    def longest_chain(self, joint: int) -> list[int]:
        """``joint`` and the line of descendants with the greatest summed length."""
        chain = [joint]
        while self.children[chain[-1]]:
            chain.append(max(self.children[chain[-1]], key=self._reach.__getitem__))
        return chain

    @cached_property
    def _reach(self) -> list[float]:
        """For every joint the summed length of the longest line down from it, its own bone included."""
        reach = [float(length) for length in self.lengths]
        below = [0.0] * len(reach)
        for joint in range(len(reach) - 1, -1, -1):
            reach[joint] += below[joint]
            if (parent := self.parents[joint]) >= 0:
                below[parent] = max(below[parent], reach[joint])
        return reach
